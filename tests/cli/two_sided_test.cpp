// varve resolve --accumulator two-sided as a user meets it: chunks, reversed time, disocclusion, spill files.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

class TwoSidedCli : public SceneCli {
 protected:
  /// Resolves in/SCENE into `to`.
  Outcome resolve(const std::string& scene, const std::string& to, const Arguments& more = {}) const {
    return resolve_into("in/" + scene + ".####.exr", to, {"--accumulator", "two-sided", "--clip-discount", "on"}, more);
  }
  std::string bytes(const std::string& to, int frame) const { return bytes_of(path(to, frame)); }
};

TEST_F(TwoSidedCli, AnyPartOfTheSequenceResolvesToTheSameBytes) {
  synth("crossing", "1-26");
  for (const Arguments& vectors : {Arguments{}, backward_only}) {
    Arguments line = {"--look-ahead", "4", "--aov", "all", "--disocclusion", "depth", "--cuts", "14"};
    line.insert(line.end(), vectors.begin(), vectors.end());
    const Outcome outcome = resolve("crossing", "whole", line);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    // Blocks begin at 0, 4, 8 ...: parts that begin and end inside, at and across their edges.
    for (const std::string part : {"1-3", "7", "8-9", "11-17", "14", "10-25x5", "26"}) {
      Arguments chunk = line;
      chunk.insert(chunk.end(), {"-f", part});
      ASSERT_EQ(resolve("crossing", "part" + part, chunk).code, 0);
      const std::vector<std::string> names = files_below(folder / ("part" + part));
      ASSERT_FALSE(names.empty());
      for (const std::string& name : names)
        EXPECT_TRUE(bytes_of(folder / ("part" + part + "/" + name)) == bytes_of(folder / ("whole/" + name)))
            << part << " " << name;
    }
  }
}

TEST_F(TwoSidedCli, ThreadsSpillAndResumeChangeNoByte) {
  synth("crossing", "1-9");
  const Arguments line = {"--look-ahead", "3", "--aov", "all"};
  const auto with = [&](Arguments more) {
    more.insert(more.end(), line.begin(), line.end());
    return more;
  };
  ASSERT_EQ(resolve("crossing", "one", with({"--threads", "1"})).code, 0);
  ASSERT_EQ(resolve("crossing", "three", with({"--threads", "3"})).code, 0);
  fs::create_directory(folder / "spill");
  ASSERT_EQ(resolve("crossing", "spilled", with({"--spill", "spill"})).code, 0);
  EXPECT_TRUE(fs::is_empty(folder / "spill"));
  fs::remove(folder / "spilled/o.0005.exr");
  const Outcome resumed = resolve("crossing", "spilled", with({"--resume"}));
  EXPECT_NE(resumed.err.find("8 complete already"), std::string::npos) << resumed.err;
  for (int frame = 1; frame <= 9; ++frame) {
    EXPECT_TRUE(bytes("one", frame) == bytes("three", frame)) << frame;
    EXPECT_TRUE(bytes("one", frame) == bytes("spilled", frame)) << frame;
  }
}

