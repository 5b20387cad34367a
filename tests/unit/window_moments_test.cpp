// Windows of any width: sliding by merges against sums, beside highlights, for every width.
#include "resolve/window_moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/plane.h"
#include "resolve/moments_pyramid.h"
#include "resolve/sliding_window.h"

namespace varve {
namespace {

/// A frame for the windows, as the accumulator shows it to them.
struct Frame {
  int width, height;
  std::vector<float> color, weight;

  Frame(int w, int h, const std::function<float(int, int)>& value)
      : width(w), height(h), color(std::size_t(4 * w * h)), weight(std::size_t(w * h), 1.0f) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        for (int k = 0; k < 4; ++k) color[std::size_t(4 * (y * w + x) + k)] = k == 3 ? 1.0f : value(x, y);
  }
  AccumulateView view() const {
    AccumulateView v{};
    v.width = width;
    v.height = height;
    v.neighbors = {color.data(), 4 * width};
    v.weight = {weight.data(), width};
    return v;
  }
  bool counts(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height && weight[std::size_t(y * width + x)] > 0;
  }
  long double at(int x, int y) const { return color[std::size_t(4 * (y * width + x))]; }
};

struct Exact {
  long double n = 0, mean = 0, m2 = 0, low = INFINITY, high = -INFINITY;
};

Exact exact(const Frame& f, int x, int y, int r) {
  Exact e;
  for (int j = y - r; j <= y + r; ++j)
    for (int i = x - r; i <= x + r; ++i)
      if (f.counts(i, j)) {
        e.n += 1, e.mean += f.at(i, j);
        e.low = std::min(e.low, f.at(i, j)), e.high = std::max(e.high, f.at(i, j));
      }
  if (e.n > 0) e.mean /= e.n;
  for (int j = y - r; j <= y + r; ++j)
    for (int i = x - r; i <= x + r; ++i)
      if (f.counts(i, j)) e.m2 += (f.at(i, j) - e.mean) * (f.at(i, j) - e.mean);
  return e;
}

/// Largest relative difference of the second moment; its sign is checked, too.
double worst_difference(const Frame& f, int window, Workers& workers) {
  WindowBand<Moments> band;
  gather_band(f.view(), window, slid_widths(window, WindowMoments::separable), 0, f.height, band, workers);
  double worst = 0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const Exact e = exact(f, x, y, window / 2);
      const Moments& m = band.at(x, y);
      EXPECT_EQ(m.n, double(e.n));
      EXPECT_GE(m.m2[0], 0);
      const long double deviation = e.n > 0 ? std::sqrt(e.m2 / e.n) : 0;
      EXPECT_NEAR(m.mean[0], double(e.mean), 1e-14 * double(std::abs(e.mean) + deviation) + 1e-300);
      if (e.m2 > 0)
        worst = std::max(worst, std::abs(double((m.m2[0] - e.m2) / e.m2)));
      else
        EXPECT_EQ(m.m2[0], 0);
    }
  return worst;
}

Moments sample(const MomentsPyramid& pyramid, const Frame& frame, int x, int y) {
  PyramidRow row;
  mix_pyramid_row(pyramid, frame.view(), y, row);
  return sample_pyramid(pyramid, row, x);
}

TEST(WindowMoments, CorrectBesideHighlights) {
  Workers workers(2);
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  // A 65504 stripe left of noise of 1e-3; a 65504 corner before 1e-8; small noise on a large value; 1e30 above 1.
  EXPECT_LT(worst_difference(Frame(40, 40, [&](int x, int) { return x < 8 ? 65504.0f : 1e-3f * normal(random); }), 15,
                             workers),
            1e-12);
  EXPECT_LT(
      worst_difference(Frame(40, 40, [&](int x, int y) { return x < 8 && y < 8 ? 65504.0f : 1e-8f * normal(random); }),
                       15, workers),
      1e-12);
  EXPECT_LT(worst_difference(Frame(40, 40, [&](int, int) { return 1e4f + 1e-2f * normal(random); }), 15, workers),
            1e-8);
  EXPECT_LT(
      worst_difference(Frame(40, 40, [&](int, int y) { return y < 8 ? 1e30f : 1 + normal(random); }), 15, workers),
      1e-12);
}

