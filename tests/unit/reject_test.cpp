// What makes history less believed, and how the present is weighed: the laws. The twins are compared in
// accumulate_test.cpp, with those of the accumulator.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <functional>

#include "base/reject.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::next_history;

constexpr DiagnosticsWanted kAll{true, true, true};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

RectifyParameters no_box() {
  RectifyParameters rectify;
  rectify.box = Box::none;
  return rectify;
}

/// White before, black now, so that the color is the weight of history; every plane a test could want.
struct Pair {
  Workers workers{1};
  Window w{0, 0, 16, 12};
  Present before = make(glm::vec4(1.0f)), now = make(glm::vec4(0, 0, 0, 1));

  Present make(const glm::vec4& color) {
    Present p = flat_present(w, color, workers);
    p.motion = Plane<glm::vec2>(w, 0, glm::vec2(0.0f));
    p.depth = Plane<float>(w, 0, 5.0f);
    p.id = Plane<std::uint32_t>(w, 0, 7u);
    p.normal = Plane<glm::vec3>(w, 0, glm::vec3(0, 0, 1));
    return p;
  }
  Accumulated run(const RecursiveParameters& recursive, int frames_before = 9) {
    History h;
    for (int f = 0; f < frames_before; ++f) h = next_history(before, h, recursive, no_box(), workers);
    return accumulate(now, h, recursive, no_box(), {}, kRejectCut, kAll, workers);
  }
};

struct TestCase {
  unsigned bit;
  std::function<void(RejectParameters&)> ask;
  std::function<void(Present& now, int x, int y)> differ;
};

std::vector<TestCase> tests_of_history() {
  const auto move = [](glm::vec2 v) { return [v](Present& p, int x, int y) { p.motion.at(x, y) = v; }; };
  return {
      {kRejectNormal, [](RejectParameters& p) { p.normal_angle = 30; },
       [](Present& p, int x, int y) { p.normal.at(x, y) = glm::vec3(0.6f, 0, 0.8f); }},
      {kRejectId, [](RejectParameters& p) { p.id = IdTest::hard; },
       [](Present& p, int x, int y) { p.id.at(x, y) = 0x40000007u; }},
      {kRejectId, [](RejectParameters& p) { p.id = IdTest::soft; },
       [](Present& p, int x, int y) { p.id.at(x, y) = 0x40000007u; }},
      {kRejectSpeed, [](RejectParameters& p) { p.speed = 1; }, move({1.5f, 0})},
      {kRejectAcceleration, [](RejectParameters& p) { p.acceleration = 1.5; }, move({1.5f, 0})},
  };
}

TEST(Reject, EachTestRestartsWhatDiffersAndNothingElse) {
  for (const TestCase& test : tests_of_history()) {
    SCOPED_TRACE(test.bit);
    Pair pair;
    RecursiveParameters p;
    test.ask(p.reject);
    test.differ(pair.now, 4, 5);
    const Accumulated a = pair.run(p);
    EXPECT_EQ(a.diagnostics.reject.at(4, 5), test.bit);
    EXPECT_EQ(a.history.color.at(4, 5).r, 0.0f);
    EXPECT_EQ(a.history.total.at(4, 5), 1.0f);
    EXPECT_EQ(a.counts.restarted, 1u);
    for (std::size_t bit = 0; bit < a.counts.rejected.size(); ++bit)
      EXPECT_EQ(a.counts.rejected[bit], 1u << bit == test.bit ? 1u : 0u) << bit;
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 16; ++x)
        ASSERT_EQ(a.history.total.at(x, y), x == 4 && y == 5 ? 1.0f : 10.0f) << x << "," << y;
  }
}

TEST(Reject, OffMeansOff) {
  for (const TestCase& test : tests_of_history()) {
    Pair pair;
    test.differ(pair.now, 4, 5);
    const Accumulated a = pair.run({});
    EXPECT_EQ(a.diagnostics.reject.at(4, 5), 0u);
    EXPECT_EQ(a.history.total.at(4, 5), 10.0f);
    EXPECT_TRUE(a.history.id.empty() && a.history.normal.empty() && a.history.motion.empty());
  }
}

