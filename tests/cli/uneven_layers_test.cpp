// Layers, samples and deep parts that are not alike: windows of their own, a layer without vectors, deep beside flat.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>

#include "../support/deep_file.h"
#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// Copies a flat file without the channels that begin with `prefix`, attributes and all.
void drop_channels(const std::string& from, const std::string& to, const std::vector<std::string>& prefixes) {
  Imf::InputFile in(from.c_str());
  Imf::Header header = in.header();
  const Imath::Box2i w = header.dataWindow();
  const std::size_t width = std::size_t(w.max.x - w.min.x + 1), height = std::size_t(w.max.y - w.min.y + 1);
  Imf::ChannelList kept;
  std::vector<std::vector<char>> bytes;
  Imf::FrameBuffer frame;
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) {
    const std::string name = c.name();
    if (std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& p) { return name.rfind(p, 0) == 0; })) continue;
    kept.insert(name, c.channel());
    const std::size_t size = c.channel().type == Imf::HALF ? 2 : 4;
    bytes.emplace_back(width * height * size);
    const std::ptrdiff_t origin = w.min.x + std::ptrdiff_t(w.min.y) * std::ptrdiff_t(width);
    frame.insert(name,
                 Imf::Slice(c.channel().type, bytes.back().data() - origin * std::ptrdiff_t(size), size, size * width));
  }
  header.channels() = kept;
  in.setFrameBuffer(frame);
  in.readPixels(w.min.y, w.max.y);
  Imf::OutputFile out(to.c_str(), header);
  out.setFrameBuffer(frame);
  out.writePixels(int(height));
}

/// A flat layer of one color that moves as told, over its own window.
DeepTestPart flat_layer(const std::string& name, const Imath::Box2i& window, const std::vector<double>& rgba,
                        double velocity) {
  DeepTestPart part = deep_part(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1,
                                {{"A", Imf::HALF},
                                 {"B", Imf::HALF},
                                 {"G", Imf::HALF},
                                 {"R", Imf::HALF},
                                 {"velocity.x", Imf::FLOAT},
                                 {"velocity.y", Imf::FLOAT}});
  part.name = name;
  part.flat = true;
  part.display = Imath::Box2i({0, 0}, {23, 11});
  part.data = window;
  for (std::size_t pixel = 0; pixel < part.pixels(); ++pixel)
    add_sample(part, pixel, {rgba[3], rgba[2], rgba[1], rgba[0], velocity, 0});
  return part;
}

const Arguments kVelocity = {"--convention", "varve", "--map", "motion.x=velocity.x", "--map", "motion.y=velocity.y"};

class UnevenLayers : public SceneCli {
 protected:
  Outcome run(Arguments line) const {
    line.insert(line.end(), kVelocity.begin(), kVelocity.end());
    return run_varve(line, folder.path());
  }
};

