// varve resolve --scale 2: windows, what is resolved, what is repeated, what the picture gains, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "exr/new_file.h"
#include "exr/read_frame.h"
#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"
#include "subpixel/subpixel_history.h"

namespace varve::test {
namespace {

/// A file whole, as stored.
struct Stored {
  FileHeader header;
  FramePixels pixels;
  const RawPlane& operator()(std::size_t part, const std::string& channel) const {
    return pixels.planes[part][std::size_t(header.parts[part].channel(channel).value())];
  }
};

Stored read_whole(const std::filesystem::path& path) {
  Stored file{read_header(path.string()), {}};
  std::vector<ChannelRef> all;
  for (int p = 0; p < int(file.header.parts.size()); ++p)
    for (int c = 0; c < int(file.header.parts[std::size_t(p)].channels.size()); ++c) all.push_back({0, p, c});
  Workers workers(1);
  file.pixels = read_channels(file.header, all, workers);
  return file;
}

Window twice(const Window& w) { return {2 * w.x0, 2 * w.y0, 2 * w.x1, 2 * w.y1}; }

void expect_repeated(const RawPlane& small, const RawPlane& large, const std::string& name) {
  ASSERT_EQ(large.type, small.type) << name;
  ASSERT_TRUE(large.window == twice(small.window)) << name;
  const std::size_t bytes = bytes_per_pixel(small.type);
  int wrong = 0;
  for (int y = 0; y < large.rows; ++y)
    for (int x = 0; x < large.columns; ++x)
      wrong +=
          std::memcmp(large.row(y) + std::size_t(x) * bytes, small.row(y / 2) + std::size_t(x / 2) * bytes, bytes) != 0;
  EXPECT_EQ(wrong, 0) << name;
}

float value_of(const RawPlane& plane, int column, int row) {
  float v = 0;
  std::memcpy(&v, plane.row(row) + std::size_t(column) * sizeof v, sizeof v);
  return v;
}

/// The mean of each 2x2 of `large` is the pixel of `small`; returns how many of the 2x2 differ among themselves.
int expect_mean(const RawPlane& small, const RawPlane& large, const std::string& name) {
  EXPECT_TRUE(large.window == twice(small.window)) << name;
  if (!(large.window == twice(small.window))) return 0;
  double worst = 0;
  int differ = 0;
  for (int y = 0; y < small.rows; ++y)
    for (int x = 0; x < small.columns; ++x) {
      double sum = 0, size = 0;
      for (int k = 0; k < 4; ++k) {
        const double v = double(value_of(large, 2 * x + k % 2, 2 * y + k / 2));
        sum += v / 4;
        size += std::abs(v) / 4;
      }
      differ += value_of(large, 2 * x, 2 * y) != value_of(large, 2 * x + 1, 2 * y + 1);
      if (size > 0) worst = std::max(worst, std::abs(sum - double(value_of(small, x, y))) / size);
    }
  EXPECT_LE(worst, 1e-6) << name;
  return differ;
}

/// Upscaled by two with a separable kernel of the four nearest pixels, whose weights are for the left or upper one of
/// the two new pixels; edges repeated.
ChannelValues upscaled(const ChannelValues& from, const std::array<double, 4>& weights) {
  ChannelValues to{2 * from.x0, 2 * from.y0, 2 * from.width, 2 * from.height, {}};
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      double sum = 0;
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          const int dx = x % 2 == 0 ? i - 2 : 2 - i, dy = y % 2 == 0 ? j - 2 : 2 - j;
          sum += weights[std::size_t(i)] * weights[std::size_t(j)] *
                 double(from.at(from.x0 + std::clamp(x / 2 + dx, 0, from.width - 1),
                                from.y0 + std::clamp(y / 2 + dy, 0, from.height - 1)));
        }
      to.values.push_back(float(sum));
    }
  return to;
}

double squared_error(const ChannelValues& a, const ChannelValues& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) sum += std::pow(double(a.values[i]) - double(b.values[i]), 2);
  return sum;
}

