// Medians, Pareto fronts, recommendations and rank correlation; settings; the score without truth; sharpness.
#include "diagnose/trade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "diagnose/leave_out.h"
#include "diagnose/sharpness.h"
#include "plan/setting.h"

namespace varve {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Trade, MedianIsTheMiddle) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({1, 1, 1000}), 1);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Trade, FrontHoldsWhatNothingBeats) {
  const std::vector<TradePoint> points = {{1, 9}, {2, 5}, {2, 5}, {3, 6}, {4, 1}, {0.5, kNan}, {2, 7}};
  EXPECT_EQ(pareto_front(points), (std::vector<bool>{true, true, true, false, true, false, false}));
}

TEST(Trade, FrontMatchesItsDefinitionOnRandomPoints) {
  std::mt19937 random(5);
  std::vector<TradePoint> points;
  for (int i = 0; i < 200; ++i) points.push_back({double(random() % 20), double(random() % 20)});
  const std::vector<bool> front = pareto_front(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool beaten = false;
    for (const TradePoint& p : points)
      beaten |= (p.seconds < points[i].seconds && p.error <= points[i].error) ||
                (p.seconds <= points[i].seconds && p.error < points[i].error);
    EXPECT_EQ(front[i], !beaten);
  }
}

TEST(Trade, RecommendsTheCheapestThatIsCloseEnough) {
  const std::vector<TradePoint> points = {{1, 2.0}, {2, 1.04}, {3, 1.0}, {1, kNan}};
  EXPECT_EQ(cheapest_within(points, 5), std::optional<std::size_t>(1));
  EXPECT_EQ(cheapest_within(points, 0), std::optional<std::size_t>(2));
  EXPECT_EQ(cheapest_within(points, 100), std::optional<std::size_t>(0));
  EXPECT_FALSE(cheapest_within(std::vector<TradePoint>{{1, kNan}}, 5));
}

TEST(Trade, RankCorrelationSeesOrderOnly) {
  const std::vector<double> a = {1, 2, 3, 4}, cubes = {1, 8, 27, 64}, down = {9, 7, 5, -3}, flat = {1, 1, 1, 1};
  EXPECT_DOUBLE_EQ(rank_correlation(a, cubes), 1);
  EXPECT_DOUBLE_EQ(rank_correlation(a, down), -1);
  EXPECT_DOUBLE_EQ(rank_correlation(a, std::vector<double>{2, 1, 4, 3}), 0.6);  // 1 - 6 * 4 / (4 * 15)
  EXPECT_NEAR(rank_correlation(a, std::vector<double>{1, 2, 2, 3}), 0.948683, 1e-6);
  EXPECT_TRUE(std::isnan(rank_correlation(a, flat)));
  EXPECT_TRUE(std::isnan(rank_correlation(a, std::vector<double>{1, 2, kNan, 4})));
}

TEST(Setting, CombinesSweepsAndDropsEqualOnes) {
  const std::vector<std::string> presets = {"salvi"}, sweeps = {"gamma=1,2", "alpha=0.1,0.2"},
                                 singles = {"box=none", "gamma=2 alpha=0.2"};
  const std::vector<Setting> settings = make_settings(presets, sweeps, singles);
  ASSERT_EQ(settings.size(), 5u);
  EXPECT_EQ(settings[1].name(), "salvi gamma=1 alpha=0.2");
  EXPECT_EQ(settings[1].parameters.recursive.alpha, 0.2);
  EXPECT_EQ(settings[4].arguments(), (std::vector<std::string>{"--preset=salvi", "--box=none"}));
}

TEST(Setting, RefusesWhatItCannotMean) {
  const std::vector<std::string> salvi = {"salvi"}, none;
  for (const char* sweep : {"gamma", "gamma=", "gamma=x", "nonsense=1", "alpha=0"})
    EXPECT_THROW(make_settings(salvi, std::vector<std::string>{sweep}, none), Failure) << sweep;
  EXPECT_THROW(make_settings(salvi, std::vector<std::string>{"gamma=1", "gamma=2"}, none), Failure);
  EXPECT_THROW(make_settings(std::vector<std::string>{"nobody"}, none, none), Failure);
}

constexpr Window kWindow{0, 0, 48, 40};

Plane<glm::vec4> pattern(int shift) {
  Plane<glm::vec4> plane(kWindow);
  for (int y = 0; y < kWindow.y1; ++y)
    for (int x = 0; x < kWindow.x1; ++x) {
      const float v = 0.4f + 0.3f * std::sin(0.7f * float(x - shift)) * std::cos(0.5f * float(y));
      plane.at(x, y) = glm::vec4(v, v, v, 1);
    }
  return plane;
}

Plane<glm::vec4> noisy(const Plane<glm::vec4>& from, float sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, sigma);
  Plane<glm::vec4> out = from.clone();
  for (int y = 0; y < kWindow.y1; ++y)
    for (int x = 0; x < kWindow.x1; ++x) out.at(x, y) += noise(random);
  return out;
}

TEST(LeaveOut, RanksByErrorThoughTheSamplesAreNoisier) {
  Workers workers(2);
  const Plane<std::uint8_t> good(kWindow, 0, 0);
  const Plane<glm::vec2> motion(kWindow, 0, glm::vec2(-2, 0));
  const Plane<glm::vec4> before = pattern(0), sample = noisy(pattern(2), 0.3f, 1);
  double last = 0;
  for (float error : {0.0f, 0.1f, 0.2f}) {
    const double score = leave_out_error(sample, good, noisy(before, error, 7), motion, workers).mean();
    EXPECT_GT(score, last);
    last = score;
  }
  // Following the wrong vectors is worse than noise.
  EXPECT_GT(leave_out_error(sample, good, before, {}, workers).mean(), last);
}

TEST(LeaveOut, CountsTheSamePixelsForAll) {
  Workers workers(1);
  Plane<std::uint8_t> bad(kWindow, 0, 0);
  bad.at(20, 20) = 1;
  Plane<glm::vec2> motion(kWindow, 0, glm::vec2(0, 0));
  motion.at(5, 5) = glm::vec2(std::numeric_limits<float>::quiet_NaN(), 0);
  motion.at(6, 6) = glm::vec2(1e30f, 0);
  const Plane<glm::vec4> same = pattern(0);
  const LeaveOut score = leave_out_error(same, bad, same, motion, workers);
  EXPECT_EQ(score.values, 3 * (kWindow.pixels() - 3));
  EXPECT_EQ(score.mean(), 0);
  EXPECT_TRUE(std::isnan(LeaveOut().mean()));
}

TEST(Sharpness, SeesBlurAndNotNoise) {
  Workers workers(2);
  const auto share = [&](Plane<glm::vec4> test) {
    return sharpness_of(make_color_pair(pattern(0), std::move(test), false, workers), workers).share();
  };
  Plane<glm::vec4> soft = pattern(0);
  for (int y = 0; y < kWindow.y1; ++y)
    for (int x = 1; x + 1 < kWindow.x1; ++x)
      soft.at(x, y) = (pattern(0).at(x - 1, y) + pattern(0).at(x, y) + pattern(0).at(x + 1, y)) / 3.0f;
  EXPECT_DOUBLE_EQ(share(pattern(0)), 1);
  EXPECT_LT(share(soft.clone()), 0.92);
  EXPECT_NEAR(share(noisy(pattern(0), 0.05f, 3)), 1, 0.05);
}

}  // namespace
}  // namespace varve