/// The wall rests before a camera that rests, so it must come out as with its own vectors.
TEST_F(UnevenLayers, ALayerWithoutVectorsMovesWithTheCamera) {
  synth("panes", "1-4", {"--layers"});
  std::filesystem::create_directories(folder / "bare");
  for (int frame = 1; frame <= 4; ++frame) {
    const std::string name = "panes." + number(frame) + ".exr";
    drop_channels(folder / ("in/" + name), folder / ("bare/" + name),
                  {"bg.velocity", "bg.forward", "velocity", "forward"});
  }
  const Arguments each = {"--layer", "fg,mid,bg", "--layers", "each", "--preset", "draft"};
  ASSERT_EQ(resolve_into("in/panes.####.exr", "all", each, {}).code, 0);
  const Outcome made = resolve_into("bare/panes.####.exr", "made", each, {"--verbose"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(says(made.err + made.out, "vectors are made from depth and cameras")) << made.err;
  for (int y = 0; y < 36; y += 5)
    for (int x = 0; x < 64; x += 3)
      EXPECT_NEAR(pixel_of(path("made", 4), "G", x, y), pixel_of(path("all", 4), "G", x, y), 2e-3);
}

TEST_F(UnevenLayers, SamplesWithoutVectorsMoveWithTheCamera) {
  synth("pan", "20-25", {"--samples", "2", "--truth", "box", "--truth-samples", "36"});
  for (const std::string mode : {"resolve", "each"}) {
    const Arguments line = {"--samples", mode, "--preset", "draft"};
    ASSERT_EQ(resolve_into("in/pan.####.exr", mode + "-file", line, {}).code, 0);
    const Outcome made = resolve_into("in/pan.####.exr", mode + "-made", line, {"--convention", "none"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(says(made.err, "100.0 % of the vectors by the camera")) << made.err;
    ASSERT_EQ(resolve_into("in/pan.####.exr", mode + "-rest", line, {"--convention", "none", "--camera", "off"}).code,
              0);
    EXPECT_NEAR(psnr("pan", mode + "-made", "22-24"), psnr("pan", mode + "-file", "22-24"), 0.1);
    EXPECT_GT(psnr("pan", mode + "-made", "22-24"), psnr("pan", mode + "-rest", "22-24") + 1);
  }
}

TEST_F(UnevenLayers, SamplesAndLayersTogetherAreRefused) {
  synth("crossing", "1-2", {"--samples", "2"});
  const Outcome outcome = resolve_into("in/crossing.####.exr", "no", {"--samples", "resolve"},
                                       {"--layers", "composite", "--layer", "sample.0,sample.1"});
  expect_refused(outcome, 2, "--layers");
  EXPECT_TRUE(files_below(folder / "no").empty());
}

TEST_F(UnevenLayers, NoDataIsNoCoverage) {
  for (int frame = 1; frame <= 3; ++frame)
    write_deep(folder / ("w." + number(frame) + ".exr"),
               {flat_layer("bg", Imath::Box2i({0, 0}, {23, 11}), {0.5, 0.25, 0.125, 1}, 0),
                flat_layer("fg", Imath::Box2i({8, 2}, {23, 9}), {0.25, 0.25, 0.25, 0.5}, 0)});
  for (const std::string accumulator : {"recursive", "two-sided", "gather"})
    for (const std::string mode : {"composite", "each"}) {
      const std::string to = accumulator + "-" + mode;
      std::filesystem::create_directories(folder / to);
      const Outcome outcome = run({"resolve", "w.####.exr", "-o", to + "/o.####.exr", "--layer", "fg,bg", "--layers",
                                   mode, "--accumulator", accumulator});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const std::string file = path(to, 3);
      EXPECT_NEAR(pixel_of(file, "R", 2, 5), 0.5, 1e-3) << to;
      EXPECT_NEAR(pixel_of(file, "composite.R", 2, 5), 0.5, 1e-3) << to;
      EXPECT_NEAR(pixel_of(file, "composite.G", 11, 5), 0.375, 1e-3) << to;
      EXPECT_NEAR(pixel_of(file, "composite.G", 11, 0), 0.25, 1e-3) << to;
      EXPECT_NEAR(pixel_of(file, "composite.B", 20, 5), 0.3125, 1e-3) << to;
      EXPECT_NEAR(pixel_of(file, "composite.A", 20, 5), 1, 1e-3) << to;
    }
}

TEST_F(UnevenLayers, WindowsOfWhichNoneHoldsAllAreRefusedWithARemedy) {
  write_deep(folder / "w.0001.exr", {flat_layer("bg", Imath::Box2i({0, 0}, {15, 11}), {0.5, 0.25, 0.125, 1}, 0),
                                     flat_layer("fg", Imath::Box2i({8, 2}, {23, 9}), {0.25, 0.25, 0.25, 0.5}, 0)});
  for (const std::string mode : {"composite", "each"}) {
    const Outcome outcome = run({"resolve", "w.####.exr", "-o", "o.####.exr", "--layer", "fg,bg", "--layers", mode});
    expect_refused(outcome, 4, "--croptofull");
    EXPECT_FALSE(std::filesystem::exists(folder / "o.0001.exr"));
  }
}

/// Emission without coverage that moves, before a wall at rest.
DeepTestPart glow() {
  DeepTestPart part = deep_part(12, 6,
                                {{"A", Imf::HALF},
                                 {"B", Imf::HALF},
                                 {"G", Imf::HALF},
                                 {"R", Imf::HALF},
                                 {"Z", Imf::FLOAT},
                                 {"velocity.x", Imf::FLOAT},
                                 {"velocity.y", Imf::FLOAT}});
  for (std::size_t pixel = 0; pixel < part.pixels(); ++pixel) {
    add_sample(part, pixel, {1, 0.1, 0.1, 0.1, 10, 0, 0});
    if (pixel % 12 < 6) add_sample(part, pixel, {0, 2, 2, 2, 4, -2, 0});
  }
  return part;
}

TEST_F(UnevenLayers, DeepLightWithoutCoverageLendsItsMotionByContribution) {
  for (int frame = 1; frame <= 2; ++frame) write_deep(folder / ("d." + number(frame) + ".exr"), {glow()});
  for (const bool contribution : {false, true}) {
    const std::string to = contribution ? "light" : "cover";
    std::filesystem::create_directories(folder / to);
    const Outcome outcome = run({"resolve", "d.####.exr", "-o", to + "/o.####.exr", "--dilation", "none", "--aov",
                                 "motion", "--layer-rule", contribution ? "contribution" : "variation"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(pixel_of(path(to, 1), "varve.motion.x", 3, 3), contribution ? -2.0f : 0.0f);
    EXPECT_EQ(pixel_of(path(to, 1), "varve.motion.x", 9, 3), 0.0f);
    EXPECT_NEAR(pixel_of(path(to, 1), "R", 3, 3), 2.1f, 2e-3);
  }
}

/// Number of samples in every pixel of a deep part, and all red ones.
struct DeepRed {
  std::vector<unsigned> counts;
  std::vector<float> red;
};

DeepRed deep_red(const std::string& path, int number) {
  Imf::MultiPartInputFile file(path.c_str());
  Imf::DeepScanLineInputPart part(file, number);
  const Imath::Box2i w = part.header().dataWindow();
  const std::size_t width = std::size_t(w.max.x - w.min.x + 1);
  DeepRed all;
  all.counts.resize(width * std::size_t(w.max.y - w.min.y + 1));
  std::vector<char*> at(all.counts.size());
  const std::ptrdiff_t origin = w.min.x + w.min.y * std::ptrdiff_t(width);
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(all.counts.data() - origin),
                                          sizeof(unsigned), sizeof(unsigned) * width));
  frame.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(at.data() - origin), sizeof(char*),
                                   sizeof(char*) * width, sizeof(float)));
  part.setFrameBuffer(frame);
  part.readPixelSampleCounts(w.min.y, w.max.y);
  std::size_t total = 0;
  for (const unsigned count : all.counts) total += count;
  all.red.resize(total);
  std::size_t next = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = reinterpret_cast<char*>(all.red.data() + next);
    next += all.counts[i];
  }
  part.readPixels(w.min.y, w.max.y);
  return all;
}

TEST_F(UnevenLayers, ADeepPartBesideAFlatColorIsCopiedUntouched) {
  DeepTestPart deep = glow();
  deep.name = "deep";
  deep.display = Imath::Box2i({0, 0}, {23, 11});
  for (int frame = 1; frame <= 2; ++frame)
    write_deep(folder / ("m." + number(frame) + ".exr"),
               {flat_layer("main", Imath::Box2i({0, 0}, {23, 11}), {0.5, 0.25, 0.125, 1}, 0), deep});
  std::filesystem::create_directories(folder / "out");
  const Outcome outcome = run({"resolve", "m.####.exr", "-o", "out/o.####.exr"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const DeepRed before = deep_red(folder / "m.0002.exr", 1), after = deep_red(path("out", 2), 1);
  EXPECT_EQ(before.counts, after.counts);
  EXPECT_EQ(before.red, after.red);
  EXPECT_EQ(before.red.size(), 12u * 6u + 6u * 6u);
}

TEST_F(UnevenLayers, DeepFilesAreCompared) {
  write_deep(folder / "a.0001.exr", {glow()});
  DeepTestPart other = glow();
  other.channels[3].values[5][0] = 0.5;
  write_deep(folder / "b.0001.exr", {other});
  const Outcome same = run_varve({"compare", "a.0001.exr", "a.0001.exr"}, folder.path());
  const Outcome differs = run_varve({"compare", "a.0001.exr", "b.0001.exr"}, folder.path());
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_EQ(differs.code, 1) << differs.out << differs.err;
}

}  // namespace
}  // namespace varve::test
