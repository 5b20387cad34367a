// varve resolve --extra as a user meets it: whole frames and crops as further samples, and what is refused.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>

#include "scene_cli.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

/// Pixels, both ends included.
struct Box {
  int x0, y0, x1, y1;
};

struct CropOptions {
  bool jitter = true;        ///< keep the attribute
  bool display = true;       ///< keep the display window; else it is that of the crop, from 0, as Blender has it
  const char* without = "";  ///< leave this channel out
  int move_x = 0;            ///< of the data window, pixels
};

/// One part of a file as a file of its own, with these pixels only.
void write_crop(const fs::path& from, int part, const fs::path& to, const Box& box, const CropOptions& o = {}) {
  Imf::MultiPartInputFile file(from.c_str(), 0);
  Imf::InputPart in(file, part);
  Imf::Header header = in.header();
  const Imath::Box2i data = header.dataWindow();
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  std::map<std::string, std::vector<char>> planes;
  Imf::FrameBuffer all, cut;
  for (Imf::ChannelList::ConstIterator c = header.channels().begin(); c != header.channels().end(); ++c) {
    const std::size_t size = c.channel().type == Imf::HALF ? 2 : 4, row = size * std::size_t(width);
    std::vector<char>& plane = planes[c.name()];
    plane.resize(row * std::size_t(height));
    char* origin = plane.data() - std::ptrdiff_t(size) * data.min.x - std::ptrdiff_t(row) * data.min.y;
    all.insert(c.name(), Imf::Slice(c.channel().type, origin, size, row));
    const std::ptrdiff_t left = o.display ? o.move_x : box.x0, above = o.display ? 0 : box.y0;
    const std::ptrdiff_t shift =
        o.display ? -std::ptrdiff_t(size) * left : std::ptrdiff_t(size) * left + std::ptrdiff_t(row) * above;
    if (c.name() != std::string(o.without))
      cut.insert(c.name(), Imf::Slice(c.channel().type, origin + shift, size, row));
  }
  in.setFrameBuffer(all);
  in.readPixels(data.min.y, data.max.y);
  header.dataWindow() = {{box.x0 + o.move_x, box.y0}, {box.x1 + o.move_x, box.y1}};
  if (!o.display) {
    header.dataWindow() = {{0, 0}, {box.x1 - box.x0, box.y1 - box.y0}};
    header.displayWindow() = header.dataWindow();
  }
  if (!o.jitter) header.erase("jitter");
  if (*o.without) {
    Imf::ChannelList fewer;
    for (Imf::ChannelList::ConstIterator c = header.channels().begin(); c != header.channels().end(); ++c)
      if (c.name() != std::string(o.without)) fewer.insert(c.name(), c.channel());
    header.channels() = fewer;
  }
  for (const char* name : {"name", "type", "version", "chunkCount", "view"})
    if (header.findTypedAttribute<Imf::StringAttribute>(name) || std::string(name) != "view") header.erase(name);
  fs::create_directories(to.parent_path());
  Imf::OutputFile out(to.c_str(), header, 0);
  out.setFrameBuffer(cut);
  out.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
}

std::vector<float> color_of(const fs::path& path, const std::string& channel) {
  Imf::MultiPartInputFile file(path.c_str(), 0);
  Imf::InputPart in(file, 0);
  std::vector<float> values(64 * 36);
  Imf::FrameBuffer pixels;
  pixels.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * 64));
  in.setFrameBuffer(pixels);
  in.readPixels(0, 35);
  return values;
}

class ExtraCli : public SceneCli {
 protected:
  static constexpr Box kWhole{0, 0, 63, 35};
  static constexpr const char* kMain = "main/f.####.exr";

  fs::path source(int frame) const { return folder / ("in/crossing." + number(frame) + ".exr"); }
  fs::path extra(const std::string& name, int frame) const {
    return folder / ("ex/" + name + "." + number(frame) + ".exr");
  }

  /// Frames of three samples; the first of them alone as the frames.
  void make(int frames) const {
    synth("crossing", "1-" + std::to_string(frames), {"--samples", "3"});
    for (int f = 1; f <= frames; ++f) write_crop(source(f), 0, folder / ("main/f." + number(f) + ".exr"), kWhole);
  }
  Outcome resolve(const std::string& to, const Arguments& more) const { return resolve_into(kMain, to, more, {}); }
  void expect_same(const std::string& a, const std::string& b, int frame) const {
    for (const char* channel : {"R", "G", "B", "A"})
      EXPECT_EQ(color_of(path(a, frame), channel), color_of(path(b, frame), channel)) << a << " " << b << frame;
  }
};

