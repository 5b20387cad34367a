// Rectification beyond the row kernel: its slow twin, and the laws every shape obeys.
#include "resolve/rectify_shapes.h"

#include <gtest/gtest.h>

#include <cfloat>

#include <glm/geometric.hpp>

#include "base/reject.h"
#include "plan/preset.h"
#include "reference/accumulate_reference.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::next_history;
using test::noise_present;
using test::same_bits;

constexpr DiagnosticsWanted kAll{true, true, true};

std::string name_of(const RectifyParameters& r) {
  return "box " + std::to_string(int(r.box)) + " rule " + std::to_string(int(r.rule)) + " anchor " +
         std::to_string(int(r.anchor)) + " space " + std::to_string(int(r.space)) + " window " +
         std::to_string(r.window) + " moments " + std::to_string(int(r.moments)) + " discount " +
         std::to_string(r.clip_discount);
}

/// Every combination that is allowed of box, rule, anchor and space; then windows; all of them for rectify_shapes().
std::vector<RectifyParameters> all_cases() {
  std::vector<RectifyParameters> cases;
  const auto add = [&](const RectifyParameters& r) {
    if (conflict(r, {}).empty() && needs_shapes(r)) cases.push_back(r);
  };
  RectifyParameters r;
  r.gamma = 0.75;
  for (r.box = Box::minmax; r.box <= Box::hull; r.box = Box(int(r.box) + 1))
    for (r.rule = BoxRule::clip; r.rule <= BoxRule::off; r.rule = BoxRule(int(r.rule) + 1))
      for (r.anchor = BoxAnchor::present; r.anchor <= BoxAnchor::center; r.anchor = BoxAnchor(int(r.anchor) + 1))
        for (r.space = BoxSpace::rgb; r.space <= BoxSpace::log; r.space = BoxSpace(int(r.space) + 1)) {
          if (r.rule != BoxRule::clip && r.anchor != BoxAnchor::present) continue;
          r.clip_discount = int(r.box) % 2 == 0;
          add(r);
        }
  r = {};
  for (r.window = 3; r.window <= 15; r.window += 2)
    for (r.moments = WindowMoments::direct; r.moments <= WindowMoments::pyramid;
         r.moments = WindowMoments(int(r.moments) + 1))
      for (r.box = Box::minmax; r.box <= Box::hull; r.box = Box(int(r.box) + 1)) {
        r.anchor = r.window % 4 == 1 ? BoxAnchor::mean : BoxAnchor::present;
        add(r);
      }
  r.box = Box::variance_minmax;
  r.window = 63;
  for (const WindowMoments m : {WindowMoments::separable, WindowMoments::gaussian, WindowMoments::pyramid})
    r.moments = m, add(r);
  return cases;
}

test::NoiseOptions noise_of(unsigned seed) { return {seed, 0.03, 3, 0.05, false, 1}; }

double size_around(const Present& present, int x, int y, int radius) {
  double size = 1e-30;
  for (int j = y - radius; j <= y + radius; ++j)
    for (int i = x - radius; i <= x + radius; ++i)
      if (present.color.window().contains(i, j))
        for (int k = 0; k < 4; ++k) size = std::max(size, std::abs(double(present.color.at(i, j)[k])));
  return size;
}

