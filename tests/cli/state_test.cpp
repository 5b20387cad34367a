// varve resolve --state-out and --state-in as a user meets them: chunks that go on exactly, and states that do not fit.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "plan/preset.h"
#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class StateCli : public SceneCli {
 protected:
  void expect_same(const std::string& part, const std::string& whole, const std::string& of) const {
    const std::vector<std::string> names = files_below(folder / whole);
    ASSERT_FALSE(names.empty());
    for (const std::string& name : names)
      EXPECT_TRUE(bytes_of(folder / (part + "/" + name)) == bytes_of(folder / (whole + "/" + name)))
          << of << " " << name;
  }

  /// Frames 1-5 in one run, and 1-2, 3, 4-5 by states: the same bytes.
  void expect_exact(const std::string& input, const Arguments& choices) const {
    std::string of;
    for (const std::string& choice : choices) of += choice + " ";
    const Arguments all = choices + Arguments{"--keep", "none"};
    const auto run = [&](const std::string& to, const Arguments& more) {
      const Outcome outcome = resolve_into(input, to, all, more);
      ASSERT_EQ(outcome.code, 0) << of << outcome.err;
    };
    for (const char* old : {"whole", "part"}) fs::remove_all(folder / old);
    run("whole", {"-f", "1-5"});
    run("part", {"-f", "1-2", "--state-out", "a", "--threads", "1"});
    run("part", {"-f", "3", "--state-in", "a", "--state-out", "b", "--threads", "3"});
    run("part", {"-f", "4-5", "--state-in", "b"});
    expect_same("part", "whole", of);
  }
};

TEST_F(StateCli, EveryRecursivePresetGoesOnExactly) {
  synth("crossing", "1-5", {"--size", "32x19"});
  std::size_t tried = 0;
  for (const Preset& preset : presets()) {
    Arguments choices = {"-p", std::string(preset.name), "--aov", "all"};
    if (preset_parameters(preset).accumulator == Accumulator::gather ||
        preset_parameters(preset).accumulator == Accumulator::two_sided)
      continue;
    expect_exact("in/crossing.####.exr", choices);
    ++tried;
  }
  EXPECT_GE(tried, 4u);
}

TEST_F(StateCli, SoDoesEverythingThatRemembersMore) {
  synth("crossing", "1-5", {"--size", "32x19"});
  const std::string input = "in/crossing.####.exr";
  const Arguments forward_only = {"--convention",       "varve", "--map",
                                  "motion.x=forward.x", "--map", "motion.y=forward.y",
                                  "--motion-direction", "next"};
  for (const Arguments& choices :
       {Arguments{"--history-filter", "bspline3"},
        {"--disocclusion", "depth", "--id-test", "hard", "--speed-difference", "1", "--acceleration", "2"},
        {"--repair-motion", "on", "--camera-motion", "all"},
        {"--cuts", "4", "--find-cuts", "on"},
        {"--preroll", "0", "--feedback", "luma", "--anti-flicker", "0.5"},
        forward_only,
        forward_only + Arguments{"--repair-motion", "on", "--camera-motion", "all"}})
    expect_exact(input, choices);
}

TEST_F(StateCli, SoDoLayersSamplesAndCompanions) {
  synth("panes", "1-5", {"--size", "32x19", "--layers"});
  for (const Arguments& choices : {Arguments{"--layer", "fg,mid,bg", "--layers", "composite"},
                                   {"--layer", "fg,mid,bg", "--layers", "each"},
                                   {"--channels", "fg,bg"}})
    expect_exact("in/panes.####.exr", choices);
  synth("fence", "1-5", {"--size", "32x19", "--samples", "2"});
  for (const char* how : {"resolve", "each"}) expect_exact("in/fence.####.exr", {"--samples", how});
}