TEST_F(ExtraCli, WholeFramesAreSamplesLikeThoseOfOneFile) {
  make(5);
  for (int f = 1; f <= 5; ++f)
    for (int k : {1, 2}) write_crop(source(f), k, extra("e" + std::to_string(k), f), kWhole);
  const Arguments gather = {"--accumulator", "gather", "--reach", "2"};
  Arguments each = gather, extras = gather;
  each.insert(each.end(), {"--samples", "each"});
  extras.insert(extras.end(), {"--extra", "ex/e*.####.exr"});
  ASSERT_EQ(resolve_into("in/crossing.####.exr", "each", each, {}).code, 0);
  const Outcome done = resolve("extra", extras);
  ASSERT_EQ(done.code, 0) << done.err;
  for (int f = 1; f <= 5; ++f) expect_same("each", "extra", f);
  // The files are on record.
  ASSERT_EQ(resolve("none", gather).code, 0);
  EXPECT_NE(bytes_of(path("extra", 3)).find("10 files of frames 1-5"), std::string::npos);
  EXPECT_EQ(bytes_of(path("none", 3)).find("varve:extra"), std::string::npos);
  // Two files are not enough to make a difference only in name.
  EXPECT_NE(color_of(path("none", 3), "R"), color_of(path("extra", 3), "R"));
}

TEST_F(ExtraCli, EveryAccumulatorGainsByThem) {
  make(3);
  synth("crossing", "1-3", {"--samples", "3", "--truth", "box", "--truth-samples", "36"});
  for (int f = 1; f <= 3; ++f)
    for (int k : {1, 2}) write_crop(source(f), k, extra("e" + std::to_string(k), f), kWhole);
  for (const char* accumulator : {"recursive", "two-sided", "gather"})
    for (const char* filter : {"gaussian", "none"}) {
      if (*filter == 'n' && *accumulator != 'r') continue;
      ASSERT_EQ(resolve("base", {"--accumulator", accumulator, "--sample-filter", filter}).code, 0);
      const Outcome done =
          resolve("extra", {"--accumulator", accumulator, "--sample-filter", filter, "--extra", "ex/e*.####.exr"});
      ASSERT_EQ(done.code, 0) << done.err;
      EXPECT_GT(psnr("crossing", "extra", "2-3"), psnr("crossing", "base", "2-3") + 0.5) << accumulator << filter;
    }
}

TEST_F(ExtraCli, SamplesOfTheFramesAndFurtherOnesAreGatheredTogether) {
  synth("crossing", "1-3", {"--samples", "3", "--truth", "box", "--truth-samples", "36"});
  for (int f = 1; f <= 3; ++f) write_crop(source(f), 1, extra("again", f), kWhole);
  const Arguments by = {"--samples", "each", "--accumulator", "gather", "--reach", "1"};
  Arguments with = by;
  with.insert(with.end(), {"--extra", "ex/again.####.exr"});
  ASSERT_EQ(resolve_into("in/crossing.####.exr", "each", by, {}).code, 0);
  const Outcome done = resolve_into("in/crossing.####.exr", "more", with, {});
  ASSERT_EQ(done.code, 0) << done.err;
  // One sample counts twice: another picture, and not a much worse one.
  EXPECT_NE(color_of(path("each", 2), "R"), color_of(path("more", 2), "R"));
  EXPECT_GT(psnr("crossing", "more", "2-3"), psnr("crossing", "each", "2-3") - 1);
  Arguments first = with;
  first[1] = "resolve";
  EXPECT_EQ(resolve_into("in/crossing.####.exr", "no", first, {}).code, 2);
}

TEST_F(ExtraCli, ACropChangesNothingBeyondItsReach) {
  make(3);
  write_crop(source(3), 1, extra("crop", 3), {4, 6, 11, 13});
  for (const char* accumulator : {"recursive", "two-sided", "gather"})
    for (const char* filter : {"none", "gaussian"}) {
      const Arguments by = {"--accumulator", accumulator, "--sample-filter", filter, "--aov", "count"};
      Arguments with = by;
      with.insert(with.end(), {"--extra", "ex/crop.####.exr"});
      ASSERT_EQ(resolve("base", by).code, 0);
      const Outcome done = resolve("crop", with);
      ASSERT_EQ(done.code, 0) << done.err;
      const bool gathers = std::string(accumulator) == "gather";
      for (const char* channel : {"R", "B", "A", "varve.count"}) {
        const std::vector<float> a = color_of(path("base", 3), channel), b = color_of(path("crop", 3), channel);
        // Light and surfaces of the gather are looked at in larger windows.
        const int reach = gathers ? 34 : 8;
        int changed = 0;
        for (int y = 0; y < 36; ++y)
          for (int x = 0; x < 64; ++x) {
            const std::size_t i = std::size_t(y * 64 + x);
            changed += a[i] != b[i];
            const bool near = x >= 4 - reach && x <= 11 + reach && y >= 6 - reach && y <= 13 + reach;
            if (!near) {
              EXPECT_EQ(a[i], b[i]) << accumulator << filter << channel << x << "," << y;
            }
          }
        if (*channel == 'R') {
          EXPECT_GT(changed, 10) << accumulator << filter;
        }
      }
      // Frames before it, where nothing looks ahead, are those without.
      if (std::string(accumulator) == "recursive") expect_same("base", "crop", 2);
    }
}

