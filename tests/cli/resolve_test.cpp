// varve resolve as a user meets it: a valid command line on a small sequence, then the same with one thing damaged.
#include <gtest/gtest.h>
#include <algorithm>

#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <thread>

#include "program.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

Arguments with(Arguments line, const Arguments& more) {
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

class Resolve : public testing::Test {
 protected:
  void SetUp() override {
    write_small_sequence(folder.path());
    fs::create_directory(folder / "out");
  }

  Outcome run(const Arguments& more = {}) const { return run_varve(with(line, more), folder.path()); }

  std::string output(int frame) const { return folder / ("out/o.000" + std::to_string(frame) + ".exr"); }

  /// Every file under a final name is whole, and nothing else lies about.
  void expect_only_whole_files() const {
    for (const std::string& name : files_below(folder / "out")) {
      EXPECT_TRUE(name.ends_with(".exr")) << name;
      EXPECT_TRUE(is_complete(folder / ("out/" + name))) << name;
    }
  }

  Folder folder;
  Arguments line = {"resolve", "in.####.exr", "-o", "out/o.####.exr"};
};

TEST_F(Resolve, WritesEveryFrameOnDisk) {
  const Outcome outcome = run();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(files_below(folder / "out").size(), 8u);
  expect_only_whole_files();
  EXPECT_EQ(outcome.err.find("rror"), std::string::npos) << outcome.err;
  for (int frame = 1; frame <= 8; ++frame)
    EXPECT_NE(outcome.err.find("frame " + std::to_string(frame) + ": "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("PROGRESS: 100%"), std::string::npos);
  EXPECT_NE(outcome.err.find("8 frames written"), std::string::npos);
}

TEST_F(Resolve, OtherChannelsPassThroughAndKeepNoneDropsThem) {
  ASSERT_EQ(run().code, 0);
  for (const int x : {0, 25, 30, 63})
    EXPECT_EQ(pixel_of(output(8), "ViewLayer.IndexOB.X", x, 15),
              pixel_of(folder / "in.0008.exr", "ViewLayer.IndexOB.X", x, 15));
  EXPECT_NE(bytes_of(output(8)).find("a custom attribute"), std::string::npos);
  ASSERT_EQ(run({"--keep", "none"}).code, 0);
  EXPECT_EQ(bytes_of(output(8)).find("IndexOB"), std::string::npos);
}

TEST_F(Resolve, ChosenFramesOnly) {
  ASSERT_EQ(run({"--frames", "2-6x2"}).code, 0);
  EXPECT_EQ(files_below(folder / "out"), (Arguments{"o.0002.exr", "o.0004.exr", "o.0006.exr"}));
}

TEST_F(Resolve, PrerollWritesNoMoreThanWasAsked) {
  ASSERT_EQ(run({"--frames", "5-6", "--preroll", "3"}).code, 0);
  EXPECT_EQ(files_below(folder / "out"), (Arguments{"o.0005.exr", "o.0006.exr"}));
}

TEST_F(Resolve, SameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(run({"--threads", "1", "--aov", "all"}).code, 0);
  const std::string one = bytes_of(output(8));
  ASSERT_EQ(run({"--threads", "3", "--aov", "all"}).code, 0);
  EXPECT_EQ(bytes_of(output(8)), one);
}

TEST_F(Resolve, DryRunPrintsThePlanAndWritesNothing) {
  const Outcome outcome = run({"--dry-run"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(outcome.out.size(), 100u);
  EXPECT_TRUE(files_below(folder / "out").empty());
}

TEST_F(Resolve, ResumeDoesOnlyWhatIsMissing) {
  ASSERT_EQ(run().code, 0);
  const std::string whole = bytes_of(output(8)), last_write = bytes_of(output(3));
  fs::remove(output(8));
  const auto time_of_third = fs::last_write_time(output(3));
  const Outcome outcome = run({"--resume"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(fs::last_write_time(output(3)), time_of_third);
  EXPECT_EQ(bytes_of(output(8)), whole) << "the resumed frame is the one of the whole run";
  EXPECT_NE(outcome.err.find("7 complete already"), std::string::npos) << outcome.err;
  // Other parameters are other work.
  ASSERT_EQ(run({"--resume", "--alpha", "0.5"}).code, 0);
  EXPECT_NE(bytes_of(output(3)), last_write);
  // Half a file is not complete.
  ASSERT_EQ(run().code, 0);
  fs::resize_file(output(5), fs::file_size(output(5)) / 2);
  ASSERT_EQ(run({"--resume"}).code, 0);
  expect_only_whole_files();
}

TEST_F(Resolve, ResumeKnowsAnotherHistoryAndOtherSideFiles) {
  const auto write_jitter = [&](const char* first) {
    std::ofstream table(folder / "j.csv");
    table << "frame,jx,jy\n" << first << "\n";
    for (int frame = 2; frame <= 8; ++frame) table << frame << ",0,0\n";
  };
  const auto skipped = [&](const Arguments& more) {
    const Outcome outcome = run(with(more, {"--resume"}));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::size_t count = 0;
    for (std::size_t at = 0; (at = outcome.err.find("complete already, skipped", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  // A frame that was missing and has come since changes every later one, and no earlier one.
  fs::rename(folder / "in.0004.exr", folder / "late");
  ASSERT_EQ(run().code, 0);
  fs::rename(folder / "late", folder / "in.0004.exr");
  EXPECT_EQ(skipped({}), 3u);
  const std::string resumed = bytes_of(output(8));
  ASSERT_EQ(run().code, 0);
  EXPECT_EQ(bytes_of(output(8)), resumed);
  // More frames of a shot that is being rendered leave the finished ones as they are.
  ASSERT_EQ(run({"--frames", "1-5"}).code, 0);
  EXPECT_EQ(skipped({}), 8u);
  // The numbers in a table count, not only its name; where it lies does not.
  write_jitter("1,0,0");
  ASSERT_EQ(run({"--jitter", "j.csv"}).code, 0);
  EXPECT_EQ(skipped({"--jitter", "./j.csv"}), 8u);
  write_jitter("1,0.25,0");
  EXPECT_EQ(skipped({"--jitter", "j.csv"}), 0u);
}

TEST_F(Resolve, DiagnosticsOfAnEarlierResolveDoNotStay) {
  ASSERT_EQ(run({"--aov", "all"}).code, 0);
  ASSERT_EQ(run_varve({"resolve", "out/o.####.exr", "-o", "out/again.####.exr", "--aov", "weight"}, folder.path()).code,
            0);
  const std::string again = bytes_of(folder / "out/again.0004.exr");
  EXPECT_NE(again.find("varve.weight"), std::string::npos);
  EXPECT_EQ(again.find("varve.count"), std::string::npos);
  EXPECT_EQ(again.find("varve.motion.x"), std::string::npos);
  EXPECT_NE(again.find("ViewLayer.IndexOB.X"), std::string::npos);
}

TEST_F(Resolve, DiagnosticsInsideAndApart) {
  ASSERT_EQ(run({"--aov", "count,reject"}).code, 0);
  const std::string inside = bytes_of(output(2));
  EXPECT_NE(inside.find("varve.count"), std::string::npos);
  EXPECT_EQ(inside.find("varve.weight"), std::string::npos);
  ASSERT_EQ(run({"--diagnostics", "out/diag.####.exr"}).code, 0);
  EXPECT_EQ(bytes_of(output(2)).find("varve.count"), std::string::npos);
  const std::string apart = bytes_of(folder / "out/diag.0002.exr");
  for (const char* plane :
       {"varve.count", "varve.clip", "varve.reject", "varve.motion.x", "varve.weight", "varve.repaired"})
    EXPECT_NE(apart.find(plane), std::string::npos) << plane;
  expect_only_whole_files();
}

TEST_F(Resolve, AFrameMayLackWhatIsNotUsed) {
  write_small_frame(folder / "in.0006.exr", 6, {.with_depth = false});
  EXPECT_EQ(run().code, 0);
  EXPECT_EQ(bytes_of(output(6)).find("Depth"), std::string::npos);
  EXPECT_NE(bytes_of(output(7)).find("Depth"), std::string::npos);
  expect_refused(run({"--disocclusion", "depth"}), 4, "in.0006.exr");
}

TEST_F(Resolve, WithoutVectorsOnlyWhenToldSo) {
  write_small_sequence(folder.path(), {.with_vectors = false});
  const Outcome refused = run();
  EXPECT_EQ(refused.code, 4);
  EXPECT_NE(refused.err.find("no motion vectors"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("--convention none"), std::string::npos) << refused.err;
  EXPECT_TRUE(files_below(folder / "out").empty());
  EXPECT_EQ(run({"--convention", "none"}).code, 0);
}

TEST_F(Resolve, EveryBoxIsReachedFromTheCommandLineAndPlanned) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> choices = {
      {{"--box", "rounded"}, "plus of five"},
      {{"--box", "dynamic4", "--anchor", "center"}, "four taps"},
      {{"--box", "kdop13", "--rule", "project"}, "13 directions"},
      {{"--box", "pca", "--rule", "clamp"}, "own axes"},
      {{"--box", "ellipsoid"}, "ellipsoid"},
      {{"--box", "hull", "--hull-passes", "4"}, "at most 4 passes"},
      {{"--rule", "off", "--clip-discount", "on"}, "keeps its color"},
      {{"--space", "log"}, "log RGB"},
      {{"--window", "31"}, "--moments separable"},
      {{"--window", "63", "--moments", "gaussian"}, "63x63"}};
  for (const auto& [choice, words] : choices) {
    std::vector<std::string> arguments = {"--aov", "clip"};
    arguments.insert(arguments.end(), choice.begin(), choice.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << choice[1] << ": " << outcome.err;
    expect_only_whole_files();
    arguments.push_back("--dry-run");
    std::string plan = run(arguments).out;
    std::replace(plan.begin(), plan.end(), '\n', ' ');  // lines are wrapped and indented
    plan.erase(std::unique(plan.begin(), plan.end(), [](char a, char b) { return a == ' ' && b == ' '; }), plan.end());
    EXPECT_NE(plan.find(words), std::string::npos) << words << " in " << plan;
  }
  expect_refused(run({"--box", "hull", "--rule", "clamp"}), 2, "--rule project");
  expect_refused(run({"--box", "kdop7", "--anchor", "center"}), 2, "--anchor mean");
  expect_refused(run({"--box", "rounded", "--window", "5"}), 2, "--window 3");
  expect_refused(run({"--clip-discount", "on", "--alpha-rule", "fixed"}), 2, "--alpha-rule mean");
}

TEST_F(Resolve, ProgressStyles) {
  const Outcome json = run({"--progress", "json"});
  EXPECT_EQ(json.code, 0);
  std::istringstream lines(json.err);
  int frames = 0;
  for (std::string text; std::getline(lines, text);) {
    EXPECT_TRUE(text.starts_with("{\"event\":\"") && text.ends_with("}")) << text;
    frames += text.starts_with("{\"event\":\"frame\"") ? 1 : 0;
  }
  EXPECT_EQ(frames, 8);
  const Outcome openjd = run({"--progress=openjd"});
  EXPECT_NE(openjd.err.find("openjd_progress: 100\n"), std::string::npos) << openjd.err;
  EXPECT_NE(openjd.err.find("openjd_status: frame 1: "), std::string::npos) << openjd.err;
  EXPECT_EQ(run({"--quiet"}).err, "");
  EXPECT_NE(run({"--progress=bar"}).err.find("8/8"), std::string::npos);
}

TEST_F(Resolve, ReportHasARowForEachFrame) {
  ASSERT_EQ(run({"--report", "report.json"}).code, 0);
  const std::string report = bytes_of(folder / "report.json");
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = report.find("\n{\"frame\":", at)) != std::string::npos; ++at) ++rows;
  EXPECT_EQ(rows, 8u) << report;
}

/// One damage to a valid run: what is done to the folder, what is added to the line, and how it must end.
struct Damage {
  std::string name;
  std::function<void(const Folder&)> harm;
  Arguments more;
  int code;
  std::string culprit;
};

const std::vector<Damage>& damages() {
  static const std::function<void(const Folder&)> nothing = [](const Folder&) {};
  static const std::vector<Damage> all = {
      {"missing frame", [](const Folder& f) { fs::remove(f / "in.0004.exr"); }, {"-f", "1-8"}, 3, "in.0004.exr"},
      {"truncated",
       [](const Folder& f) { fs::resize_file(f / "in.0005.exr", fs::file_size(f / "in.0005.exr") / 2); },
       {},
       3,
       "frame 5: 'in.0005.exr'"},
      {"empty file", [](const Folder& f) { fs::resize_file(f / "in.0005.exr", 0); }, {}, 3, "in.0005.exr"},
      {"garbage",
       [](const Folder& f) { std::ofstream(f / "in.0003.exr") << "this is no picture"; },
       {},
       3,
       "in.0003.exr"},
      {"a folder in place of a frame",
       [](const Folder& f) { fs::remove(f / "in.0003.exr"), fs::create_directory(f / "in.0003.exr"); },
       {"-f", "1-8"},
       3,
       "in.0003.exr"},
      {"no frames at all",
       [](const Folder& f) {
         for (const auto& name : files_below(f.path())) fs::remove(f / name);
       },
       {},
       3,
       "in.####.exr"},
      {"no depth where it is needed",
       [](const Folder& f) { write_small_sequence(f.path(), {.with_depth = false}); },
       {"--disocclusion", "depth"},
       4,
       "depth"},
      {"no jitter where it is needed", nothing, {"--sample-filter", "tent", "--jitter", "none"}, 4, "jitter"},
      {"channels differ",
       [](const Folder& f) { write_small_frame(f / "in.0006.exr", 6, {.with_vectors = false}); },
       {},
       4,
       "in.0006.exr"},
      {"unknown layer", nothing, {"--layer", "fog"}, 4, "fog"},
      {"unknown channel", nothing, {"--map", "depth=fog.Z"}, 4, "fog.Z"},
      {"output is the input", nothing, {"-o", "in.####.exr"}, 2, "in."},
      {"output is the input by another way", nothing, {"-o", "out/../in.####.exr"}, 2, "in."},
      {"diagnostics are the output", nothing, {"--diagnostics", "out/o.####.exr"}, 2, "o."},
      {"one output for many frames", nothing, {"-o", "out/o.exr"}, 2, "out/o.exr"},
      {"a file in place of the folder", nothing, {"-o", "in.0001.exr/o.####.exr"}, 5, "in.0001.exr"},
      {"a folder nobody can write to", nothing, {"-o", "/proc/o.####.exr"}, 5, "/proc"},
      {"a folder that is not there", nothing, {"-o", "nowhere/o.####.exr"}, 5, "nowhere"},
      {"missing role file", nothing, {"--depth-file", "z.####.exr"}, 3, "z.0001.exr"},
      {"one role file for many frames", nothing, {"--depth-file", "in.0001.exr"}, 2, "in.0001.exr"},
      {"missing jitter file", nothing, {"--jitter", "missing.csv"}, 3, "missing.csv"},
      {"missing color config",
       nothing,
       {"--ocio", "missing.ocio", "--from-space", "a", "--to-space", "b"},
       3,
       "missing.ocio"},
      {"report in a folder that is not there", nothing, {"--report", "nowhere/report.json"}, 5, "nowhere"},
      {"a pipe in place of an output",
       [](const Folder& f) { fs::remove(f / "out/o.0001.exr"), mkfifo((f / "out/o.0001.exr").c_str(), 0600); },
       {},
       5,
       "out/o.0001.exr"},
      {"report over an input", nothing, {"--report", "in.0003.exr"}, 2, "in.0003.exr"},
      {"report over an output", nothing, {"--report", "out/../out/o.0003.exr"}, 2, "o.0003.exr"},
      {"pictures in a folder that is not there", nothing, {"--preview", "nowhere"}, 5, "nowhere"},
      {"a display without a config", nothing, {"--preview", "out", "--display", "sRGB"}, 2, "--display"},
  };
  return all;
}

TEST_F(Resolve, OneThingDamaged) {
  for (const Damage& damage : damages()) {
    SCOPED_TRACE(damage.name);
    Folder own;
    write_small_sequence(own.path());
    fs::create_directory(own / "out");
    std::ofstream(own / "out/earlier.exr") << "";
    write_small_frame(own / "out/o.0001.exr", 1);  // of an earlier run
    damage.harm(own);
    std::set<std::string> inputs;
    for (const std::string& name : files_below(own.path())) inputs.insert(name + bytes_of(own / name));
    fs::remove(own / "out/earlier.exr");

    expect_refused(run_varve(with(line, damage.more), own.path()), damage.code, damage.culprit);
    for (const std::string& name : files_below(own.path())) {
      EXPECT_TRUE(name.ends_with(".exr")) << "left behind: " << name;
      if (name.starts_with("out/"))
        EXPECT_TRUE(is_complete(own / name)) << name;
      else
        EXPECT_TRUE(inputs.contains(name + bytes_of(own / name))) << "input changed: " << name;
    }
  }
}

TEST_F(Resolve, WhatWasWrittenBeforeTheDamageStays) {
  fs::resize_file(folder / "in.0005.exr", fs::file_size(folder / "in.0005.exr") - 64);
  EXPECT_EQ(run().code, 3);
  EXPECT_EQ(files_below(folder / "out").size(), 4u);
  expect_only_whole_files();
}

/// A run long enough to be stopped in its middle.
class Signals : public Resolve {
 protected:
  void SetUp() override {
    write_small_sequence(folder.path(), {.frames = 9, .width = 1000, .height = 700});
    fs::create_directory(folder / "out");
  }

  /// Waits until the first output is there.
  void wait_for_output(Running& running) const {
    while (!running.finished() && !fs::exists(output(1))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
};

TEST_F(Signals, StopsBetweenFramesAndResumesToTheSameBytes) {
  for (const auto& [signal, code] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    Running running(line, folder.path());
    wait_for_output(running);
    running.send(signal);
    const Outcome outcome = running.wait();
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.err.find("rror"), std::string::npos) << outcome.err;
    EXPECT_LT(files_below(folder / "out").size(), 9u);
    expect_only_whole_files();
  }
  ASSERT_EQ(run({"--resume"}).code, 0);
  const std::string resumed = bytes_of(output(9));
  ASSERT_EQ(run().code, 0);
  EXPECT_EQ(bytes_of(output(9)), resumed);
}

TEST_F(Signals, TheSecondOneEndsAtOnce) {
  Running running(line, folder.path());
  wait_for_output(running);
  running.send(SIGINT);
  running.send(SIGINT);
  EXPECT_EQ(running.wait().code, 130);
  expect_only_whole_files();
}

}  // namespace
}  // namespace varve::test
