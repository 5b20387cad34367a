// Filters that read history between its pixels: their twins, and the laws that recursion needs.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <numbers>
#include <random>

#include "plan/expansive.h"
#include "reference/history_filter_reference.h"
#include "resolve/bspline.h"
#include "resolve/resampling_kernel.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::next_history;
using test::noise_present;
using test::same_bits;

constexpr Window kOdd{-3, 5, 34, 28};

RecursiveParameters reading(HistoryFilter filter, bool dering = true, double b = 0, double c = 0.5) {
  RecursiveParameters p;
  p.history_filter = filter;
  p.dering = dering;
  p.cubic_b = b;
  p.cubic_c = c;
  return p;
}

const RectifyParameters& no_box() {
  static const RectifyParameters none = [] {
    RectifyParameters p;
    p.box = Box::none;
    return p;
  }();
  return none;
}

std::vector<RecursiveParameters> wide_filters() {
  std::vector<RecursiveParameters> all;
  for (const bool dering : {true, false}) {
    for (const double c : {0.0, 0.3, 0.5}) all.push_back(reading(HistoryFilter::cubic, dering, 0, c));
    all.push_back(reading(HistoryFilter::cubic, dering, 1.0 / 3, 1.0 / 3));
    all.push_back(reading(HistoryFilter::cubic, dering, 1, 0));
    all.push_back(reading(HistoryFilter::bspline3, dering));
    all.push_back(reading(HistoryFilter::bspline5, dering));
  }
  return all;
}

/// A history of noise with edges and highlights, all of it valid.
History noise_history(const Window& w, unsigned seed, Workers& workers, float scale = 1) {
  test::NoiseOptions noise;
  noise.seed = seed;
  noise.scale = scale;
  return next_history(noise_present(w, noise, workers), {}, {}, no_box(), workers);
}

/// What is read at `motion` from every pixel.
History read_at(const History& history, const Plane<glm::vec2>& motion, const RecursiveParameters& p,
                Workers& workers) {
  const Window& w = history.color.window();
  Present present = flat_present(w, glm::vec4(0.25f), workers);
  present.motion = motion.clone();
  return predict(present, history, p, no_box(), workers);
}

Plane<glm::vec2> vectors(const Window& w, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> pixels(-3, 3);
  Plane<glm::vec2> motion(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) motion.at(x, y) = {pixels(random), pixels(random)};
  return motion;
}

/// Rounding is that of floats of the size of the colors around; a spline looks far.
double size_around(const Plane<glm::vec4>& color, int x, int y) {
  double size = 1;
  for (int j = y - 9; j <= y + 9; ++j)
    for (int i = x - 9; i <= x + 9; ++i)
      if (color.window().contains(i, j))
        for (int k = 0; k < 4; ++k) size = std::max(size, std::abs(double(color.at(i, j)[k])));
  return size;
}

TEST(HistoryFilters, AgreeWithTheirTwins) {
  Workers workers(2);
  const History h = noise_history(kOdd, 3, workers);
  const Plane<glm::vec2> motion = vectors(kOdd, 4);
  const Plane<glm::dvec4> solved[] = {reference::solve_bspline(h.color, 3), reference::solve_bspline(h.color, 5)};
  for (const RecursiveParameters& p : wide_filters()) {
    const History fast = read_at(h, motion, p, workers);
    const int reach = p.history_filter == HistoryFilter::bspline5 ? 2 : 1;
    int compared = 0;
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) {
        const double px = x + double(motion.at(x, y).x), py = y + double(motion.at(x, y).y);
        const int bx = int(std::floor(px)), by = int(std::floor(py));
        if (bx - reach < kOdd.x0 || by - reach < kOdd.y0 || bx + reach + 1 >= kOdd.x1 || by + reach + 1 >= kOdd.y1)
          continue;
        const double size = size_around(h.color, bx, by);
        for (int k = 0; k < 4; ++k) {
          const bool cubic = p.history_filter == HistoryFilter::cubic;
          const int degree = p.history_filter == HistoryFilter::bspline3 ? 3 : 5;
          const double slow = cubic ? reference::cubic_at(h.color, p.cubic_b, p.cubic_c, px, py, k, p.dering)
                                    : reference::bspline_at(solved[degree == 5], h.color, degree, px, py, k, p.dering);
          ASSERT_NEAR(double(fast.color.at(x, y)[k]), slow, 3e-6 * size)
              << x << "," << y << " channel " << k << " B " << p.cubic_b << " C " << p.cubic_c;
        }
        ++compared;
      }
    EXPECT_GT(compared, 400);
  }
}