TEST_F(TwoSidedCli, ReversedTimeGivesTheSamePixels) {
  synth("crossing", "1-9");
  fs::create_directory(folder / "reversed");
  for (int frame = 1; frame <= 9; ++frame)
    fs::copy_file(folder / ("in/crossing." + number(frame) + ".exr"),
                  folder / ("reversed/crossing." + number(10 - frame) + ".exr"));
  const auto map = [](const char* role, const char* layer) {
    const std::string r = role, l = layer;
    return Arguments{"--map", r + ".x=" + l + ".x", "--map", r + ".y=" + l + ".y"};
  };
  const auto joined = [](Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  struct Case {
    Arguments onward, reversed;
  };
  for (const Case& c : {Case{{}, joined(map("motion", "forward"), map("forward", "velocity"))},
                        Case{map("motion", "velocity"), map("forward", "velocity")}}) {  // one direction only: inverted
    const Arguments common = {"--convention", "varve", "--keep", "none", "--aov", "count-past,count-future"};
    ASSERT_EQ(resolve("crossing", "onward", joined(common, c.onward)).code, 0);
    fs::rename(folder / "in", folder / "kept");
    fs::rename(folder / "reversed", folder / "in");
    ASSERT_EQ(resolve("crossing", "back", joined(common, c.reversed)).code, 0);
    fs::rename(folder / "in", folder / "reversed");
    fs::rename(folder / "kept", folder / "in");
    int seen_both = 0;
    for (int frame = 1; frame <= 9; ++frame)
      for (int y = 0; y < 36; y += 9)
        for (int x = 0; x < 64; x += 5) {
          const std::string a = folder / ("onward/o." + number(frame) + ".exr"),
                            b = folder / ("back/o." + number(10 - frame) + ".exr");
          ASSERT_EQ(pixel_of(a, "G", x, y), pixel_of(b, "G", x, y)) << frame << " " << x << "," << y;
          const float past = pixel_of(a, "varve.count-past", x, y), future = pixel_of(a, "varve.count-future", x, y);
          ASSERT_EQ(past, pixel_of(b, "varve.count-future", x, y));
          ASSERT_EQ(future, pixel_of(b, "varve.count-past", x, y));
          seen_both += past > 1 && future > 1;
        }
    EXPECT_GT(seen_both, 200);
  }
}

TEST_F(TwoSidedCli, TheFutureFillsWhatThePastHasNotSeen) {
  synth("crossing", "1-16", {"--size", "160x90", "--truth", "box", "--truth-samples", "36"});
  ASSERT_EQ(resolve("crossing", "recursive", {"--accumulator", "recursive", "--clip-discount", "off"}).code, 0);
  ASSERT_EQ(resolve("crossing", "both", {"--aov", "count-past,count-future,reject"}).code, 0);
  const double one = psnr("crossing", "recursive", "1-16"), two = psnr("crossing", "both", "1-16");
  EXPECT_GT(one, 15);
  EXPECT_GT(two, one + 1.5);
  // The first frame has no past at all, and is as good as any other.
  EXPECT_GT(psnr("crossing", "both", "1"), psnr("crossing", "recursive", "1") + 4);
  // Backward vectors alone do nearly as well.
  ASSERT_EQ(resolve("crossing", "inverted",
                    {"--convention", "varve", "--map", "motion.x=velocity.x", "--map", "motion.y=velocity.y"})
                .code,
            0);
  EXPECT_GT(psnr("crossing", "inverted", "1-16"), two - 0.5);
}

TEST_F(TwoSidedCli, NothingCrossesACutOrAGap) {
  synth("cut", "19-30");
  const Arguments counts = {"--aov", "count-past,count-future,reject,reject-future", "--cuts", "25"};
  ASSERT_EQ(resolve("cut", "cut", counts).code, 0);
  const auto at = [&](const std::string& to, int frame, const char* channel) {
    return pixel_of(folder / (to + "/o." + number(frame) + ".exr"), channel, 30, 18);
  };
  EXPECT_EQ(at("cut", 25, "varve.count-past"), 0.0f);
  EXPECT_EQ(at("cut", 25, "varve.reject"), 2.0f);
  EXPECT_GT(at("cut", 25, "varve.count-future"), 1.0f);
  EXPECT_EQ(at("cut", 24, "varve.count-future"), 0.0f);
  EXPECT_EQ(at("cut", 24, "varve.reject-future"), 2.0f);
  // Each shot by itself is the same.
  ASSERT_EQ(
      resolve("cut", "second", {"--aov", "count-past,count-future,reject,reject-future", "--cuts", "25", "-f", "25-30"})
          .code,
      0);
  for (int frame = 25; frame <= 30; ++frame) EXPECT_TRUE(bytes("cut", frame) == bytes("second", frame));
  fs::remove(folder / "in/cut.0022.exr");
  const Outcome gap = resolve("cut", "gap", counts);
  EXPECT_EQ(gap.code, 0) << gap.err;
  EXPECT_EQ(at("gap", 23, "varve.count-past"), 0.0f);
  EXPECT_EQ(at("gap", 21, "varve.count-future"), 0.0f);
  EXPECT_NE(gap.err.find("gap after frame 21"), std::string::npos) << gap.err;
}

TEST_F(TwoSidedCli, AStoppedRunLeavesNoSpillFile) {
  synth("crossing", "1-30", {"--size", "320x180"});
  fs::create_directories(folder / "spill");
  fs::create_directories(folder / "out");
  Running running(
      {"resolve", "in/crossing.####.exr", "-o", "out/o.####.exr", "--accumulator", "two-sided", "--spill", "spill"},
      folder.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  running.send(SIGTERM);
  const Outcome outcome = running.wait();
  EXPECT_TRUE(outcome.code == 143 || outcome.code == 0) << outcome.code << outcome.err;
  EXPECT_TRUE(fs::is_empty(folder / "spill"));
  for (const std::string& name : files_below(folder / "out")) EXPECT_TRUE(is_complete(folder / ("out/" + name)));
}

TEST_F(TwoSidedCli, OneThingWrong) {
  synth("pan", "1-3");
  expect_refused(resolve("pan", "o", {"--accumulator", "recursive", "--spill", "."}), 2, "--spill");
  expect_refused(resolve("pan", "o", {"--rule", "off"}), 2, "--rule");
  expect_refused(resolve("pan", "o", {"--feedback", "luma"}), 2, "--feedback fixed");
  expect_refused(resolve("pan", "o", {"--on-reject", "blur"}), 2, "--on-reject restart");
  expect_refused(resolve("pan", "o", {"--spill", "nowhere"}), 5, "nowhere");
  expect_refused(resolve("pan", "o", {"--aov", "prediction"}), 2, "prediction");
  expect_refused(resolve("pan", "o", {"--accumulator", "recursive", "--aov", "count-past"}), 2, "count-past");
  expect_refused(resolve("pan", "o", {"--look-ahead", "-1"}), 2, "--look-ahead");
  expect_refused(resolve("pan", "o", {"--look-ahead", "1.5"}), 2, "--look-ahead");
  fs::resize_file(folder / "in/pan.0003.exr", 400);
  expect_refused(resolve("pan", "o"), 3, "pan.0003.exr");
}

}  // namespace
}  // namespace varve::test
