// The committed sequences are what sequences/README.md says they are.

#include "paths.h"

#include <gtest/gtest.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

const std::string kCut = VARVE_SOURCE "/sequences/courtyard", kFull = VARVE_DATA "/courtyard";

std::string frame_name(int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "/frame.%04d.exr", frame);
  return name;
}

std::vector<float> read(Imf::InputFile& file, const std::string& channel) {
  const Imath::Box2i window = file.header().dataWindow();
  const std::size_t width = std::size_t(window.max.x - window.min.x + 1);
  std::vector<float> values(width * std::size_t(window.max.y - window.min.y + 1));
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float), sizeof(float) * width));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return values;
}

std::string stored(const Imf::Attribute& attribute) {
  Imf::StdOSStream stream;
  attribute.writeValueTo(stream, 2);
  return stream.str();
}

/// Largest difference that the rounding allows.
double tolerance(const std::string& channel, float truth) {
  if (channel.ends_with("Depth.Z")) return truth >= 1e10f ? 0 : std::ldexp(std::abs(double(truth)), -16);
  return channel.find("Vector") != std::string::npos ? 1. / 8192 : 0;
}

TEST(CourtyardSequence, EqualsTheRenderItWasCutFrom) {
  if (!std::filesystem::exists(kFull)) GTEST_SKIP() << "needs the full render in " << kFull;
  for (int frame = 1; frame <= 16; ++frame) {
    Imf::InputFile cut((kCut + frame_name(frame)).c_str()), full((kFull + "/jit" + frame_name(frame)).c_str());
    for (auto a = full.header().begin(); a != full.header().end(); ++a) {
      if (std::string(a.name()) == "channels") continue;
      const auto kept = cut.header().find(a.name());
      ASSERT_TRUE(kept != cut.header().end()) << a.name();
      EXPECT_EQ(stored(kept.attribute()), stored(a.attribute())) << a.name();
    }
    for (auto a = cut.header().begin(); a != cut.header().end(); ++a)
      EXPECT_TRUE(full.header().find(a.name()) != full.header().end()) << a.name() << " was added";
    int channels = 0;
    for (auto c = cut.header().channels().begin(); c != cut.header().channels().end(); ++c, ++channels) {
      EXPECT_EQ(c.channel().type, full.header().channels()[c.name()].type);
      const std::vector<float> value = read(cut, c.name()), truth = read(full, c.name());
      ASSERT_EQ(value.size(), truth.size());
      for (std::size_t i = 0; i < value.size(); ++i)
        ASSERT_LE(std::abs(double(value[i]) - double(truth[i])), tolerance(c.name(), truth[i])) << c.name() << " " << i;
    }
    EXPECT_EQ(channels, 9);
  }
}

TEST(CourtyardSequence, IsSmallAndWhole) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kCut))
    if (entry.is_regular_file()) bytes += entry.file_size();
  EXPECT_LE(bytes, 8'000'000u);
  for (int frame : {9, 16}) {
    Imf::InputFile reference((kCut + "/ref" + frame_name(frame)).c_str());
    EXPECT_TRUE(reference.header().channels().findChannel("R"));
    EXPECT_TRUE(reference.isComplete());
  }
  EXPECT_TRUE(std::filesystem::exists(kCut + "/jitter.csv"));
}

}  // namespace