TEST(HistoryFilters, CubicWithCatmullRomsConstantsIsCatmullRom) {
  Workers workers(1);
  const History h = noise_history(kOdd, 8, workers);
  const Plane<glm::vec2> motion = vectors(kOdd, 9);
  for (const bool dering : {true, false}) {
    const History a = read_at(h, motion, reading(HistoryFilter::cubic, dering), workers);
    const History b = read_at(h, motion, reading(HistoryFilter::catmull_rom, dering), workers);
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x)
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(double(a.color.at(x, y)[k]), double(b.color.at(x, y)[k]), 3e-6 * 200) << x << "," << y;
  }
}

TEST(HistoryFilters, SplineMeetsEveryPixelAndCoefficientsMatchTheLinearSystem) {
  Workers workers(2);
  for (const Window w :
       {kOdd, Window{0, 0, 1, 1}, Window{0, 0, 2, 5}, Window{0, 0, 7, 1}, Window{4, 4, 6, 6}, Window{0, 0, 3, 60}}) {
    const History h = noise_history(w, 11, workers);
    for (const int degree : {3, 5}) {
      const Plane<glm::vec4> fast = bspline_coefficients(h.color, degree, workers);
      const Plane<glm::dvec4> slow = reference::solve_bspline(h.color, degree);
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x)
          for (int k = 0; k < 4; ++k) {
            ASSERT_NEAR(double(fast.at(x, y)[k]), slow.at(x, y)[k], 1e-6 * size_around(h.color, x, y))
                << w.width() << "x" << w.height() << " degree " << degree << " at " << x << "," << y;
          }
    }
  }
}

TEST(HistoryFilters, ConstantStaysThatConstantExactly) {
  Workers workers(1);
  const Window w{0, 0, 21, 13};
  for (const float value : {1.0f, 0.1f, 3.0e-39f, 1e-30f, 65504.0f, 1e30f, 3e38f, -0.7f, 0.0f})
    for (const RecursiveParameters& p : wide_filters()) {
      const glm::vec4 color(value, value * 0.3f, value * 0.77f, 1.0f);
      Present present = flat_present(w, color, workers);
      present.motion = vectors(w, 17);
      History h;
      for (int frame = 0; frame < 5; ++frame) h = next_history(present, h, p, {}, workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x)
          for (int k = 0; k < 4; ++k) ASSERT_EQ(h.color.at(x, y)[k], color[k]) << value << " at " << x << "," << y;
    }
}

TEST(HistoryFilters, LightScaledByAPowerOfTwoScalesWhatIsReadBitForBit) {
  Workers workers(1);
  const History h = noise_history(kOdd, 5, workers);
  const Plane<glm::vec2> motion = vectors(kOdd, 6);
  for (const RecursiveParameters& p : wide_filters())
    for (const float scale : {0x1p20f, 0x1p-20f, 0x1p-60f, 0x1p60f}) {
      History scaled = next_history(flat_present(kOdd, glm::vec4(0.0f), workers), {}, {}, no_box(), workers);
      for (int y = kOdd.y0; y < kOdd.y1; ++y)
        for (int x = kOdd.x0; x < kOdd.x1; ++x) scaled.color.at(x, y) = h.color.at(x, y) * scale;
      const History a = read_at(h, motion, p, workers), b = read_at(scaled, motion, p, workers);
      for (int y = kOdd.y0; y < kOdd.y1; ++y)
        for (int x = kOdd.x0; x < kOdd.x1; ++x) ASSERT_EQ(b.color.at(x, y), a.color.at(x, y) * scale) << scale;
    }
}

