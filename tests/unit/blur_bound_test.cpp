// How much repeated reading blurs: the formulas of Yang et al. 2009, by chance and by recursion, and what bounds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "base/reject.h"
#include "resolve/accumulate.h"
#include "resolve/blur_variance.h"
#include "resolve/residual.h"
#include "subpixel/blur_table.h"
#include "support/scenes.h"

namespace varve {
namespace {

double closed_form(double vx, double vy, double a, double own) {
  return own + (1 - a) / a * (vx * (1 - vx) + vy * (1 - vy)) / 2;
}

TEST(BlurVariance, IsThatOfARandomWalk) {
  // A sample of age i was moved by i coin tosses per axis; ages have the weights a (1 - a)^i.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  struct Case {
    double vx, vy, a;
  };
  for (const Case& c : {Case{0.5, 0.5, 0.1}, {0.25, 0.25, 0.1}, {0.1, 0.3, 0.05}, {0.33, 0.77, 0.2}}) {
    double square[2] = {};
    constexpr int kWalks = 40000;
    for (int n = 0; n < kWalks; ++n) {
      double at[2] = {unit(random) - 0.5, unit(random) - 0.5};
      while (unit(random) >= c.a) {
        at[0] += (unit(random) < c.vx) - c.vx;
        at[1] += (unit(random) < c.vy) - c.vy;
      }
      square[0] += at[0] * at[0], square[1] += at[1] * at[1];
    }
    const double expected = closed_form(c.vx, c.vy, c.a, kPixelVariance);
    EXPECT_NEAR((square[0] + square[1]) / (2 * kWalks), expected, 0.03 * expected);
  }
}

/// The kernel itself, moved and blended as the history is.
using Kernel = std::map<std::pair<int, int>, double>;

/// What the samples of one frame weigh, by the whole pixels that reading moved them, and the motion since.
struct Age {
  Kernel kernel;
  glm::dvec2 shift;
};

Kernel moved(const Kernel& kernel, const glm::dvec2& motion, double kept) {
  const double bx = std::floor(motion.x), by = std::floor(motion.y), fx = motion.x - bx, fy = motion.y - by;
  Kernel out;
  for (const auto& [at, w] : kernel)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        out[{at.first + int(bx) + i, at.second + int(by) + j}] += kept * w * (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
  return out;
}

TEST(BlurVariance, FollowsTheKernelOfEachPixelAndStaysBelowItsLimit) {
  Workers workers(1);
  const Window w{0, 0, 41, 41};
  RecursiveParameters recursive;
  recursive.history_filter = HistoryFilter::bilinear;
  recursive.alpha = 0.05;
  RectifyParameters rectify;
  rectify.box = Box::none;
  for (const double limit : {0.0, 0.5}) {
    recursive.blur_limit = limit;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> step(-0.5, 0.5);
    History history;
    std::vector<Age> ages;
    DiagnosticsWanted wanted;
    wanted.weight = wanted.blur = true;
    for (int i = 0; i < 20; ++i) {
      const glm::vec2 motion(float(step(random)), float(step(random)));
      Present frame = test::flat_present(w, glm::vec4(1.0f), workers);
      frame.motion = Plane<glm::vec2>(w, 0, motion);
      Accumulated out = accumulate(frame, history, recursive, rectify, {}, kRejectCut, wanted, workers);
      const double a = 1 - double(out.diagnostics.weight.at(20, 20));
      double second = a * kPixelVariance;
      for (Age& age : ages) {
        age.kernel = moved(age.kernel, motion, 1 - a);
        age.shift -= glm::dvec2(motion);
        for (const auto& [at, weight] : age.kernel) {
          const double x = at.first + age.shift.x, y = at.second + age.shift.y;
          second += weight * ((x * x + y * y) / 2 + kPixelVariance);
        }
      }
      ages.push_back({{{{0, 0}, a}}, glm::dvec2(0.0)});
      ASSERT_NEAR(double(out.diagnostics.blur.at(20, 20)), second, 1e-5);
      if (limit > 0) {
        ASSERT_LE(double(out.diagnostics.blur.at(20, 20)), limit * (1 + 1e-5));
      }
      history = std::move(out.history);
    }
  }
}

TEST(BlurVariance, OfFiltersIsTheirSecondMoment) {
  RecursiveParameters p;
  p.history_filter = HistoryFilter::catmull_rom;
  EXPECT_EQ(kernel_variance(p, 0.3), 0);
  p.history_filter = HistoryFilter::cubic;
  p.cubic_b = p.cubic_c = 1.0 / 3;
  EXPECT_NEAR(kernel_variance(p, 0.5), 1.0 / 9, 1e-12);
  p.cubic_b = 1, p.cubic_c = 0;
  EXPECT_NEAR(kernel_variance(p, 0.2), 1.0 / 3, 1e-12);
}

TEST(BlurBound, IsTheLeastWeightThatHolds) {
  EXPECT_EQ(alpha_of_blur(0.4, 0.1, 0.5), 0);
  EXPECT_EQ(alpha_of_blur(0.4, 0.1, 0), 0);
  const double a = alpha_of_blur(0.9, 1.0 / 12, 0.5);
  EXPECT_NEAR(a / 12 + (1 - a) * 0.9, 0.5, 1e-12);
  EXPECT_EQ(alpha_of_blur(0.9, 0.3, 0.2), 1);
}

TEST(ResidualBound, LeavesWhatItSays) {
  // A step of 1 under a limit of .1 and an alpha of .1: .1, then the usual decay.
  double left = 1;
  for (const double expected : {0.1, 0.09, 0.081}) {
    left *= 1 - std::max(0.1, alpha_of_residual(left, 0.1));
    EXPECT_NEAR(left, expected, 1e-12);
  }
}

TEST(ResidualBound, NoiseCancelsAndAChangeDoesNot) {
  Workers workers(1);
  const Window w{0, 0, 64, 64};
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.2f);
  for (const int window : {3, 7}) {
    Plane<glm::vec4> rest(w), changed(w);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const float n = noise(random);
        rest.at(x, y) = difference_to(glm::vec4(1 + n), glm::vec4(1.0f));
        changed.at(x, y) = difference_to(glm::vec4(1.5f + n), glm::vec4(1.0f));
      }
    const Plane<float> a = residual_of(rest, window, workers), b = residual_of(changed, window, workers);
    double mean_a = 0, mean_b = 0;
    for (int y = 8; y < 56; ++y)
      for (int x = 8; x < 56; ++x) mean_a += double(a.at(x, y)) / (48 * 48), mean_b += double(b.at(x, y)) / (48 * 48);
    // sigma sqrt(2 / pi) / window over the mean scale, which noise lifts a little.
    EXPECT_NEAR(mean_a, 0.2 * std::sqrt(2 / 3.14159265) / window, 0.2 * 0.16 / window + 0.005);
    EXPECT_NEAR(mean_b, 1.0 / 3, 0.02);
  }
}

