// From stored channels to planes: ids by their bits, normals of length 1, masks with a neutral value.
#include "stages/read_present.h"

#include <gtest/gtest.h>

#include <Imath/half.h>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace varve {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <class T>
RawPlane raw_of(PixelType type, const Window& window, const std::vector<T>& values) {
  RawPlane plane = make_raw_plane(type, window);
  for (int y = 0; y < plane.rows; ++y)
    std::memcpy(plane.row(y), values.data() + std::size_t(y) * std::size_t(plane.columns),
                sizeof(T) * std::size_t(plane.columns));
  return plane;
}

/// A subject whose channel k lies at place k: 0 green, 1 id, 2 to 4 normal, 5 reactive, 6 responsive.
struct Frame {
  Subject subject;
  FileSet files{1};

  explicit Frame(const Window& w) {
    subject.color[1] = ChannelRef{0, 0, 0};
    subject.id = ChannelRef{0, 0, 1};
    subject.normal = NormalChannels{ChannelRef{0, 0, 2}, ChannelRef{0, 0, 3}, ChannelRef{0, 0, 4}};
    subject.reactive = ChannelRef{0, 0, 5};
    subject.responsive = ChannelRef{0, 0, 6};
    files[0].planes.resize(1);
    for (int k = 0; k < 7; ++k)
      files[0].planes[0].push_back(raw_of(PixelType::float32, w, std::vector<float>(w.pixels(), 0.0f)));
  }
  RawPlane& plane(std::size_t k) { return files[0].planes[0][k]; }
  Present read(const Window& w, bool wanted = true) {
    Workers workers(2);
    std::size_t bad = 0;
    const ReadOptions options{
        .motion = {}, .use_id = wanted, .use_normal = wanted, .use_reactive = wanted, .use_responsive = wanted};
    return read_present(subject, files, w, w, options, nullptr, bad, workers);
  }
};

TEST(ReadPresent, IdsAreBits) {
  const Window w{-1, 2, 3, 3};
  Frame frame(w);
  frame.plane(1) = raw_of(PixelType::uint32, w, std::vector<std::uint32_t>{0, 1, 16777217, 4294967295u});
  Present p = frame.read(w);
  EXPECT_EQ(p.id.at(-1, 2), 0u);
  EXPECT_EQ(p.id.at(1, 2), 16777217u);  // beyond what a float tells apart
  EXPECT_EQ(p.id.at(2, 2), 4294967295u);
  // Hashes of a Cryptomatte: neighboring bit patterns, denormals included, are different objects.
  const float denormal = std::bit_cast<float>(3u);
  frame.plane(1) = raw_of(PixelType::float32, w, std::vector<float>{-0.0f, 0.0f, denormal, kNaN});
  p = frame.read(w);
  EXPECT_EQ(p.id.at(-1, 2), p.id.at(0, 2));
  EXPECT_EQ(p.id.at(1, 2), 3u);
  EXPECT_EQ(p.id.at(2, 2), std::bit_cast<std::uint32_t>(kNaN));
  frame.plane(1) = raw_of(PixelType::float16, w, std::vector<half>{half(0.0f), half(7.0f), half(-7.0f), half(7.0f)});
  p = frame.read(w);
  EXPECT_EQ(p.id.at(0, 2), p.id.at(2, 2));
  EXPECT_NE(p.id.at(0, 2), p.id.at(1, 2));
}

TEST(ReadPresent, AnotherWindowLeavesNoIdAndNeutralMasks) {
  const Window w{0, 0, 4, 3}, marks{2, 1, 6, 9};
  Frame frame(w);
  frame.plane(1) = raw_of(PixelType::uint32, marks, std::vector<std::uint32_t>(marks.pixels(), 5));
  for (const std::size_t k : {5u, 6u})
    frame.plane(k) = raw_of(PixelType::float32, marks, std::vector<float>(marks.pixels(), 0.5f));
  const Present p = frame.read(w);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) {
      const bool there = x >= 2 && y >= 1;
      EXPECT_EQ(p.id.at(x, y), there ? 5u : 0u);
      EXPECT_EQ(p.reactive.at(x, y), there ? 0.5f : 0.0f);
      EXPECT_EQ(p.responsive.at(x, y), there ? 0.5f : 1.0f);
    }
}

TEST(ReadPresent, NormalsHaveLengthOneAndMasksTheirRange) {
  const Window w{0, 0, 5, 1};
  Frame frame(w);
  const std::vector<float> axis = {3e-20f, 2.0f, 0.0f, kNaN, 3e38f};
  for (const std::size_t k : {2u, 3u, 4u}) frame.plane(k) = raw_of(PixelType::float32, w, axis);
  frame.plane(5) = raw_of(PixelType::float32, w, std::vector<float>{-1, 0.25f, 7, kNaN, HUGE_VALF});
  frame.plane(6) = raw_of(PixelType::float32, w, std::vector<float>{-1, 0.25f, 7, kNaN, HUGE_VALF});
  const Present p = frame.read(w);
  for (const int x : {0, 1}) EXPECT_NEAR(double(p.normal.at(x, 0).y), std::sqrt(1.0 / 3), 1e-7);
  for (const int x : {2, 3, 4}) EXPECT_EQ(p.normal.at(x, 0), glm::vec3(0.0f));
  const float reactive[] = {0, 0.25f, 1, 0, 0}, responsive[] = {0, 0.25f, 7, 1, 1};
  for (int x = 0; x < 5; ++x) {
    EXPECT_EQ(p.reactive.at(x, 0), reactive[x]);
    EXPECT_EQ(p.responsive.at(x, 0), responsive[x]);
  }
  EXPECT_TRUE(frame.read(w, false).id.empty());  // only what is needed
  EXPECT_TRUE(frame.read(w, false).normal.empty());
}

}  // namespace
}  // namespace varve