TEST(Reject, DirectionComparesWhatMovesOnly) {
  Pair pair;
  RecursiveParameters p;
  p.reject.direction = 60;
  pair.before.motion.fill(glm::vec2(2, 0));
  pair.now.motion.fill(glm::vec2(2, 0.5f));  // 14 degrees
  pair.now.motion.at(4, 5) = glm::vec2(0, 2);
  pair.now.motion.at(8, 5) = glm::vec2(-2, 0);  // as long as before: lengths do not tell
  pair.now.motion.at(6, 5) = glm::vec2(0, 0.4f);
  const Accumulated a = pair.run(p);
  EXPECT_EQ(a.diagnostics.reject.at(4, 5), unsigned(kRejectDirection));
  EXPECT_EQ(a.diagnostics.reject.at(8, 5), unsigned(kRejectDirection));
  EXPECT_EQ(a.diagnostics.reject.at(6, 5), 0u);
  EXPECT_EQ(a.diagnostics.reject.at(6, 7), 0u);
  p.reject.direction = 0;
  p.reject.speed = 0.5;
  EXPECT_EQ(pair.run(p).diagnostics.reject.at(8, 5), 0u);
}

TEST(Reject, AccelerationRampsFromLowToHigh) {
  RecursiveParameters p;
  p.alpha = 0.1;
  p.alpha_rule = AlphaRule::fixed;
  p.reject.acceleration = 4;
  p.reject.acceleration_low = 1;
  for (const auto& [difference, trust] : {std::pair{0.5f, 1.0}, {1.0f, 1.0}, {2.5f, 0.5}, {3.25f, 0.25}, {4.0f, 0.0}}) {
    Pair pair;
    pair.now.motion.at(8, 5) = glm::vec2(difference, 0);
    const Accumulated a = pair.run(p);
    EXPECT_NEAR(double(a.history.color.at(8, 5).r), 0.9 * trust, 1e-6) << difference;
    EXPECT_NEAR(double(a.history.total.at(8, 5)), 9 * trust + 1, 1e-5);
    EXPECT_EQ(a.diagnostics.reject.at(8, 5), trust <= 0.5 ? unsigned(kRejectAcceleration) : 0u);
  }
}

// A floor seen at a slant: depth grows by 0.5 a row, and the camera looks half a pixel up.
TEST(Reject, SlopeKeepsASlantedFloorWhole) {
  Pair pair;
  RecursiveParameters p;
  p.disocclusion = Disocclusion::depth;
  p.depth_tolerance = 0.01;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 16; ++x) {
      pair.before.depth.at(x, y) = 5 + 0.5f * float(y);
      pair.now.depth.at(x, y) = 5.25f + 0.5f * float(y);
      pair.now.motion.at(x, y) = glm::vec2(0, 0.5f);
    }
  pair.now.depth.at(8, 6) = 20;  // something else altogether
  const Accumulated planar = pair.run(p);
  EXPECT_GT(planar.counts.rejected[3], 150u);
  p.reject.depth_slope = 1;
  const Accumulated sloped = pair.run(p);
  EXPECT_EQ(sloped.diagnostics.reject.at(8, 6), unsigned(kRejectDepth));
  EXPECT_EQ(sloped.counts.rejected[3], 1u);
  // Beside an edge the slope is that of the side it belongs to.
  EXPECT_EQ(sloped.diagnostics.reject.at(7, 6), 0u);
}

TEST(Reject, WithoutASlopeTheRowPassIsTheKernelsTest) {
  Workers workers(1);
  const Window w{0, 0, 40, 30};
  test::NoiseOptions noise;
  noise.with_depth = true;
  const Present before = test::noise_present(w, noise, workers);
  noise.seed = 2;
  const Present now = test::noise_present(w, noise, workers);
  RecursiveParameters kernel, apart;
  kernel.disocclusion = apart.disocclusion = Disocclusion::depth;
  apart.reject.depth_slope = 1e-12;
  const History h = next_history(before, {}, kernel, {}, workers);
  const Accumulated a = accumulate(now, h, kernel, {}, {}, 1, kAll, workers);
  const Accumulated b = accumulate(now, h, apart, {}, {}, 1, kAll, workers);
  EXPECT_GT(a.counts.rejected[3], 20u);
  EXPECT_EQ(a.counts.rejected, b.counts.rejected);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      for (int k = 0; k < 4; ++k)
        ASSERT_NEAR(double(a.history.color.at(x, y)[k]), double(b.history.color.at(x, y)[k]),
                    1e-6 * (1 + std::abs(double(a.history.color.at(x, y)[k]))));
}

