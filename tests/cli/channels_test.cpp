// varve resolve --channels as a user meets it, on a sequence of two lights that add up to the beauty.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "program.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

constexpr int kWidth = 48, kHeight = 32;

float noise(int x, int y, int frame, unsigned salt) {
  unsigned h = unsigned(x) * 73856093u ^ unsigned(y) * 19349663u ^ unsigned(frame) * 83492791u ^ salt * 2654435761u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return float(h >> 8) / 16777216.0f;
}

/// V.Combined = V.Key + V.Fill, all float; V.AO, a number without a color; ids, depth, vectors of a pan by one pixel.
void write_lights(const std::filesystem::path& path, int frame, bool bad = false) {
  std::map<std::string, std::vector<float>> channels;
  const auto at = [](int x, int y) { return std::size_t(y) * kWidth + std::size_t(x); };
  for (const char* name :
       {"V.Combined.R", "V.Combined.G", "V.Combined.B", "V.Key.R", "V.Key.G", "V.Key.B", "V.Fill.R", "V.Fill.G",
        "V.Fill.B", "V.AO", "V.Depth.Z", "V.Vector.X", "V.Vector.Y", "V.Vector.Z", "V.Vector.W", "V.IndexOB.X"})
    channels[name].assign(std::size_t(kWidth) * kHeight, 0.0f);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int u = x - frame;  // where the pixel lies on the surface, which moves one pixel to the right
      for (const char* k : {"R", "G", "B"}) {
        const unsigned salt = unsigned(k[0]);
        const float shadow = (u + y) % 16 < 8 ? 1.0f : 0.05f;
        const float key = 3 * shadow * (0.5f + noise(u, y, frame, salt)),
                    fill = 0.2f + 0.2f * noise(u, y, frame, salt + 1);
        channels[std::string("V.Key.") + k][at(x, y)] = key;
        channels[std::string("V.Fill.") + k][at(x, y)] = fill;
        channels[std::string("V.Combined.") + k][at(x, y)] = key + fill;
      }
      channels["V.AO"][at(x, y)] = noise(x, y, frame, 7) < 0.5f ? 0.0f : 1.0f;
      channels["V.Depth.Z"][at(x, y)] = 10;
      channels["V.Vector.X"][at(x, y)] = channels["V.Vector.Z"][at(x, y)] = -1;
      channels["V.IndexOB.X"][at(x, y)] = float(x % 5);
    }
  if (bad) channels["V.Fill.G"][at(20, 10)] = NAN;
  Imf::Header header(kWidth, kHeight);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer pixels;
  for (auto& [name, values] : channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    pixels.insert(
        name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), sizeof(float) * kWidth));
  }
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(pixels);
  file.writePixels(kHeight);
}

class Channels : public testing::Test {
 protected:
  void SetUp() override {
    for (int frame = 1; frame <= 6; ++frame) write_lights(folder / ("in.000" + std::to_string(frame) + ".exr"), frame);
    std::filesystem::create_directory(folder / "out");
  }
  Outcome run(std::vector<std::string> more) const {
    more.insert(more.begin(), {"resolve", "in.####.exr", "-o", "out/o.####.exr"});
    return run_varve(more, folder.path());
  }
  float out(const std::string& channel, int x, int y, int frame = 6) const {
    return pixel_of(folder / ("out/o.000" + std::to_string(frame) + ".exr"), channel, x, y);
  }
  float in(const std::string& channel, int x, int y, int frame = 6) const {
    return pixel_of(folder / ("in.000" + std::to_string(frame) + ".exr"), channel, x, y);
  }
  Folder folder;
};

TEST_F(Channels, LightsStillAddUpToTheBeauty) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                               {"--rule", "clamp"},
                                               {"--box", "minmax", "--anchor", "mean"},
                                               {"--space", "ycocg", "--history-filter", "bilinear"},
                                               {"--accumulator", "gather", "--reach", "2"}}) {
    std::vector<std::string> line = {"--channels", "Key,Fill", "--report", "report.json"};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome outcome = run(line);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("lights add up to the color within"), std::string::npos) << outcome.err;
    EXPECT_NE(bytes_of(folder / "report.json").find("\"light_pixels_adding_up\":1536"), std::string::npos);
    int changed = 0;
    for (const auto& [x, y] : {std::pair{3, 3}, {20, 10}, {24, 17}, {40, 30}, {47, 0}})
      for (const std::string k : {"R", "G", "B"}) {
        const float beauty = out("V.Combined." + k, x, y), sum = out("V.Key." + k, x, y) + out("V.Fill." + k, x, y);
        EXPECT_NEAR(sum, beauty, 1e-6f * 2 * beauty);
        changed += out("V.Fill." + k, x, y) != in("V.Fill." + k, x, y);
      }
    EXPECT_GT(changed, 8);
    EXPECT_EQ(out("V.AO", 20, 10), in("V.AO", 20, 10)) << "what was not named stays";
    EXPECT_EQ(out("V.IndexOB.X", 21, 10), in("V.IndexOB.X", 21, 10));
  }
}