TEST(RectifyShapes, AgreeWithTheirSlowTwin) {
  Workers workers(2);
  unsigned seed = 100;
  for (const RectifyParameters& r : all_cases()) {
    if (r.box == Box::hull && r.window > 3) continue;  // the twin looks at every three of them
    SCOPED_TRACE(name_of(r));
    const Window first{-3, 5, 24, 22}, second{-1, 3, 26, 20};  // odd sizes; the window moves
    RecursiveParameters recursive;
    recursive.history_filter = HistoryFilter::bilinear;
    const History h = next_history(noise_present(first, noise_of(++seed), workers), {}, recursive, {}, workers);
    const Present present = noise_present(second, noise_of(++seed), workers);
    const Accumulated fast = accumulate(present, h, recursive, r, {}, kRejectCut, kAll, workers);
    // The hull is widened by a millionth of its size: a segment that just misses a long thin one from its tip leaves it
    // later than the exact one does (hull_test has the bounds). Fewer than one pixel in ten does, beside highlights.
    std::size_t allowed = r.box == Box::hull && r.rule == BoxRule::clip ? second.pixels() / 10 : 0;
    const double rounding = r.box == Box::hull ? 1e-4 : r.space == BoxSpace::log ? 2e-5 : 4e-6;
    for (int y = second.y0; y < second.y1; ++y)
      for (int x = second.x0; x < second.x1; ++x) {
        const reference::Pixel slow = reference::accumulate_pixel(present, h, recursive, r, {}, kRejectCut, x, y);
        const double size = std::max(size_around(present, x, y, r.window),
                                     double(glm::length(h.color.at(std::clamp(x, first.x0, first.x1 - 1),
                                                                   std::clamp(y, first.y0, first.y1 - 1)))));
        bool same = true;
        for (std::size_t k = 0; k < 4; ++k)  // history may come from a highlight farther off
          same = same && std::abs(double(fast.history.color.at(x, y)[int(k)]) - slow.color[k]) <=
                             rounding * std::max(size, std::abs(slow.color[k]));
        same = same && std::abs(double(fast.diagnostics.clip.at(x, y)) - slow.clip) <= 2e-4;
        same = same && std::abs(double(fast.history.total.at(x, y)) - slow.total) <= 2e-3;
        if (!same && allowed > 0) --allowed, same = true;
        ASSERT_TRUE(same) << x << "," << y << ": " << fast.history.color.at(x, y).g << " not " << slow.color[1]
                          << ", clip " << fast.diagnostics.clip.at(x, y) << " not " << slow.clip << ", total "
                          << fast.history.total.at(x, y) << " not " << slow.total;
      }
  }
}

TEST(RectifyShapes, PredictionAgreesWithItsSlowTwinAndOwesNothingToThePresentPixel) {
  Workers workers(2);
  const Window w{0, 0, 23, 17};
  for (RectifyParameters r : all_cases()) {
    if (r.box == Box::hull || r.space == BoxSpace::log) continue;
    SCOPED_TRACE(name_of(r));
    const History h = next_history(noise_present(w, noise_of(5), workers), {}, {}, {}, workers);
    const Present present = noise_present(w, noise_of(6), workers);
    const History fast = predict(present, h, {}, r, workers);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) {
        const reference::Pixel slow = reference::predict_pixel(present, h, {}, r, x, y);
        const double size = size_around(present, x, y, 20);
        for (std::size_t k = 0; k < 4; ++k)
          ASSERT_NEAR(double(fast.color.at(x, y)[int(k)]), slow.color[k], 4e-6 * (size + std::abs(slow.color[k])))
              << x << "," << y;
      }
    Present other = noise_present(w, noise_of(6), workers);
    other.color.at(11, 8) = glm::vec4(65504.0f);
    other.valid.at(11, 8) = present.valid.at(11, 8);
    const glm::vec4 a = predict(other, h, {}, r, workers).color.at(11, 8), b = fast.color.at(11, 8);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(double(a[k]), double(b[k]), 1e-6 * std::abs(double(b[k])));
  }
}

TEST(RectifyShapes, ConstantInConstantOutExactly) {
  Workers workers(1);
  const Window w{0, 0, 13, 9};
  for (const float value : {1.0f, 0.1f, 3.0e-39f, 1e-30f, 65504.0f, 1e30f, 3e38f, -0.7f, 0.0f})
    for (const RectifyParameters& r : all_cases()) {
      const glm::vec4 color(value, value * 0.3f, value * 0.77f, 1.0f);
      Present present = flat_present(w, color, workers);
      present.motion = noise_present(w, noise_of(3), workers).motion;
      History h;
      for (int frame = 0; frame < 3; ++frame) h = next_history(present, h, {}, r, workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) ASSERT_EQ(h.color.at(x, y), color) << name_of(r) << " " << value;
    }
}