std::uint32_t scramble(std::uint32_t v) {
  v = (v ^ 61u ^ (v >> 16)) * 9u;
  v = (v ^ (v >> 4)) * 0x27d4eb2du;
  return v ^ (v >> 15);
}

template <class Value>
RawPlane make_plane(PixelType type, const Window& window, Value value) {
  RawPlane plane = make_raw_plane(type, window);
  for (int y = 0; y < plane.rows; ++y)
    for (int x = 0; x < plane.columns; ++x) {
      const auto v = value(x, y);
      std::memcpy(plane.row(y) + std::size_t(x) * sizeof v, &v, sizeof v);
    }
  return plane;
}

class ScaleCli : public SceneCli {
 protected:
  Outcome resolve(const std::string& to, const Arguments& more = {},
                  const std::string& input = "in/pan.####.exr") const {
    return resolve_into(input, to, {"--preset", "yang", "--check-motion", "off"}, more);
  }

  /// Two parts of odd windows that begin left of and above the picture, the second without color.
  void write_odd(int frame) const {
    const Window data{-3, -5, 28, 14}, beside{-1, -7, 12, 4}, display{0, 0, 24, 12};
    const auto noise = [&](int x, int y, int c) {
      return scramble(std::uint32_t(((frame * 64 + y) * 64 + x) * 8 + c));
    };
    std::vector<RawPlane> planes;
    for (int c = 0; c < 4; ++c)
      planes.push_back(make_plane(PixelType::float32, data,
                                  [&](int x, int y) { return c == 3 ? 1.0f : float(noise(x, y, c) % 1000) / 500; }));
    planes.push_back(make_plane(PixelType::float32, data, [](int, int) { return 7.0f; }));
    planes.push_back(make_plane(PixelType::float32, data, [](int x, int) { return x < 8 ? 1.25f : -0.5f; }));
    planes.push_back(make_plane(PixelType::float32, data, [](int, int) { return 0.75f; }));
    planes.push_back(make_plane(PixelType::uint32, data, [&](int x, int y) { return noise(x, y, 5); }));
    planes.push_back(make_plane(PixelType::uint32, beside, [&](int x, int y) { return noise(x, y, 6); }));
    planes.push_back(
        make_plane(PixelType::float16, beside, [&](int x, int y) { return std::uint16_t(noise(x, y, 7)); }));
    const char* const names[] = {"R", "G", "B", "A", "Z", "velocity.x", "velocity.y", "id", "rank00", "bits"};
    std::vector<NewPart> parts = {{"rgba", data, display, Compression::zip, {}, {}},
                                  {"other", beside, display, Compression::zip, {}, {}}};
    for (std::size_t c = 0; c < planes.size(); ++c)
      parts[c < 8 ? 0 : 1].channels.push_back({{names[c], planes[c].type, 1, 1, false}, &planes[c]});
    const glm::dvec2 jitter = kQuadrantMiddle[std::size_t(frame) % 4];
    parts[0].attributes = {string_attribute("varve:motion", "varve"), string_attribute("owner", "somebody"),
                           number_attribute("jitter", "v2f", {jitter.x, jitter.y})};
    Workers workers(1);
    write_new_file(folder / ("odd.000" + std::to_string(frame) + ".exr"), parts, 1, workers);
  }
};