TEST_F(ExtraCli, HalvesAreTheWholeInAnyOrder) {
  make(3);
  for (int f = 1; f <= 3; ++f) {
    write_crop(source(f), 1, extra("whole", f), kWhole);
    write_crop(source(f), 1, extra("half.0", f), {0, 0, 30, 35});
    // Cut off from its window: the list says where it was.
    write_crop(source(f), 1, extra("half.1", f), {31, 0, 63, 35}, {.display = false});
  }
  std::ofstream list(folder / "list.json");
  list << "{\"renders\": [{\"window\": [31, 0, 64, 36], \"files\": [\"half.1.0001.exr\", \"half.1.0002.exr\", "
          "\"half.1.0003.exr\"]}]}";
  list.close();
  for (const char* accumulator : {"recursive", "gather"}) {
    const Arguments by = {"--accumulator", accumulator, "--sample-filter", "gaussian"};
    const auto run = [&](const std::string& to, Arguments more) {
      more.insert(more.end(), by.begin(), by.end());
      const Outcome done = resolve(to, more);
      ASSERT_EQ(done.code, 0) << done.err;
    };
    run("whole", {"--extra", "ex/whole.####.exr"});
    run("halves", {"--extra", "ex/half.0.####.exr", "--extra", "ex/half.1.####.exr", "--extra-list", "list.json"});
    run("turned",
        {"--extra", "ex/half.1.####.exr", "--extra", "ex/h*.####.exr", "--extra-list", "list.json", "-j", "3"});
    for (int f = 1; f <= 3; ++f) {
      expect_same("whole", "halves", f);
      EXPECT_TRUE(bytes_of(path("halves", f)) == bytes_of(path("turned", f)));
    }
  }
}

TEST_F(ExtraCli, WindowsBeyondTheFrameAreSaidOrRefused) {
  make(2);
  write_crop(source(2), 1, extra("edge", 2), {48, 4, 63, 11}, {.move_x = 8});
  const Outcome edge = resolve("edge", {"--extra", "ex/edge.####.exr"});
  EXPECT_EQ(edge.code, 0) << edge.err;
  EXPECT_NE(edge.err.find("64 of 128 pixels of its window 56,4-71,11 lie outside"), std::string::npos) << edge.err;
  EXPECT_NE(edge.err.find("1 files for frames 2, none for 1 others"), std::string::npos) << edge.err;
  write_crop(source(2), 1, extra("out", 2), {48, 4, 63, 11}, {.move_x = 16});
  const Outcome out = resolve("out", {"--extra", "ex/out.####.exr"});
  EXPECT_EQ(out.code, 4);
  EXPECT_NE(out.err.find("lies outside of the frame's data window 0,0-63,35"), std::string::npos) << out.err;
  EXPECT_FALSE(fs::exists(path("out", 1)));
}

TEST_F(ExtraCli, WhatDoesNotFitIsRefused) {
  make(2);
  const auto refused = [&](const CropOptions& o, const std::string& says) {
    write_crop(source(2), 1, extra("odd", 2), {8, 8, 15, 15}, o);
    const Outcome done = resolve("odd", {"--extra", "ex/odd.####.exr"});
    EXPECT_EQ(done.code, 4);
    EXPECT_NE(done.err.find(says), std::string::npos) << done.err;
  };
  refused({.jitter = false}, "--extra-list");
  refused({.display = false}, "its display window has 8x8 pixels at 0,0-7,7, that of the frame 64x36");
  refused({.without = "Z"}, "has no depth");
  refused({.without = "A"}, "its channels differ in A");
  // Without jitter all round, none is missed.
  write_crop(source(2), 1, extra("odd", 2), {8, 8, 15, 15}, {.jitter = false});
  EXPECT_EQ(resolve("odd", {"--extra", "ex/odd.####.exr", "--jitter", "none"}).code, 0);
  const Outcome nothing = resolve("odd", {"--extra", "ex/other.####.exr"});
  EXPECT_EQ(nothing.code, 0);
  EXPECT_NE(nothing.err.find("no file of --extra is there"), std::string::npos) << nothing.err;
  std::ofstream(folder / "ex/odd.0002.exr", std::ios::binary) << "not an EXR file";
  EXPECT_EQ(resolve("odd", {"--extra", "ex/odd.####.exr"}).code, 3);
  EXPECT_EQ(resolve("odd", {"--extra", "ex/odd.####.exr", "--unjitter", "bilinear"}).code, 2);
  EXPECT_EQ(resolve("odd", {"--extra-list", "list.json"}).code, 2);
  std::ofstream(folder / "list.json") << "{\"renders\": 7}";
  EXPECT_EQ(resolve("odd", {"--extra", "ex/odd.####.exr", "--extra-list", "list.json"}).code, 3);
}

TEST_F(ExtraCli, ResumeSeesThatFilesWereAdded) {
  make(2);
  const Arguments line = {"--extra", "ex/e*.####.exr", "--resume"};
  write_crop(source(1), 1, extra("e1", 1), kWhole);
  ASSERT_EQ(resolve("out", line).code, 0);
  const std::string before = bytes_of(path("out", 1));
  write_crop(source(1), 2, extra("e2", 1), kWhole);
  ASSERT_EQ(resolve("out", line).code, 0);
  EXPECT_FALSE(before == bytes_of(path("out", 1)));
}

}  // namespace
}  // namespace varve::test