TEST(RectifyShapes, ScalingTheLightByAPowerOfTwoScalesTheResultBitForBit) {
  Workers workers(1);
  const Window w{0, 0, 23, 15};
  for (const RectifyParameters& r : all_cases())
    for (const float scale : {4.0f, 9.5367431640625e-07f, 1.2676506e30f}) {
      const Present plain = noise_present(w, noise_of(8), workers);
      Present scaled = noise_present(w, noise_of(8), workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x)
          for (int k = 0; k < 3; ++k) scaled.color.at(x, y)[k] *= scale;
      const Accumulated a = accumulate(plain, next_history(plain, {}, {}, r, workers), {}, r, {}, 1, kAll, workers);
      const Accumulated b = accumulate(scaled, next_history(scaled, {}, {}, r, workers), {}, r, {}, 1, kAll, workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) {
          for (int k = 0; k < 3; ++k)
            ASSERT_EQ(b.history.color.at(x, y)[k], a.history.color.at(x, y)[k] * scale) << name_of(r) << " " << scale;
          ASSERT_EQ(b.diagnostics.clip.at(x, y), a.diagnostics.clip.at(x, y)) << name_of(r);
        }
    }
}

TEST(RectifyShapes, ThreadsDoNotChangeAByte) {
  Workers one(1), many(5);
  const Window w{0, 0, 61, 400};  // more than one band
  const Present present = noise_present(w, noise_of(4), one);
  const History h = next_history(present, {}, {}, {}, one);
  for (const RectifyParameters& r : all_cases()) {
    if (r.window < 15 && int(r.rule) + int(r.space) + int(r.anchor) > 0) continue;
    EXPECT_TRUE(same_bits(next_history(present, h, {}, r, one).color, next_history(present, h, {}, r, many).color))
        << name_of(r);
  }
}

TEST(RectifyShapes, ExtremeValuesStayFinite) {
  Workers workers(1);
  const Window w{0, 0, 19, 13};
  const float values[] = {FLT_MAX, -FLT_MAX, 1.7e38f, 65504.0f, -65504.0f, 1e30f, 1e-38f, 1e-45f, -0.0f, 0.0f};
  for (const RectifyParameters& r : all_cases())
    for (const int step : {1, 3, 7}) {
      Present p = noise_present(w, noise_of(2), workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x)
          for (int k = 0; k < 3; ++k) p.color.at(x, y)[k] = values[(x * step + y * 3 + k * 5) % 10];
      sanitize(p, workers);
      History h = next_history(noise_present(w, noise_of(3), workers), {}, {}, {}, workers);
      for (int f = 0; f < 2; ++f) {
        Accumulated a = accumulate(p, h, {}, r, {}, 1, kAll, workers);
        for (int y = 0; y < w.y1; ++y)
          for (int x = 0; x < w.x1; ++x) {
            for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(a.history.color.at(x, y)[k])) << name_of(r);
            ASSERT_TRUE(std::isfinite(a.diagnostics.clip.at(x, y))) << name_of(r);
            ASSERT_GT(a.history.total.at(x, y), 0) << name_of(r);
          }
        h = std::move(a.history);
      }
    }
}

TEST(RectifyShapes, WithoutAValidNeighborHistoryStands) {
  Workers workers(1);
  const Window w{0, 0, 9, 7};
  Present nothing = flat_present(w, glm::vec4(std::numeric_limits<float>::quiet_NaN()), workers);
  ASSERT_EQ(nothing.not_finite, w.pixels());
  const History h = next_history(noise_present(w, {9, 0, 0, 0, false, 1}, workers), {}, {}, {}, workers);
  for (const RectifyParameters& r : all_cases()) {
    const Accumulated a = accumulate(nothing, h, {}, r, {}, 1, kAll, workers);
    EXPECT_TRUE(same_bits(a.history.color, h.color)) << name_of(r);
    EXPECT_EQ(a.counts.clipped, 0u);
  }
}

TEST(RectifyShapes, SmallestWindows) {
  Workers workers(2);
  for (const Window w : {Window{4, 4, 5, 5}, Window{0, 0, 1, 9}, Window{-2, 0, 7, 1}, Window{0, 0, 2, 2}})
    for (const RectifyParameters& r : all_cases()) {
      const Present p = noise_present(w, noise_of(7), workers);
      const History h = next_history(p, next_history(p, {}, {}, r, workers), {}, r, workers);
      for (int x = w.x0; x < w.x1; ++x) ASSERT_TRUE(std::isfinite(h.color.at(x, w.y0).r)) << name_of(r);
    }
}

