// Offsets of point-sampled frames at rest, told from how much their samples differ.
#include "diagnose/resting_offsets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace varve {
namespace {

constexpr Window kWindow{-3, 5, 118, 94};
const std::vector<glm::dvec2> kOffsets = {{0.0, -0.17}, {-0.25, 0.17}, {0.25, -0.39}, {-0.375, -0.06}, {0.125, 0.28}};

/// Squares and lines with hard edges over a soft ground.
double scene_at(double x, double y) {
  double v = 0.4 + 0.1 * std::sin(0.31 * x + 0.17 * y);
  for (int k = 0; k < 60; ++k) {
    const double cx = 113 * std::fmod(k * 0.618034, 1.0), cy = 93 * std::fmod(k * 0.754878, 1.0);
    const double u = (x - cx) * std::cos(k) + (y - cy) * std::sin(k),
                 w = (y - cy) * std::cos(k) - (x - cx) * std::sin(k);
    if (std::abs(u) < 3 + k % 5 && std::abs(w) < 2 + k % 3) v = 0.2 + 0.6 * std::fmod(k * 0.7320508, 1.0);
  }
  return v;
}

std::vector<Plane<float>> frames(double noise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<Plane<float>> all;
  for (const glm::dvec2& o : kOffsets) {
    Plane<float> p(kWindow);
    for (int y = kWindow.y0; y < kWindow.y1; ++y)
      for (int x = kWindow.x0; x < kWindow.x1; ++x)
        p.at(x, y) = float(scene_at(x + o.x, y + o.y) + noise * normal(random));
    all.push_back(std::move(p));
  }
  return all;
}

RestingOffsets measure(const std::vector<Plane<float>>& tones, const Plane<std::uint8_t>& resting, unsigned threads) {
  Workers workers(threads);
  std::vector<const Plane<float>*> list;
  for (const Plane<float>& p : tones) list.push_back(&p);
  // A rough beginning, as single pairs of frames give it.
  std::vector<glm::dvec2> start;
  for (std::size_t i = 0; i < tones.size(); ++i) start.push_back(0.7 * kOffsets[i] + glm::dvec2(0.03, -0.05));
  return resting_offsets(list, resting, start, workers);
}

const Plane<std::uint8_t> all_rests(kWindow, 0, std::uint8_t(1));

TEST(RestingOffsets, AreFoundUpToTheirMeanWithNoiseToo) {
  glm::dvec2 mean(0);
  for (const glm::dvec2& o : kOffsets) mean += o / double(kOffsets.size());
  for (const double noise : {0.0, 0.03}) {
    const RestingOffsets r = measure(frames(noise), all_rests, 2);
    ASSERT_TRUE(r.found) << noise;
    for (std::size_t i = 0; i < kOffsets.size(); ++i) {
      EXPECT_NEAR(r.offsets[i].x, kOffsets[i].x - mean.x, 0.06) << i << " noise " << noise;
      EXPECT_NEAR(r.offsets[i].y, kOffsets[i].y - mean.y, 0.06) << i << " noise " << noise;
      EXPECT_LT(r.sigma[i].x + r.sigma[i].y, 0.2);
    }
  }
}

TEST(RestingOffsets, ThreadsAndWhatDoesNotRestAreNothing) {
  std::vector<Plane<float>> tones = frames(0.03);
  Plane<std::uint8_t> resting = all_rests.clone();
  for (int y = 30; y < 50; ++y)
    for (int x = 20; x < 50; ++x) resting.at(x, y) = 0;
  const RestingOffsets a = measure(tones, resting, 1);
  for (std::size_t i = 0; i < tones.size(); ++i)
    for (int y = 31; y < 49; ++y)
      for (int x = 21; x < 49; ++x) tones[i].at(x, y) = i % 2 == 0 ? 0.9f : std::numeric_limits<float>::quiet_NaN();
  const RestingOffsets b = measure(tones, resting, 3);
  ASSERT_TRUE(a.found && b.found);
  // Only the rim of the hole differs.
  for (std::size_t i = 0; i < a.offsets.size(); ++i) {
    EXPECT_NEAR(a.offsets[i].x, b.offsets[i].x, 0.02);
    EXPECT_NEAR(a.offsets[i].y, b.offsets[i].y, 0.02);
  }
  const RestingOffsets c = measure(tones, resting, 1);
  ASSERT_TRUE(c.found);
  for (std::size_t i = 0; i < b.offsets.size(); ++i)
    EXPECT_EQ(std::memcmp(&b.offsets[i], &c.offsets[i], sizeof b.offsets[i]), 0);
}

TEST(RestingOffsets, TooLittleFlatAndHostileTellNothing) {
  std::vector<Plane<float>> tones = frames(0);
  EXPECT_FALSE(measure(tones, Plane<std::uint8_t>(kWindow, 0, std::uint8_t(0)), 1).found);
  tones.resize(3);
  EXPECT_FALSE(measure(tones, all_rests, 1).found);
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {0.0f, 0.5f, 3e38f, 1e-45f, inf, nan}) {
    std::vector<Plane<float>> flat;
    for (std::size_t i = 0; i < kOffsets.size(); ++i) flat.emplace_back(kWindow, 0, value);
    EXPECT_FALSE(measure(flat, all_rests, 1).found) << value;
  }
  EXPECT_FALSE(measure({}, all_rests, 1).found);
}

}  // namespace
}  // namespace varve