TEST(HistoryFilters, ThreadsDoNotChangeAByte) {
  Workers one(1), many(5);
  const Window w{0, 0, 97, 53};
  const History h = noise_history(w, 5, one);
  const Plane<glm::vec2> motion = vectors(w, 6);
  for (const RecursiveParameters& p : wide_filters())
    EXPECT_TRUE(same_bits(read_at(h, motion, p, one).color, read_at(h, motion, p, many).color));
}

TEST(HistoryFilters, ExtremeValuesStayFiniteAndBetweenTheirNeighbors) {
  Workers workers(1);
  const Window w{0, 0, 23, 17};
  History h = noise_history(w, 5, workers);
  const float values[] = {FLT_MAX, -FLT_MAX, 1.7e38f, 65504.0f, -65504.0f, 1e30f, 1e-38f, 1e-45f, -0.0f, 0.0f};
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x)
      for (int k = 0; k < 3; ++k) h.color.at(x, y)[k] = values[(x * 7 + y * 3 + k * 5) % 10];
  const Plane<glm::vec2> motion = vectors(w, 2);
  for (const RecursiveParameters& p : wide_filters()) {
    const History read = read_at(h, motion, p, workers);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x)
        for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(read.color.at(x, y)[k])) << x << "," << y;
  }
}

TEST(HistoryFilters, DeringedNothingOvershootsBesideAHighlight) {
  Workers workers(1);
  const Window w{0, 0, 33, 33};
  Present present = flat_present(w, glm::vec4(0.01f, 0.01f, 0.01f, 1.0f), workers);
  History h = next_history(present, {}, {}, no_box(), workers);
  h.color.at(16, 16) = glm::vec4(65504.0f, 65504.0f, 65504.0f, 1.0f);
  const Plane<glm::vec2> half(w, 0, glm::vec2(0.5f, 0.5f));
  for (const RecursiveParameters& p : wide_filters()) {
    if (!p.dering) continue;
    const History read = read_at(h, half, p, workers);
    // B above 0 is a blur: it may spread, but only from pixels that count positively.
    const int spread = p.cubic_b > 0 && p.history_filter == HistoryFilter::cubic ? 2 : 1;
    for (int y = 2; y < w.y1 - 3; ++y)
      for (int x = 2; x < w.x1 - 3; ++x) {
        ASSERT_GE(read.color.at(x, y).r, 0.01f);
        const bool beside = 16 - x <= spread && x - 16 < spread && 16 - y <= spread && y - 16 < spread;
        if (!beside) {
          ASSERT_EQ(read.color.at(x, y).r, 0.01f) << x << "," << y;
        }
      }
  }
}

TEST(HistoryFilters, AtRestInterpolatingFiltersGiveTheHistoryItself) {
  Workers workers(1);
  const History h = noise_history(kOdd, 5, workers);
  const Plane<glm::vec2> rest(kOdd, 0, glm::vec2(0.0f));
  for (const RecursiveParameters& p : wide_filters())
    if (p.history_filter != HistoryFilter::cubic || p.cubic_b == 0) {
      EXPECT_TRUE(same_bits(read_at(h, rest, p, workers).color, h.color));
    }
}

