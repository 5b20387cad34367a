// What happens in a sequence is told and used; a jitter that is not what the pixels show is told.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene_cli.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

class Facts : public SceneCli {
 protected:
  std::string in(const std::string& scene, int frame) const {
    return folder / ("in/" + scene + "." + number(frame) + ".exr");
  }
  std::string probe(const std::string& scene, const Arguments& more) const {
    Arguments line = {"probe", "in/" + scene + ".####.exr"};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome outcome = run_varve(line, folder.path());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out;
  }
};

TEST_F(Facts, ACutIsFoundForEveryAccumulatorAndInEveryChunk) {
  synth("cut", "22-28");
  for (const std::string accumulator : {"gather", "two-sided", "recursive"}) {
    const Arguments choices = {"--accumulator", accumulator, "--find-cuts", "on",
                               "--keep",        "none",      "--progress",  "none"};
    const Outcome whole = resolve_into("in/cut.####.exr", "whole", choices, {});
    ASSERT_EQ(whole.code, 0) << whole.err;
    EXPECT_NE(whole.err.find("frame 25 is taken for the first of a new shot"), std::string::npos) << whole.err;
    Arguments given = {"--accumulator", accumulator, "--cuts", "25", "--keep", "none", "--progress", "none"};
    ASSERT_EQ(resolve_into("in/cut.####.exr", "given", given, {}).code, 0);
    for (const int frame : {24, 25, 28})
      EXPECT_EQ(pixel_of(path("whole", frame), "G", 30, 18), pixel_of(path("given", frame), "G", 30, 18));
    if (accumulator == "recursive") continue;
    ASSERT_EQ(resolve_into("in/cut.####.exr", "chunk", choices, {"-f", "25-26"}).code, 0);
    for (const int frame : {25, 26}) EXPECT_EQ(bytes_of(path("chunk", frame)), bytes_of(path("whole", frame)));
  }
}

TEST_F(Facts, DoubledHeldAndMissingFramesAreTold) {
  synth("pan", "1-9");
  fs::copy_file(in("pan", 3), in("pan", 4), fs::copy_options::overwrite_existing);
  fs::copy_file(in("pan", 6), in("pan", 7), fs::copy_options::overwrite_existing);
  fs::copy_file(in("pan", 6), in("pan", 8), fs::copy_options::overwrite_existing);
  const std::string text = probe("pan", {"--facts"});
  EXPECT_NE(text.find("duplicate at 4: every pixel is the same to the last bit as in frame 3"), std::string::npos)
      << text;
  EXPECT_NE(text.find("freeze at 7-8"), std::string::npos) << text;
  EXPECT_EQ(text.find("cut at"), std::string::npos) << text;
  fs::remove(in("pan", 2));
  const std::string json = probe("pan", {"--facts", "--json"});
  EXPECT_NE(json.find("\"facts\":{\"frames\":8,\"found\":[{\"kind\":\"gap\",\"frame\":2,\"until\":2"),
            std::string::npos)
      << json;
}

TEST_F(Facts, ADoubledFrameCountsOnceInTheGather) {
  synth("still", "1-5");
  const Arguments choices = {"--accumulator", "gather", "--keep", "none", "--aov", "frames", "--gain", "off"};
  ASSERT_EQ(resolve_into("in/still.####.exr", "apart", choices, {}).code, 0);
  fs::copy_file(in("still", 3), in("still", 2), fs::copy_options::overwrite_existing);
  fs::copy_file(in("still", 3), in("still", 4), fs::copy_options::overwrite_existing);
  ASSERT_EQ(resolve_into("in/still.####.exr", "doubled", choices, {}).code, 0);
  EXPECT_GT(pixel_of(path("apart", 3), "varve.frames", 30, 18), 3.0f);
  EXPECT_LE(pixel_of(path("doubled", 3), "varve.frames", 30, 18), 3.0f);
}

TEST_F(Facts, AQuietSequenceRaisesNoAlarm) {
  for (const std::string scene : {"pan", "pulse"}) {
    synth(scene, "8-14");
    EXPECT_NE(probe(scene, {"--facts"}).find("no cut, flash, freeze"), std::string::npos) << probe(scene, {"--facts"});
  }
}

TEST_F(Facts, TheJitterIsHeldAgainstThePixelsAlongAMove) {
  // In smaller pictures this scene has too few edges to tell a tenth of a pixel, and is said to have.
  ASSERT_EQ(run_varve({"synth", "pan", "-o", "in", "--size", "320x180", "-f", "1-7", "-q"}, folder.path()).code, 0);
  EXPECT_NE(probe("pan", {"--check-jitter", "7"}).find("the stated jitter is what the pixels show"), std::string::npos);
  fs::remove_all(folder / "in");
  synth("pan", "1-7");
  EXPECT_NE(probe("pan", {"--check-jitter", "7"}).find("the pixels do not tell the jitter: only "), std::string::npos);
}

TEST_F(Facts, TheJitterIsHeldAgainstThePixelsAtRest) {
  ASSERT_EQ(run_varve({"synth", "still", "-o", "in", "--size", "160x90", "-f", "1-9", "-q"}, folder.path()).code, 0);
  EXPECT_NE(probe("still", {"--check-jitter", "9"}).find("the stated jitter is what the pixels show"),
            std::string::npos);
  std::ofstream list(folder / "twice.csv");
  list << "frame,jx,jy\n";
  const double x[] = {0, -0.25, 0.25, -0.375, 0.125, -0.125, 0.375, -0.4375, 0.0625};
  const double y[] = {-0.166667, 0.166667, -0.388889, -0.055556, 0.277778, -0.277778, 0.055556, 0.388889, -0.462963};
  for (int f = 0; f < 9; ++f) list << f + 1 << "," << 2 * x[f] << "," << -2 * y[f] << "\n";
  list.close();
  const std::string text = probe("still", {"--check-jitter", "9", "--jitter", "twice.csv"});
  EXPECT_NE(text.find("the samples moved half as far as stated"), std::string::npos) << text;
  EXPECT_NE(text.find("y is turned round"), std::string::npos) << text;
  EXPECT_NE(probe("still", {"--jitter", "pixels"}).find("measured in the pixels"), std::string::npos);
}

TEST_F(Facts, AJitterThatCannotBeMeasuredIsRefusedWithTheReason) {
  synth("pan", "1-1");
  const Outcome outcome = resolve_into("in/pan.####.exr", "o", {"--jitter", "pixels"}, {});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("one frame only"), std::string::npos) << outcome.err;
  EXPECT_NE(probe("pan", {"--check-jitter", "4"}).find("the pixels do not tell the jitter"), std::string::npos);
}

}  // namespace
}  // namespace varve::test