TEST_F(Channels, TheBeautyIsTheSameWithAndWithoutThem) {
  ASSERT_EQ(run({}).code, 0);
  const float alone = out("V.Combined.G", 20, 10);
  ASSERT_EQ(run({"--channels", "Key,AO"}).code, 0);
  EXPECT_EQ(out("V.Combined.G", 20, 10), alone);
  ASSERT_EQ(run({"--channels", "Key,AO", "--channel-weights", "own"}).code, 0);
  EXPECT_EQ(out("V.Combined.G", 20, 10), alone);
}

TEST_F(Channels, OcclusionIsResolvedByEitherWeights) {
  for (const char* weights : {"own", "beauty"}) {
    ASSERT_EQ(run({"--channels", "ao", "--channel-weights", weights, "--box", "none"}).code, 0);
    double mean = 0, spread = 0;
    int n = 0;
    for (int y = 8; y < 24; y += 3)
      for (int x = 12; x < 40; x += 3, ++n) {
        const double v = double(out("V.AO", x, y));
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
        mean += v;
        spread += (v - 0.5) * (v - 0.5);
      }
    EXPECT_NEAR(mean / n, 0.5, 0.15) << weights;
    EXPECT_LT(spread / n, 0.25 / 3) << weights << ": six frames of coin tosses, averaged, spread a sixth as far";
  }
}

TEST_F(Channels, PlanProbeAndManifestNameThem) {
  const Outcome probe = run_varve({"probe", "in.####.exr", "--channels", "Key*"}, folder.path());
  EXPECT_NE(probe.out.find("companion"), std::string::npos) << probe.out;
  EXPECT_NE(probe.out.find("3 channels go by the weights of their color"), std::string::npos) << probe.out;
  const Outcome without = run_varve({"probe", "in.####.exr"}, folder.path());
  EXPECT_NE(without.out.find("--channels names some"), std::string::npos) << without.out;
  ASSERT_EQ(run({"--channels", "Key", "--frames", "1"}).code, 0);
  EXPECT_NE(bytes_of(folder / "out/o.0001.exr").find("channels=Key channel-weights=beauty"), std::string::npos);
}

TEST_F(Channels, WhatCannotBeAveragedIsRefused) {
  for (const char* name : {"Depth", "Vector", "IndexOB", "Combined", "Nothing", "V.Depth.Z"}) {
    const Outcome outcome = run({"--channels", name});
    EXPECT_EQ(outcome.code, 4) << name << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(std::string("--channels ") + name), std::string::npos) << outcome.err;
    EXPECT_TRUE(files_below(folder / "out").empty());
  }
  EXPECT_EQ(run({"--channels", "Key,"}).code, 2);
  EXPECT_EQ(run({"--channels", "Key", "--channel-weights", "none"}).code, 2);
}