TEST_F(ScaleCli, APixelIsTheMeanOfItsFourAndTheRestIsRepeated) {
  synth("pan", "1-6", {"--jitter", "quadrants:16", "--type", "float"});
  ASSERT_EQ(resolve("one", {"--aov", "count,motion,reject"}).code, 0);
  const Outcome two = resolve("two", {"--scale", "2", "--aov", "count,motion,reject"});
  ASSERT_EQ(two.code, 0) << two.err;
  for (const int frame : {1, 6}) {
    const Stored small = read_whole(path("one", frame)), large = read_whole(path("two", frame));
    ASSERT_TRUE((large.header.parts[0].data_window == Window{0, 0, 128, 72}));
    ASSERT_TRUE((large.header.parts[0].display_window == Window{0, 0, 128, 72}));
    EXPECT_EQ(large.header.parts[0].channels.size(), small.header.parts[0].channels.size());
    for (const char* const channel : {"R", "G", "B", "A"}) {
      const int differ = expect_mean(small(0, channel), large(0, channel), channel);
      if (frame == 6 && channel[0] != 'A') {
        EXPECT_GT(differ, 64 * 36 / 2) << channel;
      }
    }
    for (const char* const channel : {"id", "Z", "varve.count", "varve.reject"})
      expect_repeated(small(0, channel), large(0, channel), channel);
    for (const char* const channel : {"velocity.x", "velocity.y", "forward.x", "varve.motion.x"}) {
      const auto &before = small(0, channel), &after = large(0, channel);
      for (int y = 0; y < 72; y += 7)
        for (int x = 0; x < 128; x += 5)
          EXPECT_EQ(value_of(after, x, y), 2 * value_of(before, x / 2, y / 2)) << channel;
    }
  }
}

TEST_F(ScaleCli, OddWindowsNegativeOriginsAndPartsWithoutColor) {
  for (int frame = 1; frame <= 6; ++frame) write_odd(frame);
  const std::string input = "odd.####.exr";
  ASSERT_EQ(resolve("one", {}, input).code, 0);
  const Outcome two = resolve("two", {"--scale", "2", "--threads", "1"}, input);
  ASSERT_EQ(two.code, 0) << two.err;
  ASSERT_EQ(resolve("three", {"--scale", "2", "--threads", "3"}, input).code, 0);
  ASSERT_EQ(resolve("bare", {"--scale", "2", "--keep", "none"}, input).code, 0);
  ASSERT_EQ(resolve("apart", {"--scale", "2", "--aov", "count", "--diagnostics", "apart/d.####.exr"}, input).code, 0);
  EXPECT_TRUE((read_header(folder / "apart/d.0006.exr").parts[0].data_window == Window{-6, -10, 56, 28}));
  EXPECT_EQ(read_header(path("bare", 6).c_str()).parts.size(), 1u);
  for (int frame = 1; frame <= 6; ++frame)
    EXPECT_TRUE(bytes_of(path("two", frame)) == bytes_of(path("three", frame))) << frame;
  EXPECT_TRUE(is_complete(path("two", 6)));
  const Stored small = read_whole(path("one", 6)), large = read_whole(path("two", 6));
  ASSERT_EQ(large.header.parts.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_TRUE(large.header.parts[p].data_window == twice(small.header.parts[p].data_window)) << p;
    EXPECT_TRUE((large.header.parts[p].display_window == Window{0, 0, 48, 24})) << p;
    EXPECT_EQ(large.header.parts[p].name, small.header.parts[p].name);
  }
  for (const char* const channel : {"R", "G", "B"})
    EXPECT_GT(expect_mean(small(0, channel), large(0, channel), channel), 99);
  expect_repeated(small(0, "id"), large(0, "id"), "id");
  expect_repeated(small(1, "rank00"), large(1, "rank00"), "rank00");
  expect_repeated(small(1, "bits"), large(1, "bits"), "bits");  // NaN of every kind among them
  EXPECT_EQ(value_of(large(0, "velocity.x"), 0, 0), 2.5f);
  // What is said of the whole frame stays, and what is said of the one sample does not.
  ASSERT_TRUE(large.header.parts[0].attribute("owner"));
  EXPECT_FALSE(large.header.parts[0].attribute("jitter"));
}