TEST(RectifyShapes, HistoryOfAnotherColorBecomesThePresentWhereThatIsFlat) {
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  const History black = next_history(flat_present(w, glm::vec4(0, 0, 0, 1), workers), {}, {}, {}, workers);
  for (const RectifyParameters& r : all_cases()) {
    const Accumulated a = accumulate(flat_present(w, glm::vec4(1.0f), workers), black, {}, r, {}, 1, kAll, workers);
    EXPECT_NEAR(double(a.diagnostics.clip.at(4, 4)), 1.0, 1e-5) << name_of(r);  // off measures, too
    if (r.rule == BoxRule::off) {
      EXPECT_EQ(a.counts.clipped, 0u);
      EXPECT_NEAR(double(a.history.color.at(4, 4).g), r.clip_discount ? 1 : 0.5, 1e-5) << name_of(r);
    } else {
      EXPECT_EQ(a.counts.clipped, w.pixels()) << name_of(r);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(double(a.history.color.at(4, 4)[k]), 1.0, 1e-5) << name_of(r);
    }
    if (r.clip_discount) {
      EXPECT_NEAR(double(a.history.total.at(4, 4)), 1.0, 1e-5) << name_of(r);
    }
  }
}

/// Mean squared error of the blend of a noisy present (variance 1) with a history of weight 9 that is off by `bias`.
double error_with_history(double bias, bool discount, Workers& workers) {
  const Window w{0, 0, 120, 90};
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  Present present = flat_present(w, glm::vec4(100, 100, 100, 1), workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x)
      present.color.at(x, y) += glm::vec4(normal(random), normal(random), normal(random), 0);
  History h = next_history(flat_present(w, glm::vec4(100, 100, 100, 1), workers), {}, {}, {}, workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) {
      // Off by the bias, and by the noise that nine samples leave.
      h.color.at(x, y) += glm::vec4(normal(random), normal(random), normal(random), 0) / 3.0f + float(bias);
      h.total.at(x, y) = 9;
    }
  RectifyParameters r;
  r.rule = BoxRule::off;
  r.gamma = 0;  // the mean of the neighbors: the distance is the whole bias
  r.window = 7;
  r.clip_discount = discount;
  const History out = next_history(present, h, {}, r, workers);
  double sum = 0;
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x)
      for (int k = 0; k < 3; ++k) sum += std::pow(double(out.color.at(x, y)[k]) - 100, 2) / 3 / double(w.pixels());
  return sum;
}

TEST(RectifyShapes, DiscountedHistoryIsNeverMuchWorseThanNoneAndHelpsWhereItIsRight) {
  Workers workers(2);
  const double alone = 1;  // the present's own variance
  for (const double bias : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    const double plain = error_with_history(bias, false, workers), with = error_with_history(bias, true, workers);
    RecordProperty("bias_" + std::to_string(int(10 * bias)), std::to_string(plain) + " " + std::to_string(with));
    EXPECT_LT(with, 1.1 * alone) << bias;
    if (bias == 0) {
      EXPECT_LT(with, 0.3 * alone);
    }
    if (bias >= 1) {
      EXPECT_LT(with, plain) << bias;
    }
  }
  EXPECT_GT(error_with_history(4, false, workers), 10 * alone);
}

TEST(RectifyShapes, LogIsOddExactAtZeroAndBack) {
  const BoxSpaceMap map{BoxSpace::log, 1.0 / 64};
  for (const double v : {0.0, 1e-30, 0.001, 1.0, 65504.0, 1e30, 3e38}) {
    const glm::dvec4 there = to_box_space(map, {v, -v, 0, 0.5}), back = from_box_space(map, there);
    EXPECT_EQ(there.x, -there.y);
    EXPECT_EQ(there.z, 0);
    EXPECT_EQ(there.w, 0.5);
    EXPECT_NEAR(back.x, v, 1e-13 * v);
  }
}