TEST(ResidualBound, HoldsAtAnyExposure) {
  Workers workers(2);
  const Window w{0, 0, 17, 9};
  RecursiveParameters recursive;
  recursive.residual_limit = 0.1;
  recursive.residual_window = 3;
  RectifyParameters rectify;
  DiagnosticsWanted wanted;
  wanted.residual = wanted.blur = true;
  test::NoiseOptions noise;
  std::vector<History> histories(3);
  for (int i = 0; i < 4; ++i) {
    std::vector<Accumulated> out;
    for (const float scale : {1.0f, 0x1p-27f, 0x1p16f}) {
      noise.seed = unsigned(i + 1), noise.scale = scale;
      const Present frame = test::noise_present(w, noise, workers);
      out.push_back(accumulate(frame, histories[out.size()], recursive, rectify, {}, kRejectCut, wanted, workers));
    }
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 17; ++x) {
        ASSERT_EQ(out[0].diagnostics.residual.at(x, y), out[1].diagnostics.residual.at(x, y));
        ASSERT_EQ(out[0].diagnostics.residual.at(x, y), out[2].diagnostics.residual.at(x, y));
        for (int k = 0; k < 3; ++k)
          ASSERT_EQ(out[0].history.color.at(x, y)[k] * 0x1p-27f, out[1].history.color.at(x, y)[k]);
      }
    for (std::size_t k = 0; k < 3; ++k) histories[k] = std::move(out[k].history);
  }
}