TEST_F(ScaleCli, ShowsDetailThatNoUpscalingOfThePixelsHas) {
  synth("indoor-still", "1-16", {"--jitter", "quadrants:64", "--type", "float", "--size", "112x63"});
  ASSERT_EQ(run_varve({"synth", "indoor-still", "-o", "large", "--size", "224x126", "-f", "16", "--truth", "box",
                       "--truth-samples", "36", "-q"},
                      folder.path())
                .code,
            0);
  const std::string input = "in/indoor-still.####.exr";
  ASSERT_EQ(resolve("one", {}, input).code, 0);
  ASSERT_EQ(resolve("two", {"--scale", "2"}, input).code, 0);
  double nearest = 0, linear = 0, cubic = 0, four = 0;
  for (const char* const c : {"R", "G", "B"}) {
    const ChannelValues truth = channel_of(folder / "large/truth/indoor-still.0016.exr", c);
    const ChannelValues pixels = channel_of(path("one", 16), c);
    nearest += squared_error(upscaled(pixels, {0, 0, 1, 0}), truth);
    linear += squared_error(upscaled(pixels, {0, 0.25, 0.75, 0}), truth);
    // Catmull-Rom, a quarter of a pixel from the center.
    cubic += squared_error(upscaled(pixels, {-0.0234375, 0.2265625, 0.8671875, -0.0703125}), truth);
    four += squared_error(channel_of(path("two", 16), c), truth);
  }
  const auto gain = [&](double other) { return 10 * std::log10(other / four); };
  RecordProperty(
      "gain", std::to_string(gain(nearest)) + " " + std::to_string(gain(linear)) + " " + std::to_string(gain(cubic)));
  EXPECT_GT(gain(nearest), 1.0);
  EXPECT_GT(gain(linear), 1.0);
  EXPECT_GT(gain(cubic), 1.0);
}

TEST_F(ScaleCli, SamplesOfAPixelMakeItToo) {
  synth("pan", "1-4", {"--samples", "4", "--type", "float"});
  for (const std::string mode : {"each", "resolve"}) {
    ASSERT_EQ(resolve("one", {"--samples", mode}).code, 0);
    const Outcome two = resolve("two", {"--samples", mode, "--scale", "2"});
    ASSERT_EQ(two.code, 0) << two.err;
    expect_mean(read_whole(path("one", 4))(0, "G"), read_whole(path("two", 4))(0, "G"), mode);
  }
}

TEST_F(ScaleCli, ChannelsOfTheColorGoWithIt) {
  synth("panes", "1-5", {"--layers", "--jitter", "quadrants:16", "--type", "float"});
  const std::string input = "in/panes.####.exr";
  ASSERT_EQ(resolve("one", {"--channels", "fg.?"}, input).code, 0);
  const Outcome two = resolve("two", {"--channels", "fg.?", "--scale", "2"}, input);
  ASSERT_EQ(two.code, 0) << two.err;
  const Stored small = read_whole(path("one", 5)), large = read_whole(path("two", 5));
  EXPECT_GT(expect_mean(small(0, "fg.G"), large(0, "fg.G"), "fg.G") + expect_mean(small(0, "G"), large(0, "G"), "G"),
            99);
}

TEST_F(ScaleCli, RefusesWhatItCannotDo) {
  synth("panes", "1-2", {"--layers"});
  const std::string input = "in/panes.####.exr";
  const std::vector<Arguments> lines = {{"--accumulator", "recursive"},
                                        {"--sharpen", "0.5"},
                                        {"--blur-young", "3"},
                                        {"--layer", "fg,mid,bg", "--layers", "each"},
                                        {"--samples", "grid:2"}};
  for (Arguments line : lines) {
    line.insert(line.end(), {"--scale", "2"});
    const Outcome refused = resolve("no", line, input);
    expect_refused(refused, 2, "--scale 2");
  }
  EXPECT_EQ(resolve("no", {"--scale", "3"}, input).code, 2);
  EXPECT_EQ(resolve("yes", {"--scale", "2", "--layer", "fg,mid,bg", "--layers", "composite"}, input).code, 0);
}

}  // namespace
}  // namespace varve::test
