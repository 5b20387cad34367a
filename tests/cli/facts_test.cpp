// What happens in a sequence is told and used; a jitter that is not what the pixels show is told.
#include <gtest/gtest.h>

#include <Imath/half.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "scene_cli.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

/// Multiplies the light of a frame of synth.
void scale_light(const std::string& path, float factor) {
  std::map<std::string, std::vector<char>> data;
  Imf::FrameBuffer pixels;
  Imf::Header header;
  int width = 0, height = 0;
  {
    Imf::InputFile file(path.c_str(), 1);
    header = file.header();
    width = header.dataWindow().max.x + 1, height = header.dataWindow().max.y + 1;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      const std::size_t bytes = c.channel().type == Imf::HALF ? 2 : 4, row = bytes * std::size_t(width);
      std::vector<char>& rows = data[c.name()];
      rows.resize(row * std::size_t(height));
      pixels.insert(c.name(), Imf::Slice(c.channel().type, rows.data(), bytes, row));
    }
    file.setFrameBuffer(pixels);
    file.readPixels(0, height - 1);
  }
  for (const char* channel : {"R", "G", "B"}) {
    half* values = reinterpret_cast<half*>(data.at(channel).data());
    for (int i = 0; i < width * height; ++i) values[i] = half(float(values[i]) * factor);
  }
  Imf::OutputFile file(path.c_str(), header, 1);
  file.setFrameBuffer(pixels);
  file.writePixels(height);
}

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

TEST_F(Facts, AStepOfTheExposureIsToldWithItsRatioAndIsNoCut) {
  for (const float factor : {1.5f, 0.25f}) {
    fs::remove_all(folder / "in");
    synth("pan", "1-9");
    for (int frame = 5; frame <= 9; ++frame) scale_light(in("pan", frame), factor);
    const std::string text = probe("pan", {"--facts"});
    EXPECT_NE(text.find("exposure at 5: light times "), std::string::npos) << text;
    EXPECT_EQ(text.find("cut at"), std::string::npos) << text;
    EXPECT_EQ(text.find("flash at"), std::string::npos) << text;
    const std::string json = probe("pan", {"--facts", "--json"});
    const std::size_t at = json.find("\"kind\":\"exposure\",\"frame\":5,\"until\":5,\"repeats\":null,\"ratio\":");
    ASSERT_NE(at, std::string::npos) << json;
    EXPECT_NEAR(std::strtod(json.c_str() + json.find("\"ratio\":", at) + 8, nullptr), factor, 0.03 * factor);
    // Nor does a resolve take it for one.
    const Outcome outcome =
        resolve_into("in/pan.####.exr", "o", {"--find-cuts", "on", "--keep", "none", "--progress", "none"}, {});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err.find("new shot"), std::string::npos) << outcome.err;
  }
}

TEST_F(Facts, TwoFramesOfOtherLightAreAFlash) {
  ASSERT_EQ(run_varve({"synth", "pan", "-o", "in", "--size", "160x90", "-f", "1-8", "-q"}, folder.path()).code, 0);
  for (int frame = 4; frame <= 5; ++frame) scale_light(in("pan", frame), 2);
  const std::string text = probe("pan", {"--facts"});
  EXPECT_NE(text.find("flash at 4-5: light times 2.0"), std::string::npos) << text;
  EXPECT_EQ(text.find("exposure at"), std::string::npos) << text;
}

TEST_F(Facts, ThreadsAndChunksChangeNothingOfWhatIsMeasured) {
  ASSERT_EQ(run_varve({"synth", "still", "-o", "in", "--size", "160x90", "-f", "1-5", "-q"}, folder.path()).code, 0);
  const Arguments choices = {"--accumulator", "gather", "--find-cuts", "on",         "--jitter",
                             "pixels",        "--keep", "none",        "--progress", "none"};
  ASSERT_EQ(resolve_into("in/still.####.exr", "one", choices, {"-j", "1"}).code, 0);
  ASSERT_EQ(resolve_into("in/still.####.exr", "three", choices, {"-j", "3", "-f", "3-4"}).code, 0);
  for (const int frame : {3, 4}) EXPECT_EQ(bytes_of(path("one", frame)), bytes_of(path("three", frame)));
  const auto measured = [&](const std::string& threads) {
    const std::string text = probe("still", {"--check-jitter", "5", "--facts", "-j", threads});
    return text.substr(std::min(text.find("Jitter in the pixels"), text.size()));
  };
  const std::string one = measured("1");
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(one, measured("3"));
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