TEST(HistoryFilters, PhaseIsLinear) {  // mirrored history along mirrored motion gives the mirror of what was read
  Workers workers(1);
  const Window w{0, 0, 31, 23};
  const History h = noise_history(w, 21, workers);
  History mirrored = noise_history(w, 21, workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) mirrored.color.at(x, y) = h.color.at(w.x1 - 1 - x, w.y1 - 1 - y);
  for (const glm::vec2 v : {glm::vec2(0.25f, 0.375f), glm::vec2(0.5f, 0.5f), glm::vec2(-1.125f, 0.75f)})
    for (const RecursiveParameters& p : wide_filters()) {
      const History a = read_at(h, Plane<glm::vec2>(w, 0, v), p, workers);
      const History b = read_at(mirrored, Plane<glm::vec2>(w, 0, -v), p, workers);
      for (int y = 4; y < w.y1 - 4; ++y)
        for (int x = 4; x < w.x1 - 4; ++x)
          for (int k = 0; k < 4; ++k)
            ASSERT_NEAR(double(a.color.at(x, y)[k]), double(b.color.at(w.x1 - 1 - x, w.y1 - 1 - y)[k]), 3e-6 * 200);
    }
}

TEST(HistoryFilters, WeightsSumToOneAndReproduceARamp) {
  for (const double f : {0.0, 1e-9, 0.1, 0.25, 0.5, 0.75, 0.999}) {
    for (const double b : {0.0, 1.0 / 3, 1.0})
      for (const double c : {0.0, 1.0 / 3, 0.5, 1.0}) {
        const CubicWeights w = cubic_weights(b, c, f);
        EXPECT_NEAR(w.w[0] + w.w[1] + w.w[2] + w.w[3], 1, 1e-14) << b << " " << c;
        // Mitchell and Netravali: straight lines are kept where 2C + B = 1 and, at the middle, always by symmetry.
        if (std::abs(2 * c + b - 1) < 1e-12 || f == 0.5) {
          EXPECT_NEAR(-w.w[0] + w.w[2] + 2 * w.w[3], f, 1e-14);
        }
      }
    for (const int degree : {3, 5}) {
      const BsplineWeights w = bspline_weights(degree, f);
      double sum = 0, first = 0;
      for (int k = 0; k <= degree; ++k) sum += w.w[k], first += w.w[k] * (k - degree / 2);
      EXPECT_NEAR(sum, 1, 1e-14);
      EXPECT_NEAR(first, f, 1e-14);
      for (int k = 0; k <= degree; ++k) EXPECT_GE(w.w[k], 0);
    }
  }
}

/// Standard deviation that noise keeps after many passes through a filter, half a pixel off on both axes each time.
double deviation_after(const RecursiveParameters& filter, int frames, Workers& workers) {
  const Window w{0, 0, 48, 48};
  RecursiveParameters p = filter;
  p.alpha = 0.02;
  p.alpha_rule = AlphaRule::fixed;
  std::mt19937 random(77);
  std::normal_distribution<float> noise(0, 1);
  History h;
  for (int f = 0; f < frames; ++f) {
    Present present = flat_present(w, glm::vec4(1.0f), workers);
    present.motion = Plane<glm::vec2>(w, 0, glm::vec2(f % 2 ? 0.5f : -0.5f, f % 2 ? -0.5f : 0.5f));
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) present.color.at(x, y) = glm::vec4(noise(random), 0, 0, 1);
    h = next_history(present, h, p, no_box(), workers);
  }
  double sum = 0;
  int count = 0;
  for (int y = 8; y < 40; ++y)
    for (int x = 8; x < 40; ++x, ++count) sum += double(h.color.at(x, y).r) * double(h.color.at(x, y).r);
  return std::sqrt(sum / count);
}

