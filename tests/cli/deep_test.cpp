// Deep sequences from the command line.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <gtest/gtest.h>

#include "../support/deep_file.h"
#include "program.h"
#include "sentence.h"

namespace varve::test {
namespace {

/// A half-transparent square that moves by two pixels a frame in front of a wall, with a flat hole beside it.
void write_sequence(const Folder& folder, int frames, const std::string& name = "deep") {
  for (int f = 0; f < frames; ++f) {
    DeepTestPart part = deep_part(24, 10,
                                  {{"A", Imf::HALF},
                                   {"B", Imf::HALF},
                                   {"G", Imf::HALF},
                                   {"R", Imf::HALF},
                                   {"Z", Imf::FLOAT},
                                   {"ZBack", Imf::FLOAT},
                                   {"velocity.x", Imf::FLOAT},
                                   {"velocity.y", Imf::FLOAT}});
    part.name = name;
    part.data = Imath::Box2i({2, 1}, {21, 8});
    for (DeepTestChannel& channel : part.channels) channel.values.resize(part.pixels());
    for (std::size_t pixel = 0; pixel < part.pixels(); ++pixel) {
      const int x = int(pixel) % part.width();
      if (x >= 18) continue;
      add_sample(part, pixel, {1, 0.5, 0.25, 0.125, 10, 10, 0, 0});
      if (x >= 2 * f && x < 2 * f + 6) add_sample(part, pixel, {0.75, 0.1, 0.2, 0.6, 4, 6, -2, 0});
    }
    write_deep(folder / ("d.000" + std::to_string(f + 1) + ".exr"), {part});
  }
}

std::vector<float> row_of(const std::string& path, const std::string& channel, int y) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i w = file.header().dataWindow();
  std::vector<float> all(std::size_t(w.max.x - w.min.x + 1));
  Imf::FrameBuffer frame;
  frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(all.data() - w.min.x), 4, 0));
  file.setFrameBuffer(frame);
  file.readPixels(y);
  return all;
}

TEST(DeepCli, ResolvesToAFlatPartThatFollowsTheWinner) {
  Folder folder;
  write_sequence(folder, 3);
  const Outcome run = run_varve({"resolve", "d.####.exr", "-o", "o.####.exr", "--convention", "varve", "--map",
                                 "motion.x=velocity.x", "--map", "motion.y=velocity.y", "--aov", "motion"},
                                folder.path());
  ASSERT_EQ(run.code, 0) << run.err;
  Imf::InputFile file((folder / "o.0003.exr").c_str());
  EXPECT_EQ(file.header().type(), "scanlineimage");
  EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({2, 1}, {21, 8}));
  EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {23, 9}));
  EXPECT_EQ(file.header().findTypedAttribute<Imf::IntAttribute>("version"), nullptr);
  EXPECT_EQ(file.header().channels().findChannel("ZBack"), nullptr);
  EXPECT_EQ(file.header().channels().findChannel("R")->type, Imf::HALF);
  const std::vector<float> red = row_of(folder / "o.0003.exr", "R", 4), z = row_of(folder / "o.0003.exr", "Z", 4),
                           motion = row_of(folder / "o.0003.exr", "varve.motion.x", 4),
                           alpha = row_of(folder / "o.0003.exr", "A", 4);
  EXPECT_NEAR(red[6], 0.6 + 0.25 * 0.125, 1e-3);
  EXPECT_NEAR(red[14], 0.125, 1e-3);
  EXPECT_EQ(z[6], 4);
  EXPECT_EQ(z[14], 10);
  EXPECT_EQ(z[19], 1e10f);
  EXPECT_EQ(alpha[19], 0);
  EXPECT_EQ(motion[6], -2);
  EXPECT_EQ(motion[15], 0);
}

TEST(DeepCli, EveryAccumulatorTakesIt) {
  Folder folder;
  write_sequence(folder, 3);
  for (const char* accumulator : {"recursive", "two-sided", "gather"}) {
    const std::string out = std::string(accumulator) + ".####.exr";
    const Outcome run = run_varve({"resolve", "d.####.exr", "-o", out, "--convention", "varve", "--map",
                                   "motion.x=velocity.x", "--map", "motion.y=velocity.y", "--accumulator", accumulator},
                                  folder.path());
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NEAR(row_of(folder / (std::string(accumulator) + ".0002.exr"), "R", 4)[4], 0.6 + 0.25 * 0.125, 1e-2);
  }
}

TEST(DeepCli, ProbeSaysWhatIsDeepAndHowMuch) {
  Folder folder;
  write_sequence(folder, 2);
  const Outcome run = run_varve({"probe", "d.####.exr", "--convention", "none", "--pixels", "1"}, folder.path());
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* words : {"deep scanline", "flatten", "volumes split where they overlap", "samples per pixel"})
    EXPECT_NE(run.out.find(words), std::string::npos) << words << "\n" << run.out;
}

TEST(DeepCli, DamageIsInput) {
  Folder folder;
  write_sequence(folder, 1);
  const std::string bytes = bytes_of(folder / "d.0001.exr");
  for (const std::size_t length : {bytes.size() - 1, bytes.size() * 3 / 4, bytes.size() / 2}) {
    std::filesystem::resize_file(folder / "d.0001.exr", length);
    const Outcome run = run_varve({"resolve", "d.####.exr", "-o", "o.####.exr", "--convention", "none"}, folder.path());
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "o.0001.exr"));
  }
}

}  // namespace
}  // namespace varve::test
