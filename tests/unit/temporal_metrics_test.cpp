// Metrics over time against sequences whose answer is known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "diagnose/bias_flicker.h"
#include "diagnose/ghost.h"
#include "diagnose/temporal_spectrum.h"
#include "diagnose/warped_residual.h"

namespace varve {
namespace {

const Window kWindow{2, -4, 34, 20};

/// Value of pixel (x, y) in all components.
template <class Value>
Plane<glm::vec4> gray(const Value& value) {
  Plane<glm::vec4> out(kWindow);
  for (int y = kWindow.y0; y < kWindow.y1; ++y)
    for (int x = kWindow.x0; x < kWindow.x1; ++x) out.at(x, y) = glm::vec4(float(value(x, y)));
  return out;
}

class TemporalMetrics : public testing::Test {
 protected:
  ColorPair pair(Plane<glm::vec4> a, Plane<glm::vec4> b) {
    return make_color_pair(std::move(a), std::move(b), false, workers);
  }
  /// Reference black, so that the picture is the error.
  template <class Value>
  ColorPair error(const Value& value) {
    return pair(Plane<glm::vec4>(kWindow, 0, glm::vec4(0)), gray(value));
  }
  Workers workers{2};
};

TEST_F(TemporalMetrics, BiasAndFlickerAddUpToTheSquareError) {
  std::mt19937 random(3);
  BiasFlicker gathered;
  double squares = 0;
  constexpr int frames = 7;
  for (int t = 0; t < frames; ++t) {
    const ColorPair p = error([&](int x, int) { return 0.01 * x + double(random() % 1000) / 1000; });
    for (int y = kWindow.y0; y < kWindow.y1; ++y)
      for (int x = kWindow.x0; x < kWindow.x1; ++x) squares += std::pow(double(p.b.at(x, y).g), 2);
    gathered.add(p, workers);
  }
  const auto split = gathered.split(workers);
  const double mse = squares / frames / double(kWindow.pixels());
  EXPECT_NEAR(split.bias + split.flicker, mse, 1e-13 * mse);
  EXPECT_NEAR(split.flicker, 1.0 / 12 * (frames - 1) / frames, 0.003);  // variance of a uniform number
}

TEST_F(TemporalMetrics, SteadyErrorIsBiasAlternatingErrorIsFlicker) {
  BiasFlicker steady, alternating;
  for (int t = 0; t < 8; ++t) {
    steady.add(error([](int, int) { return 0.25; }), workers);
    alternating.add(error([t](int, int) { return t % 2 ? 0.25 : -0.25; }), workers);
  }
  EXPECT_EQ(steady.split(workers).flicker, 0);
  EXPECT_DOUBLE_EQ(steady.split(workers).bias, 0.0625);
  EXPECT_DOUBLE_EQ(alternating.split(workers).flicker, 0.0625);
  EXPECT_NEAR(alternating.split(workers).bias, 0, 1e-18);
  BiasFlicker one;
  one.add(error([](int, int) { return 1; }), workers);
  EXPECT_TRUE(std::isnan(one.split(workers).bias));
  EXPECT_TRUE(std::isnan(BiasFlicker().split(workers).bias));
}

TEST_F(TemporalMetrics, SpectrumOfKnownErrors) {
  const auto share = [&](int frames, const auto& value) {
    TemporalSpectrum spectrum;
    for (int t = 0; t < frames; ++t) spectrum.add(error([&](int x, int) { return value(t, x); }), t == 0, workers);
    return spectrum.fast_share(workers);
  };
  for (int frames : {9, 12, 16, 32}) {
    EXPECT_NEAR(share(frames, [](int, int) { return 0.5; }), 0, 1e-12) << frames;
    if (frames % 2 != 0) continue;
    EXPECT_NEAR(share(frames, [](int t, int) { return t % 2 ? 1.0 : -1.0; }), 1, 1e-9) << frames;
  }
  // One cycle in 16 frames: under a Hann window 1/2 of the amplitude in its bin and 1/4 in each neighbor, which is
  // 1/6 of the power at two cycles in 16 frames. Phases are spread so that cross terms at bin 0 cancel.
  const double slow = share(16, [](int t, int x) { return std::cos(2 * std::numbers::pi * (t / 16.0 + x / 32.0)); });
  EXPECT_NEAR(slow, 1.0 / 6, 1e-6);
  EXPECT_TRUE(std::isnan(share(8, [](int t, int) { return double(t); })));
}

TEST_F(TemporalMetrics, WarpedResidualIgnoresErrorThatMovesAlong) {
  // The error is a ramp that moves by (3, -1.5) per frame; a bilinear fetch of a ramp is exact.
  const auto ramp = [](double x, double y) { return 0.01 * x + 0.02 * y; };
  const ColorPair before = error([&](int x, int y) { return ramp(x, y); });
  const ColorPair now = error([&](int x, int y) { return ramp(x - 3, y + 1.5); });
  const Plane<glm::vec2> motion(kWindow, 0, glm::vec2(-3, 1.5));
  const WarpedResidual along = warped_residual(now, before, motion, workers);
  EXPECT_NEAR(along.mean(), 0, 1e-12);
  EXPECT_EQ(along.values, 3u * 29u * 22u);  // what leads out of the window takes no part
  const WarpedResidual still = warped_residual(now, before, {}, workers);
  EXPECT_EQ(still.values, 3u * kWindow.pixels());
  EXPECT_NEAR(still.mean(), std::pow(ramp(-3, 1.5), 2), 1e-9);
  const Plane<glm::vec2> lost(kWindow, 0, glm::vec2(NAN));
  EXPECT_TRUE(std::isnan(warped_residual(now, before, lost, workers).mean()));
}

TEST_F(TemporalMetrics, GhostShareIsRecovered) {
  std::mt19937 random(1);
  const auto noise = [&](int, int) { return double(random() % 1000) / 100; };
  const auto stale = gray(noise), reference = gray(noise);
  Plane<glm::vec4> test(kWindow);
  for (int y = kWindow.y0; y < kWindow.y1; ++y)
    for (int x = kWindow.x0; x < kWindow.x1; ++x) test.at(x, y) = 0.85f * reference.at(x, y) + 0.15f * stale.at(x, y);
  EXPECT_NEAR(ghost_of(pair(reference.clone(), std::move(test)), stale, {}, workers).coefficient(), 0.15, 1e-6);
  EXPECT_EQ(ghost_of(pair(reference.clone(), reference.clone()), stale, {}, workers).coefficient(), 0);
  EXPECT_NEAR(ghost_of(pair(reference.clone(), stale.clone()), stale, {}, workers).coefficient(), 1, 1e-12);
  EXPECT_TRUE(std::isnan(ghost_of(pair(stale.clone(), reference.clone()), stale, {}, workers).coefficient()));
}

TEST(Lag, OfAnExponentialAverage) {
  for (const auto& [alpha, half_life] : {std::pair(0.05, 13.513), std::pair(0.1, 6.579), std::pair(0.2, 3.106)}) {
    for (int frames : {3, 20}) {
      std::vector<double> shares;
      for (int k = 0; k < frames; ++k) shares.push_back(std::pow(1 - alpha, k + 1));
      const Lag lag = lag_of(shares);
      EXPECT_NEAR(lag.mean_age, (1 - alpha) / alpha, 1e-9);
      EXPECT_NEAR(lag.half_life, half_life, 1e-3);
    }
  }
  EXPECT_EQ(lag_of(std::vector<double>{0, 0, 0}).mean_age, 0);
  EXPECT_EQ(lag_of(std::vector<double>{1, 1, 1}).mean_age, INFINITY);
  EXPECT_TRUE(std::isnan(lag_of(std::vector<double>{0.5}).mean_age));
}

}  // namespace
}  // namespace varve