TEST_F(Channels, BadValuesAreCountedAndDoNotSpread) {
  write_lights(folder / "in.0003.exr", 3, true);
  const Outcome outcome = run({"--channels", "Key,Fill"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("1 values of --channels repaired"), std::string::npos) << outcome.err;
  for (int frame = 3; frame <= 6; ++frame)
    for (int x = 16; x < 28; ++x) EXPECT_TRUE(std::isfinite(out("V.Fill.G", x, 10, frame)));
}

TEST_F(Channels, OnlyTheResolvedAreWrittenOnRequest) {
  ASSERT_EQ(run({"--channels", "Key", "--keep", "none", "--frames", "1-2"}).code, 0);
  const std::string bytes = bytes_of(folder / "out/o.0002.exr");
  EXPECT_NE(bytes.find("V.Key.R"), std::string::npos);
  EXPECT_EQ(bytes.find("V.Fill.R"), std::string::npos);
}

TEST_F(Channels, SameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(run({"--channels", "Key,Fill,AO", "--threads", "1"}).code, 0);
  const std::string one = bytes_of(folder / "out/o.0006.exr");
  ASSERT_EQ(run({"--channels", "Key,Fill,AO", "--threads", "3"}).code, 0);
  EXPECT_EQ(bytes_of(folder / "out/o.0006.exr"), one);
}

TEST_F(Channels, FiltersThatCannotKeepTheSumAreRefused) {
  EXPECT_EQ(run({"--channels", "Key", "--history-filter", "bspline3"}).code, 2);
}

TEST_F(Channels, AccumulatorsThatCannotKeepTheSumAreRefused) {
  const Outcome outcome = run({"--channels", "Key", "--accumulator", "two-sided"});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("--channel-weights own"), std::string::npos) << outcome.err;
}

/// A beauty without vectors in one part, a light in another one that reaches two pixels beyond it on every side.
void write_parts(const std::filesystem::path& path, int frame) {
  const Imath::Box2i inner({0, 0}, {15, 11}), outer({-2, -2}, {17, 13}), display({0, 0}, {15, 11});
  std::vector<float> beauty(16 * 12), light(20 * 16);
  for (int y = -2; y < 14; ++y)
    for (int x = -2; x < 18; ++x) {
      const float value = 0.5f + noise(x + 2, y + 2, frame, 3);
      light[std::size_t(y + 2) * 20 + std::size_t(x + 2)] = value;
      if (x >= 0 && x < 16 && y >= 0 && y < 12) beauty[std::size_t(y) * 16 + std::size_t(x)] = value;
    }
  std::vector<Imf::Header> headers;
  for (const auto& [name, window] : {std::pair{"beauty", inner}, {"key", outer}}) {
    Imf::Header header(display, window);
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const char* k : {"R", "G", "B"}) header.channels().insert(k, Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
  for (int part = 0; part < 2; ++part) {
    Imf::FrameBuffer pixels;
    for (const char* k : {"R", "G", "B"})
      pixels.insert(k,
                    Imf::Slice::Make(Imf::FLOAT, part == 0 ? beauty.data() : light.data(), part == 0 ? inner : outer));
    Imf::OutputPart out(file, part);
    out.setFrameBuffer(pixels);
    out.writePixels(part == 0 ? 12 : 16);
  }
}

std::vector<float> green_of(const std::filesystem::path& path, int part) {
  Imf::MultiPartInputFile file(path.c_str());
  Imf::InputPart in(file, part);
  const Imath::Box2i window = in.header().dataWindow();
  std::vector<float> values(std::size_t(window.size().x + 1) * std::size_t(window.size().y + 1));
  Imf::FrameBuffer pixels;
  pixels.insert("G", Imf::Slice::Make(Imf::FLOAT, values.data(), window));
  in.setFrameBuffer(pixels);
  in.readPixels(window.min.y, window.max.y);
  return values;
}

TEST_F(Channels, LightsMayLieInAPartOfTheirOwnWithAnotherWindow) {
  for (int frame = 1; frame <= 3; ++frame) write_parts(folder / ("p.000" + std::to_string(frame) + ".exr"), frame);
  const Outcome outcome = run_varve({"resolve", "p.####.exr", "-o", "out/p.####.exr", "--layer", "beauty", "--channels",
                                     "key", "--convention", "none"},
                                    folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<float> beauty = green_of(folder / "out/p.0003.exr", 0),
                           light = green_of(folder / "out/p.0003.exr", 1), before = green_of(folder / "p.0003.exr", 1);
  int changed = 0;
  for (int y = -2; y < 14; ++y)
    for (int x = -2; x < 18; ++x) {
      const std::size_t at = std::size_t(y + 2) * 20 + std::size_t(x + 2);
      if (x >= 0 && x < 16 && y >= 0 && y < 12) {
        EXPECT_NEAR(light[at], beauty[std::size_t(y) * 16 + std::size_t(x)], 2e-6f) << x << "," << y;
        changed += light[at] != before[at];
      } else {
        EXPECT_EQ(light[at], before[at]) << x << "," << y;
      }
    }
  EXPECT_GT(changed, 150);
}

}  // namespace
}  // namespace varve::test