/// What is left of a wave by one pass, half a pixel off: the filter's weights, over the response of the coefficients.
double response(const RecursiveParameters& p, double frequency) {
  const double turn = 2 * std::numbers::pi * frequency;
  if (p.history_filter == HistoryFilter::bspline5) {
    const BsplineWeights w = bspline_weights(5, 0.5);
    return 2 * (w.w[0] * std::cos(2.5 * turn) + w.w[1] * std::cos(1.5 * turn) + w.w[2] * std::cos(0.5 * turn)) /
           ((66 + 52 * std::cos(turn) + 2 * std::cos(2 * turn)) / 120);
  }
  const bool spline = p.history_filter == HistoryFilter::bspline3;
  const CubicWeights w = cubic_weights(spline ? 1 : p.cubic_b, spline ? 0 : p.cubic_c, 0.5);
  const double weighed = 2 * (w.w[0] * std::cos(1.5 * turn) + w.w[1] * std::cos(0.5 * turn));
  return spline ? weighed / ((4 + 2 * std::cos(turn)) / 6) : weighed;
}

/// Deviation of white noise in the steady state: the mean over all waves of a^2 / (1 - (1 - a)^2 R^2).
double expected_deviation(const RecursiveParameters& p) {
  constexpr int n = 256;
  constexpr double a = 0.02;
  double sum = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double r = response(p, (i + 0.5) / n - 0.5) * response(p, (j + 0.5) / n - 0.5);
      sum += a * a / (1 - (1 - a) * (1 - a) * r * r);
    }
  return std::sqrt(sum / (n * n));
}

TEST(HistoryFilters, NoAcceptedFilterGrowsNoiseInSixHundredFrames) {
  Workers workers(1);
  // Held or not, no history holds more noise than the mean it stands for; not held, it is what the response says.
  const double unblurred = std::sqrt(0.02 / 1.98);
  for (const RecursiveParameters& p : wide_filters()) {
    const double deviation = deviation_after(p, 600, workers);
    const std::string name = std::to_string(int(p.history_filter)) + " B " + std::to_string(p.cubic_b) + " C " +
                             std::to_string(p.cubic_c) + (p.dering ? " dering" : "");
    EXPECT_LT(deviation, unblurred) << name;
    EXPECT_GT(deviation, 0.5 * expected_deviation(p)) << name;
    if (!p.dering) {
      EXPECT_NEAR(deviation, expected_deviation(p), 0.1 * expected_deviation(p)) << name;
    }
  }
}

TEST(HistoryFilters, WhatIsRefusedDoesDiverge) {
  Workers workers(2);
  const RecursiveParameters sharp = reading(HistoryFilter::cubic, false, 0, 0.75);
  ASSERT_TRUE(is_expansive(cubic_gain(0, 0.75)));
  EXPECT_GT(deviation_after(sharp, 600, workers), 100);
}

TEST(ResamplingGain, IsThatOfThePublishedKernels) {
  EXPECT_NEAR(cubic_gain(0, 0.5).gain, 1, 1e-12);
  EXPECT_NEAR(cubic_gain(1.0 / 3, 1.0 / 3).gain, 1, 1e-12);
  EXPECT_NEAR(cubic_gain(0, 0.6).gain, 1.0057, 1e-4);
  EXPECT_NEAR(cubic_gain(0, 0.75).gain, 1.0289, 1e-4);
  EXPECT_NEAR(lanczos_gain(3).gain, 1.027, 1e-3);
  EXPECT_NEAR(lanczos_gain(4).gain, 1.020, 1e-3);
  EXPECT_NEAR(critical_alpha(cubic_gain(0, 0.75)), 0.055, 1e-3);
  for (int i = 0; i <= 10; ++i) EXPECT_FALSE(is_expansive(cubic_gain(0, i * 0.05))) << i;
  for (const double c : {0.501, 0.6, 0.8, 1.0}) EXPECT_TRUE(is_expansive(cubic_gain(0, c))) << c;
  EXPECT_FALSE(is_expansive(cubic_gain(1, 0)));
  EXPECT_TRUE(is_expansive({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
}

TEST(ResamplingGain, TheSentenceTellsTheFigures) {
  const std::string text = expansive_filter_text("lanczos3", lanczos_gain(3));
  for (const char* part : {"lanczos3", "1.02", "cycles per pixel", "0.05", "bspline5"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

}  // namespace
}  // namespace varve