TEST(WindowMoments, EveryWidthOnOddFramesWithHoles) {
  Workers workers(2);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int window = 3; window <= 63; window += window < 15 ? 2 : 8) {
    Frame f(37, 23, [&](int, int) { return unit(random); });
    for (float& w : f.weight) w = unit(random) > -0.9f ? 1.0f : 0.0f;
    for (int y = 3; y < 20; ++y)
      for (int x = 5; x < 30; ++x)
        f.weight[std::size_t(y * 37 + x)] = window == 9 ? 0.0f : f.weight[std::size_t(y * 37 + x)];
    EXPECT_LT(worst_difference(f, window, workers), 1e-12) << window;
    WindowBand<Extremes> band;
    gather_band(f.view(), window, {window, 1, 1}, 5, 17, band, workers);  // a band that is not the frame
    for (int y = 5; y < 17; ++y)
      for (int x = 0; x < 37; ++x) {
        const Exact e = exact(f, x, y, window / 2);
        ASSERT_EQ(band.at(x, y).low[0], float(e.low)) << window << " " << x << "," << y;
        ASSERT_EQ(band.at(x, y).high[0], float(e.high));
      }
  }
}

TEST(WindowMoments, FlatIsFlatExactly) {
  Workers workers(1);
  for (const float value : {0.1f, 1e-30f, 65504.0f, 3e38f, 1e-45f, -7.7f, 0.0f}) {
    const Frame f(70, 41, [&](int, int) { return value; });
    for (const WindowMoments kind : {WindowMoments::separable, WindowMoments::gaussian}) {
      WindowBand<Moments> band;
      gather_band(f.view(), 31, slid_widths(31, kind), 0, f.height, band, workers);
      for (const Moments& m : {band.at(0, 0), band.at(35, 20), band.at(69, 40)}) {
        EXPECT_EQ(m.mean[0], double(value));
        EXPECT_EQ(m.m2[0], 0);
      }
    }
    const MomentsPyramid p = make_pyramid(f.view(), 31, workers);
    EXPECT_EQ(sample(p, f, 33, 17).mean[0], double(value));
    EXPECT_EQ(sample(p, f, 33, 17).m2[0], 0);
  }
}

TEST(WindowMoments, BandsDoNotShow) {
  Workers workers(3);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  const Frame f(21, 90, [&](int, int) { return unit(random); });
  WindowBand<Moments> whole, part;
  gather_band(f.view(), 7, slid_widths(7, WindowMoments::separable), 0, 90, whole, workers);
  gather_band(f.view(), 7, slid_widths(7, WindowMoments::separable), 32, 64, part, workers);
  // Blocks start with the band: the same sums in another order.
  for (int y = 32; y < 64; ++y)
    for (int x = 0; x < 21; ++x) EXPECT_NEAR(whole.at(x, y).m2[0], part.at(x, y).m2[0], 1e-13);
}

/// Centroid and variance of the weights that a kind of window gives, by an impulse at every place.
TEST(WindowMoments, WindowsAreCentredAndAsWideAsTheySay) {
  Workers workers(2);
  for (const int window : {3, 5, 7, 9, 31, 63})
    for (const WindowMoments kind : {WindowMoments::separable, WindowMoments::gaussian, WindowMoments::pyramid}) {
      double sum = 0, first = 0, second = 0;
      const int size = kind == WindowMoments::pyramid ? 256 : 131, centre = size / 2;
      for (int i = 0; i < size; ++i) {
        Frame f(size, 1, [](int, int) { return 0.0f; });
        f.color[std::size_t(4 * i)] = 1;
        double weight;
        if (kind == WindowMoments::pyramid) {
          const MomentsPyramid p = make_pyramid(f.view(), window, workers);
          weight = sample(p, f, centre, 0).mean[0];
        } else {
          WindowBand<Moments> band;
          gather_band(f.view(), window, slid_widths(window, kind), 0, 1, band, workers);
          weight = band.at(centre, 0).mean[0];
        }
        sum += weight, first += weight * (i - centre), second += weight * (i - centre) * (i - centre);
      }
      EXPECT_NEAR(sum, 1, 1e-9);
      const double box = (double(window) * window - 1) / 12;
      if (kind == WindowMoments::pyramid) {  // depends on the place in the square
        EXPECT_LE(std::abs(first), std::sqrt(box)) << window;
        EXPECT_GT(second, 0.3 * box) << window;
        EXPECT_LT(second, 2.0 * box) << window;
      } else {
        EXPECT_NEAR(first, 0, 1e-9) << window;
        const auto w = slid_widths(window, kind);
        double expected = 0;
        for (const int width : w) expected += (double(width) * width - 1) / 12;
        EXPECT_NEAR(second, expected, 1e-6 * expected) << window;
        EXPECT_EQ(w[0] + w[1] + w[2], window + 2);
      }
    }
}

}  // namespace
}  // namespace varve