TEST_F(StateCli, AChunkOfOneFrameIsTestedAsOthersAre) {
  synth("crossing", "1-5", {"--size", "40x23"});
  for (const Arguments& choices : {Arguments{"--disocclusion", "depth", "--id-test", "hard", "--alpha-rule", "fixed"},
                                   {"-p", "two-sided", "--disocclusion", "depth", "--id-test", "hard"}}) {
    for (const char* old : {"whole", "part"}) fs::remove_all(folder / old);
    const Arguments none = {"--keep", "none"};
    ASSERT_EQ(
        resolve_into("in/crossing.####.exr", "whole", choices, none + Arguments{"-f", "4-5", "--preroll", "3"}).code,
        0);
    ASSERT_EQ(resolve_into("in/crossing.####.exr", "part", choices, none + Arguments{"-f", "4", "--preroll", "3"}).code,
              0);
    EXPECT_TRUE(bytes_of(path("part", 4)) == bytes_of(path("whole", 4))) << choices[1];
  }
}

TEST_F(StateCli, TheFrameBeforeNeedNotBeThereAnyMore) {
  synth("crossing", "1-6");
  const Arguments choices = {"--camera-motion", "all", "--keep", "none"};
  ASSERT_EQ(resolve_into("in/crossing.####.exr", "whole", choices, {}).code, 0);
  ASSERT_EQ(resolve_into("in/crossing.####.exr", "part", choices, {"-f", "1-3", "--state-out", "st"}).code, 0);
  for (const int frame : {1, 2, 3}) fs::remove(folder / ("in/crossing." + number(frame) + ".exr"));
  const Outcome outcome = resolve_into("in/crossing.####.exr", "part", choices, {"--state-in", "st"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_same("part", "whole", "");
}

TEST_F(StateCli, ResumeKnowsAStateThatIsThere) {
  write_small_sequence(folder.path(), {.frames = 6});
  const auto run = [&](const Arguments& more) { return resolve_into("in.####.exr", "o", {}, more); };
  ASSERT_EQ(run({"-f", "1-3", "--state-out", "st"}).code, 0);
  const std::string state = bytes_of(folder / "st");
  const auto time = fs::last_write_time(folder / "st");
  ASSERT_EQ(run({"-f", "1-3", "--state-out", "st", "--resume"}).code, 0);
  EXPECT_EQ(fs::last_write_time(folder / "st"), time);
  // All frames are complete, the state is not: it is made again, and they stay.
  fs::resize_file(folder / "st", 1000);
  const auto frame_time = fs::last_write_time(path("o", 2));
  const Outcome again = run({"-f", "1-3", "--state-out", "st", "--resume"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(fs::last_write_time(path("o", 2)), frame_time);
  EXPECT_EQ(bytes_of(folder / "st"), state);
  // A chunk that was killed goes on from its state.
  ASSERT_EQ(run({"-f", "4-6", "--state-in", "st"}).code, 0);
  const std::string last = bytes_of(path("o", 6));
  fs::remove(path("o", 6));
  const Outcome resumed = run({"-f", "4-6", "--state-in", "st", "--resume"});
  EXPECT_NE(resumed.err.find("2 complete already"), std::string::npos) << resumed.err;
  EXPECT_EQ(bytes_of(path("o", 6)), last);
}

TEST_F(StateCli, WhatDoesNotFitIsRefused) {
  write_small_sequence(folder.path(), {.frames = 6});
  const auto run = [&](const Arguments& more) { return resolve_into("in.####.exr", "o", {}, more); };
  ASSERT_EQ(run({"-f", "1-3", "--state-out", "st"}).code, 0);
  const Arguments on = {"-f", "4-6", "--state-in", "st"};
  expect_refused(run({"-f", "5-6", "--state-in", "st"}), 4, "after frame 3");
  expect_refused(run({"--state-in", "st"}), 4, "--frames from 4 on");
  expect_refused(run(on + Arguments{"--alpha", "0.5"}), 4, "alpha=0.1 there and alpha=0.5 here");
  expect_refused(run(on + Arguments{"--aov", "count"}), 4, "aov=count");
  expect_refused(run(on + Arguments{"--preroll", "2"}), 2, "--preroll");
  expect_refused(run(on + Arguments{"-p", "two-sided"}), 2, "any chunk gives the same bytes without a state");
  expect_refused(run({"-p", "standard", "--state-out", "x"}), 2, "--state-out");
  expect_refused(run({"-f", "4-6", "--state-in", "missing"}), 3, "missing");
  expect_refused(run({"-f", "4-6", "--state-in", "in.0001.exr"}), 3, "is not a state file");
  expect_refused(run({"-f", "1-3", "--state-out", "in.0002.exr"}), 2, "in.0002.exr");
  expect_refused(run({"-f", "1-3", "--state-out", "in.0004.exr"}), 2, "is no state file");
  expect_refused(run({"-f", "1-3", "--state-out", "nowhere/st"}), 5, "nowhere");
  const std::string whole = bytes_of(folder / "st");
  fs::resize_file(folder / "st", whole.size() / 2);
  expect_refused(run(on), 3, "cut off");
  std::ofstream(folder / "st", std::ios::binary)
      << whole.substr(0, whole.size() - 5000) + "x" + whole.substr(whole.size() - 4999);
  expect_refused(run(on), 3, "damaged in plane");
  // A frame of the chunk before was rendered again: its state is not that of this sequence.
  std::ofstream(folder / "st", std::ios::binary) << whole;
  write_small_frame(folder / "in.0002.exr", 3);
  expect_refused(run(on), 4, "frame 2 ('in.0002.exr') was rendered again");
}

TEST_F(StateCli, PrerollLeavesNoMoreThanItsBound) {
  // Nothing is rectified and nothing moves: what the chunk does not know fades by its weight. One in a row of pixels at
  // rest, values in 0..1, so the difference of two histories is at most 1.
  synth("still", "1-30", {"--size", "24x14"});
  const Arguments plain = {"--box",        "none",  "--convention",     "none",     "--jitter", "none",
                           "--alpha-rule", "fixed", "--history-filter", "bilinear", "--alpha",  "0.2"};
  ASSERT_EQ(resolve_into("in/still.####.exr", "whole", plain, {}).code, 0);
  ASSERT_EQ(resolve_into("in/still.####.exr", "start", plain, {"-f", "20"}).code, 0);
  const auto furthest = [&](const std::string& to, int frame) {
    double most = 0;
    for (int y = 0; y < 14; ++y)
      for (int x = 0; x < 24; ++x)
        most = std::max(
            most, double(std::abs(pixel_of(path(to, frame), "R", x, y) - pixel_of(path("whole", frame), "R", x, y))));
    return most;
  };
  const double unwarmed = furthest("start", 20);  // history against a single sample, frame 20 itself
  ASSERT_GT(unwarmed, 0.01);
  for (const int preroll : {3, 8}) {
    ASSERT_EQ(
        resolve_into("in/still.####.exr", "chunk", plain, {"-f", "20", "--preroll", std::to_string(preroll)}).code, 0);
    ASSERT_EQ(resolve_into("in/still.####.exr", "start", plain, {"-f", std::to_string(20 - preroll)}).code, 0);
    const double before = furthest("start", 20 - preroll), left = furthest("chunk", 20);
    EXPECT_GT(before, 0);
    EXPECT_LE(left, std::pow(0.8, preroll) * before + 2e-3) << preroll;  // half in the files
  }
  // By the mean of the first 1/alpha = 5 frames, and from there on by the same weights as the whole shot.
  Arguments mean = plain;
  mean[7] = "mean";
  ASSERT_EQ(mean[6], "--alpha-rule");
  ASSERT_EQ(resolve_into("in/still.####.exr", "whole", mean, {}).code, 0);
  ASSERT_EQ(resolve_into("in/still.####.exr", "chunk", mean, {"-f", "12-20"}).code, 0);
  const double fifth = furthest("chunk", 16);
  ASSERT_GT(fifth, 0.01);
  EXPECT_LE(furthest("chunk", 20), std::pow(0.8, 4) * fifth + 2e-3);
}

}  // namespace
}  // namespace varve::test