WeighSamples once(double radius, SubpixelWeights weights) {
  return [=](TentSamples& s) { return weigh_samples_once(s, radius, weights); };
}

double least_of_histories(double vx, double vy, const WeighSamples& weigh) {
  const glm::dvec2 v(vx + 1e-4, vy + 2e-4);
  return least_alpha(0.5, [&](double a) { return largest_moment(steady_kernels(v, a, weigh)); });
}

TEST(BlurTable, HasTheKnownValues) {
  // From an independent implementation of the recursion, at 0.5 px^2.
  const WeighSamples corrected = once(0.625, SubpixelWeights::first_order), wide = once(1, SubpixelWeights::plain);
  EXPECT_NEAR(least_of_histories(0, 0, corrected), 0.130, 6e-4);
  EXPECT_NEAR(least_of_histories(0.1, 0, corrected), 0.171, 6e-4);
  EXPECT_NEAR(least_of_histories(0.2, 0, corrected), 0.001, 6e-4);
  EXPECT_NEAR(least_of_histories(0.3, 0.2, corrected), 0.146, 6e-4);
  EXPECT_NEAR(least_of_histories(0.5, 0.1, corrected), 0.173, 6e-4);
  EXPECT_NEAR(least_of_histories(0.2, 0.5, corrected), 0.164, 6e-4);
  EXPECT_NEAR(least_of_histories(0.1, 0, wide), 0.257, 6e-4);
  EXPECT_NEAR(least_of_histories(0.5, 0.5, wide), 0.116, 6e-4);
}

TEST(BlurTable, OfTheWidestTentHasAClosedForm) {
  for (const glm::dvec2& v : {glm::dvec2(0.13, 0.41), glm::dvec2(0.37, 0.02)})
    for (const double a : {0.1, 0.35}) {
      double spread = 0;
      for (std::size_t k = 0; k < kQuadrants; ++k)
        for (std::size_t j = 0; j < kQuadrants; ++j)
          for (int axis = 0; axis < 2; ++axis) {
            const double lag = double((k + 7 - j) % 4 + 1);
            const double at = kQuadrantMiddle[j][axis] - kQuadrantMiddle[k][axis] + v[axis] * lag,
                         f = at - std::floor(at);
            spread += f * (1 - f) / 32;
          }
      const SteadyKernels s = steady_kernels(v, a, once(1, SubpixelWeights::plain));
      double mean = 0;
      for (const glm::dvec2& q : s.second) mean += (q.x + q.y) / 8;
      EXPECT_NEAR(mean, 1.0 / 48 + (1 - a) / a * spread, 1e-12);
      for (const glm::dvec2& m : s.mean) EXPECT_NEAR(m.x, 0, 1e-12);
    }
}

TEST(BlurTable, PlainNarrowTentsDrift) {
  const SteadyKernels s = steady_kernels({1.0 / 3, 1.0 / 3}, 0.1, once(0.5, SubpixelWeights::plain));
  EXPECT_GT(std::abs(s.mean[0].x) + std::abs(s.mean[0].y), 1.0);
}

TEST(BlurTable, IsMirroredAndNeverTooSmall) {
  const WeighSamples weigh = [](TentSamples& s) { return weigh_samples_around(s, 0.5, SubpixelWeights::first_order); };
  const BlurTable table = tabulate_blur(0.5, weigh);
  EXPECT_EQ(table.at({0.2, 0.1}), table.at({-0.2, 3.1}));
  EXPECT_EQ(table.at({0.8, 0.9}), table.at({0.2, 0.1}));
  EXPECT_EQ(table.at({NAN, 0.0}), 0);
  for (double v = 0.03; v < 0.5; v += 0.12) {
    const double a = table.at({v, 0.5 - v});
    EXPECT_LE(picture_moment(steady_kernels({v, 0.5 - v}, a, weigh), a), 0.5 * 1.1);
  }
}

}  // namespace
}  // namespace varve