TEST(Reject, SoftIdsHaveNoHardEdge) {
  // The left half is object 1, the right object 2; what is compared with moves across the border by parts of a pixel.
  RecursiveParameters p;
  p.alpha_rule = AlphaRule::fixed;
  for (const float part : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
    Pair pair;
    for (Present* present : {&pair.before, &pair.now})
      for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) present->id.at(x, y) = x < 8 ? 1 : 2;
    pair.now.motion.at(8, 5) = glm::vec2(-part, 0);
    p.reject.id = IdTest::soft;
    EXPECT_NEAR(double(pair.run(p).history.color.at(8, 5).r), 0.9 * (1 - double(part)), 1e-6);
    p.reject.id = IdTest::hard;
    EXPECT_NEAR(double(pair.run(p).history.color.at(8, 5).r), part <= 0.75f ? 0.9 : 0, 1e-6);
  }
}

TEST(Reject, OnRejectSaysWhatIsDone) {
  RecursiveParameters p;
  p.alpha = 0.1;
  p.reject.id = IdTest::hard;
  p.reject.alpha = 0.4;
  for (const OnReject then : {OnReject::restart, OnReject::blur, OnReject::weight}) {
    p.reject.on_reject = then;
    Pair pair;
    pair.now.color.at(4, 5) = glm::vec4(16.0f);
    pair.now.id.at(4, 5) = 9;
    const Accumulated a = pair.run(p);
    EXPECT_EQ(a.diagnostics.reject.at(4, 5), unsigned(kRejectId));
    const float expected = then == OnReject::restart ? 16.0f : then == OnReject::blur ? 4.0f : 0.6f * 1 + 0.4f * 16;
    EXPECT_NEAR(a.history.color.at(4, 5).r, expected, 1e-5f);
    EXPECT_NEAR(a.history.total.at(4, 5), then == OnReject::weight ? 2.5f : 1.0f, 1e-5f);
    EXPECT_NEAR(a.history.color.at(8, 5).r, 0.9f, 1e-6f);
  }
}

TEST(Reject, UnknownNormalsAndVectorsSayNothing) {
  Pair pair;
  RecursiveParameters p;
  p.reject.normal_angle = 1;
  p.reject.acceleration = 0.1;
  pair.before.normal.at(4, 5) = glm::vec3(0.0f);
  pair.before.motion.at(6, 5) = glm::vec2(kNaN);
  pair.before.motion.at(7, 5) = glm::vec2(HUGE_VALF);
  const Accumulated a = pair.run(p, 1);
  EXPECT_EQ(a.diagnostics.reject.at(4, 5), 0u);
  EXPECT_EQ(a.diagnostics.reject.at(6, 5), 0u);
  EXPECT_EQ(a.diagnostics.reject.at(7, 5), 0u);
}

TEST(Reject, MasksTakeHistoryAwayOrScaleThePresent) {
  RecursiveParameters p;
  p.alpha = 0.2;
  p.alpha_rule = AlphaRule::fixed;
  Pair pair;
  pair.now.reactive = Plane<float>(pair.w, 0, 0.0f);
  pair.now.responsive = Plane<float>(pair.w, 0, 1.0f);
  pair.now.reactive.at(1, 1) = 0.5f;
  pair.now.reactive.at(2, 1) = 1.0f;
  pair.now.responsive.at(3, 1) = 2.0f;
  pair.now.responsive.at(4, 1) = 0.0f;
  pair.now.responsive.at(5, 1) = 100.0f;
  const Accumulated a = pair.run(p);
  const float expected[] = {0.8f, 0.4f, 0.0f, 0.6f, 1.0f, 0.0f};
  for (int x = 0; x < 6; ++x) EXPECT_NEAR(a.history.color.at(x, 1).r, expected[x], 1e-6f) << x;
  EXPECT_EQ(a.diagnostics.reject.at(1, 1), unsigned(kRejectReactive));
  EXPECT_EQ(a.counts.rejected[12], 2u);
  p.weight.reactive = 0;
  EXPECT_NEAR(pair.run(p).history.color.at(2, 1).r, 0.8f, 1e-6f);
}

TEST(Weight, LumaFeedbackIsHighWhereLumaAgrees) {
  Workers workers(1);
  const Window w{0, 0, 8, 8};
  RecursiveParameters p;
  p.alpha_rule = AlphaRule::fixed;
  p.weight.feedback = Feedback::luma;
  const History h = next_history(flat_present(w, glm::vec4(1.0f), workers), {}, p, no_box(), workers);
  // u = 0, 1/2, 1: weights .97, .88 + .09/4, .88, whatever the exposure.
  for (const auto& [light, weight] :
       {std::pair{1.0f, 0.97}, {2.0f, 0.9025}, {0.5f, 0.9025}, {0.0f, 0.88}, {-1.0f, 0.88}}) {
    const Present now = flat_present(w, glm::vec4(light, light, light, 1), workers);
    const Accumulated a = accumulate(now, h, p, no_box(), {}, 1, kAll, workers);
    EXPECT_NEAR(double(a.diagnostics.weight.at(4, 4)), weight, 1e-6) << light;
  }
}