TEST(RectifyShapes, TheKneeFollowsTheLightAndNoFirefly) {
  Workers workers(2);
  const Window w{0, 0, 31, 17};
  Present p = noise_present(w, {3, 0.02, 0, 0, false, 1}, workers);
  const double knee = box_space_map(BoxSpace::log, p, workers).knee;
  p.color.at(3, 3) = glm::vec4(1e30f);
  EXPECT_EQ(box_space_map(BoxSpace::log, p, workers).knee, knee);
  const Present brighter = noise_present(w, {3, 0.02, 0, 0, false, 8}, workers);
  EXPECT_EQ(box_space_map(BoxSpace::log, brighter, workers).knee, 8 * knee);
  EXPECT_GT(box_space_map(BoxSpace::log, flat_present(w, glm::vec4(0.0f), workers), workers).knee, 0);
}

TEST(RectifyShapes, EveryNamedChoiceMakesAnotherPicture) {
  Workers workers(2);
  const Window w{0, 0, 61, 47};
  const Present present = noise_present(w, noise_of(11), workers);
  const History h = next_history(noise_present(w, noise_of(12), workers), {}, {}, {}, workers);
  std::vector<Plane<glm::vec4>> pictures;
  for (const char* choice : {"",
                             "box=none",
                             "box=minmax",
                             "box=rounded",
                             "box=dynamic4",
                             "box=variance-minmax",
                             "box=kdop7",
                             "box=kdop13",
                             "box=pca",
                             "box=ellipsoid",
                             "box=hull",
                             "box=hull hull-passes=1",
                             "box=hull rule=project",
                             "rule=project",
                             "anchor=mean",
                             "box=minmax anchor=center",
                             "space=ycocg",
                             "space=log",
                             "clip-discount=on",
                             "rule=off clip-discount=on",
                             "window=31",
                             "window=31 moments=gaussian",
                             "window=31 moments=pyramid",
                             "window=33"}) {
    Parameters p;
    set_parameters(p, choice);
    pictures.push_back(accumulate(present, h, p.recursive, p.rectify, {}, 1, {}, workers).history.color);
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_FALSE(same_bits(pictures[i], pictures.back())) << choice << " and number " << i;
  }
  // And the same box found in two ways is the same picture, to rounding.
  Parameters direct, separable;
  set_parameters(direct, "window=31");
  set_parameters(separable, "window=31 moments=separable");
  const History a = next_history(present, h, direct.recursive, direct.rectify, workers);
  const History b = next_history(present, h, direct.recursive, separable.rectify, workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x)
      for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(double(a.color.at(x, y)[k]), double(b.color.at(x, y)[k]),
                    1e-6 * std::abs(double(a.color.at(x, y)[k])));
}

TEST(RectifyShapes, WhatDoesNotGoTogetherIsRefusedWithARemedy) {
  RecursiveParameters fixed;
  fixed.alpha_rule = AlphaRule::fixed;
  const auto says = [](RectifyParameters r, const RecursiveParameters& recursive, const std::string& remedy) {
    EXPECT_NE(conflict(r, recursive).find(remedy), std::string::npos) << name_of(r) << ": " << conflict(r, recursive);
  };
  EXPECT_EQ(conflict({}, {}), "");
  RectifyParameters r;
  r.rule = BoxRule::clamp;
  for (r.box = Box::kdop7; r.box <= Box::hull; r.box = Box(int(r.box) + 1))
    if (r.box != Box::pca) says(r, {}, "--rule project");
  r = {};
  r.anchor = BoxAnchor::center;
  for (const Box box : {Box::kdop7, Box::kdop13, Box::hull}) r.box = box, says(r, {}, "--anchor mean");
  r = {};
  r.window = 7;
  for (const Box box : {Box::rounded, Box::dynamic4}) r.box = box, says(r, {}, "--window 3");
  r.moments = WindowMoments::separable;
  for (const Box box : {Box::kdop7, Box::kdop13, Box::pca, Box::ellipsoid, Box::hull})
    r.box = box, says(r, {}, "--moments direct");
  r.moments = WindowMoments::gaussian;
  r.box = Box::minmax;
  says(r, {}, "--moments separable");
  r = {};
  r.clip_discount = true;
  says(r, fixed, "--alpha-rule mean");
  r.box = Box::none;
  says(r, {}, "--box");
}

}  // namespace
}  // namespace varve