TEST(Weight, SpeedRaisesThePresent) {
  Pair pair;
  RecursiveParameters p;
  p.alpha = 0.1;
  p.alpha_rule = AlphaRule::fixed;
  p.weight.speed_alpha = 0.5;
  p.weight.full_speed = 4;
  pair.now.motion.at(8, 5) = glm::vec2(0, 2);
  pair.now.motion.at(9, 5) = glm::vec2(3, -4);
  const Accumulated a = pair.run(p);
  EXPECT_NEAR(double(a.diagnostics.weight.at(7, 5)), 0.9, 1e-6);
  EXPECT_NEAR(double(a.diagnostics.weight.at(8, 5)), 0.7, 1e-6);
  EXPECT_NEAR(double(a.diagnostics.weight.at(9, 5)), 0.5, 1e-6);
}

TEST(Weight, AntiFlickerAttenuatesAtTheWallAndIsNotCaughtByFlatPatches) {
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  RecursiveParameters p;
  p.alpha = 0.3;
  p.alpha_rule = AlphaRule::fixed;
  p.weight.anti_flicker = 1;
  RectifyParameters rectify = no_box();
  rectify.gamma = 1;
  // Columns of 0 and 2 about (4, 4): mean 2/3 or 4/3, known deviation; histories at the wall, in the middle, far off.
  Present now = flat_present(w, glm::vec4(0, 0, 0, 1), workers);
  for (int y = 0; y < 9; ++y) now.color.at(4, y) = glm::vec4(2, 2, 2, 1);
  const double mean = 2.0 / 3, sigma = std::sqrt((3 * 4.0) / 9 - mean * mean);
  const auto weight_of = [&](double light) {
    const float l = float(light);
    const History h = next_history(flat_present(w, glm::vec4(l, l, l, 1), workers), {}, p, rectify, workers);
    return double(accumulate(now, h, p, rectify, {}, 1, kAll, workers).diagnostics.weight.at(4, 4));
  };
  EXPECT_NEAR(weight_of(mean), 1 - 0.3 / 3, 1e-5);         // center of the box: a third
  EXPECT_NEAR(weight_of(mean + sigma), 1, 1e-5);           // at the wall: frozen
  EXPECT_NEAR(weight_of(mean + 1000 * sigma), 0.7, 1e-3);  // far away: as asked
  now = flat_present(w, glm::vec4(1.0f), workers);
  EXPECT_NEAR(weight_of(1), 0.7, 1e-6);  // 0/0 in the source
}

TEST(Weight, WeighingDarkensAsDocumentedAndFollowsTheExposure) {
  Pair pair;
  RecursiveParameters p;
  p.alpha = 0.5;
  p.alpha_rule = AlphaRule::fixed;
  pair.before.color.fill(glm::vec4(16, 16, 16, 1));
  pair.now.color.fill(glm::vec4(0, 0, 0, 1));
  sanitize(pair.before, pair.workers);
  sanitize(pair.now, pair.workers);
  p.weight.weighing = Weighing::luminance;
  EXPECT_NEAR(double(pair.run(p).history.color.at(4, 4).g), 8 * (1 - 0.889), 0.01);  // an edge of 16 loses 89 %
  p.weight.weighing = Weighing::logarithm;
  EXPECT_NEAR(double(pair.run(p).history.color.at(4, 4).g), std::sqrt(17.0) - 1, 1e-5);
  // Twice the light under half the exposure: twice the result, bit for bit where no library function is in it.
  Workers workers(1);
  const Window w{0, 0, 30, 20};
  for (const float scale : {4.0f, 1048576.0f, 9.5367431640625e-07f}) {
    p.weight.weighing = Weighing::luminance;
    const auto result = [&](float s) {
      RecursiveParameters q = p;
      q.weight.exposure = -double(std::log2(s));
      History h;
      for (unsigned f = 1; f < 4; ++f) {
        Present present = test::noise_present(w, {f, 0, 2, 0, false, 1}, workers);
        for (int y = 0; y < 20; ++y)
          for (int x = 0; x < 30; ++x)
            for (int k = 0; k < 3; ++k) present.color.at(x, y)[k] *= s;
        h = next_history(present, h, q, no_box(), workers);
      }
      return h;
    };
    const History plain = result(1), scaled = result(scale);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 30; ++x) ASSERT_EQ(scaled.color.at(x, y).g, plain.color.at(x, y).g * scale);
  }
}

}  // namespace
}  // namespace varve
