// The two-sided accumulator: its slow twin, and the laws it obeys.
#include "resolve/two_sided.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <vector>

#include "base/reject.h"
#include "reference/two_sided_reference.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::noise_present;
using test::same_bits;

constexpr DiagnosticsWanted kAll{true, true, true, true};

struct Settings {
  RecursiveParameters recursive;
  RectifyParameters rectify;
  TwoSidedParameters two_sided;
  std::optional<glm::dvec2> jitter;

  Settings() { rectify.clip_discount = true; }
};

Settings plain_sums(double alpha = 0.1) {
  Settings s;
  s.recursive.alpha = alpha;
  s.recursive.alpha_rule = AlphaRule::fixed;
  s.rectify.box = Box::none;
  return s;
}

/// A frame of a test sequence: its colors, and where its pixels were and will be.
struct Frame {
  Present present;  // its motion is that to the frame before
  Plane<glm::vec2> forward;
};

SideStep side(const Present& present, const History& beyond, const Settings& s, Workers& workers) {
  return accumulate_side(present, beyond, s.recursive, s.rectify, s.jitter, kRejectCut, kAll, workers);
}

MergedStep both(const Present& present, const History& beyond, const StrictSide& other, const Settings& s,
                Workers& workers) {
  return accumulate_both(present, beyond, other, s.recursive, s.rectify, s.jitter, kRejectCut, kAll, workers);
}

/// The whole sequence at once: back through the future, then on through the past.
std::vector<Accumulated> resolve_all(std::vector<Frame>& frames, const Settings& s, Workers& workers) {
  std::vector<StrictSide> futures(frames.size());
  History state;
  for (std::size_t i = frames.size(); i-- > 0;) {
    std::swap(frames[i].present.motion, frames[i].forward);
    SideStep step = side(frames[i].present, state, s, workers);
    std::swap(frames[i].present.motion, frames[i].forward);
    futures[i] = std::move(step.strict);
    state = std::move(step.state);
  }
  std::vector<Accumulated> resolved;
  state = {};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    MergedStep step = both(frames[i].present, state, futures[i], s, workers);
    resolved.push_back(std::move(step.resolved));
    state = std::move(step.state);
  }
  return resolved;
}

std::vector<Frame> noise_frames(int count, const Window& w, test::NoiseOptions noise, Workers& workers) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    ++noise.seed;
    Frame frame{noise_present(w, noise, workers), {}};
    test::NoiseOptions other = noise;
    other.seed += 500;
    frame.forward = noise_present(w, other, workers).motion;
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<Settings> many_settings() {
  std::vector<Settings> all;
  for (const HistoryFilter filter : {HistoryFilter::bilinear, HistoryFilter::catmull_rom})
    for (const AlphaRule rule : {AlphaRule::fixed, AlphaRule::mean})
      for (const Box box : {Box::none, Box::minmax, Box::variance})
        for (const bool discount : {true, false}) {
          Settings s;
          s.recursive.history_filter = filter;
          s.recursive.alpha_rule = rule;
          s.rectify.box = box;
          s.rectify.clip_discount = discount;
          all.push_back(s);
        }
  Settings samples;
  samples.recursive.sample_filter = SampleFilter::gaussian;
  samples.jitter = glm::dvec2(0.31, -0.22);
  all.push_back(samples);
  Settings depth;
  depth.recursive.disocclusion = Disocclusion::depth;
  depth.rectify.space = BoxSpace::ycocg;
  all.push_back(depth);
  // Tests between the steps: some of the four history pixels stand in for the others, and trust is between 0 and 1.
  Settings tests = depth;
  tests.recursive.reject.depth_slope = 1;
  tests.recursive.reject.acceleration_low = 1;
  tests.recursive.reject.acceleration = 6;
  tests.recursive.reject.speed = 5;
  all.push_back(tests);
  // Shapes that the row kernel has no code for.
  for (const Box box : {Box::rounded, Box::pca, Box::ellipsoid}) {
    Settings shape;
    shape.rectify.box = box;
    all.push_back(shape);
  }
  return all;
}

void expect_twin(const Present& present, const History& beyond, const StrictSide& future, const Settings& s,
                 Workers& workers) {
  const SideStep fast_side = side(present, beyond, s, workers);
  const MergedStep fast = both(present, beyond, future, s, workers);
  EXPECT_TRUE(same_bits(fast.state.color, fast_side.state.color)) << "merging changes nothing of the side";
  const Window& w = present.color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const reference::SidePixel slow =
          reference::side_pixel(present, beyond, s.recursive, s.rectify, s.jitter, kRejectCut, x, y);
      reference::Pixel other;
      for (std::size_t k = 0; k < 4; ++k) other.color[k] = double(future.color.at(x, y)[int(k)]);
      other.total = double(future.total.at(x, y));
      other.spread = double(future.spread.at(x, y));
      other.clip = double(future.clip.at(x, y));
      const reference::Pixel merged = reference::merged_pixel(present, slow.strict, other, s.recursive, s.jitter, x, y);
      double size = 1e-30;
      for (int j = -3; j <= 3; ++j)
        for (int i = -3; i <= 3; ++i)
          if (w.contains(x + i, y + j))
            for (int k = 0; k < 4; ++k) size = std::max(size, std::abs(double(present.color.at(x + i, y + j)[k])));
      // A clip that ends within rounding of its start may be discounted or not: weights are compared to that.
      const double weight_slack = 1e-4 * std::max(1.0, merged.total);
      ASSERT_NEAR(double(fast_side.strict.total.at(x, y)), slow.strict.total, weight_slack) << x << "," << y;
      ASSERT_NEAR(double(fast.state.total.at(x, y)), slow.state_total, weight_slack) << x << "," << y;
      ASSERT_NEAR(double(fast.state.spread.at(x, y)), slow.state_spread, 1e-4);
      ASSERT_NEAR(double(fast.resolved.history.total.at(x, y)), merged.total, weight_slack);
      ASSERT_NEAR(double(fast.resolved.history.spread.at(x, y)), merged.spread, 1e-4);
      ASSERT_NEAR(double(fast.resolved.diagnostics.weight.at(x, y)), merged.weight, 1e-4);
      ASSERT_NEAR(double(fast.resolved.diagnostics.clip.at(x, y)), merged.clip, 1e-4);
      ASSERT_EQ(fast.resolved.diagnostics.reject.at(x, y), merged.reject);
      ASSERT_EQ(fast.resolved.diagnostics.reject_future.at(x, y), future.reject.at(x, y));
      for (std::size_t k = 0; k < 4; ++k) {
        const double slack = 2e-5 * std::max({size, std::abs(merged.color[k]), std::abs(slow.strict.color[k])});
        ASSERT_NEAR(double(fast_side.strict.color.at(x, y)[int(k)]), slow.strict.color[k], slack) << x << "," << y;
        ASSERT_NEAR(double(fast.state.color.at(x, y)[int(k)]), slow.state[k], slack) << x << "," << y;
        ASSERT_NEAR(double(fast.resolved.history.color.at(x, y)[int(k)]), merged.color[k], slack) << x << "," << y;
      }
    }
}

TEST(TwoSided, AgreesWithItsSlowTwin) {
  Workers workers(2);
  unsigned seed = 40;
  for (const Settings& s : many_settings()) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Window first{-3, 5, 34, 28}, second{2, 3, 43, 24};  // odd sizes; the window moves
    const test::NoiseOptions noise{
        ++seed, seed % 2 ? 0.03 : 0.0, 3, 0.05, s.recursive.disocclusion == Disocclusion::depth, 1};
    test::NoiseOptions before = noise, after = noise;
    before.seed += 1000;
    after.seed += 2000;
    const History one = side(noise_present(first, before, workers), {}, s, workers).state;
    const History past = side(noise_present(first, noise, workers), one, s, workers).state;
    const History next = side(noise_present(first, after, workers), {}, s, workers).state;
    const StrictSide future = side(noise_present(second, before, workers), next, s, workers).strict;
    expect_twin(noise_present(second, noise, workers), past, future, s, workers);
    expect_twin(noise_present(second, noise, workers), {}, future, s, workers);
  }
}

TEST(TwoSided, ReversedTimeGivesTheSameBits) {
  Workers workers(2);
  const Window w{0, 0, 35, 23};
  for (const Settings& s : many_settings()) {
    const test::NoiseOptions noise{90, 0.02, 3, 0.05, s.recursive.disocclusion == Disocclusion::depth, 1};
    std::vector<Frame> frames = noise_frames(7, w, noise, workers);
    const std::vector<Accumulated> onward = resolve_all(frames, s, workers);
    std::reverse(frames.begin(), frames.end());
    for (Frame& frame : frames) std::swap(frame.present.motion, frame.forward);
    const std::vector<Accumulated> reversed = resolve_all(frames, s, workers);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Accumulated &a = onward[i], &b = reversed[frames.size() - 1 - i];
      EXPECT_TRUE(same_bits(a.history.color, b.history.color)) << "frame " << i;
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) {
          ASSERT_EQ(a.history.spread.at(x, y), b.history.spread.at(x, y));
          ASSERT_EQ(a.diagnostics.count_past.at(x, y), b.diagnostics.count_future.at(x, y));
          ASSERT_EQ(a.diagnostics.reject.at(x, y), b.diagnostics.reject_future.at(x, y));
        }
    }
  }
}

TEST(TwoSided, HoldsTwiceTheSamplesOfOneSideWithoutLag) {
  Workers workers(1);
  const Window w{0, 0, 3, 3};
  std::vector<Frame> ramp;
  for (int i = 0; i <= 300; ++i) {
    ramp.push_back({flat_present(w, glm::vec4(float(i), float(i), float(i), 1.0f), workers), {}});
  }
  const Settings s = plain_sums();
  const std::vector<Accumulated> resolved = resolve_all(ramp, s, workers);
  const Accumulated& middle = resolved[150];
  // (1 + b)^3 / ((1 - b) (1 + b^2)) of weights b^|k|; one side alone has (1 + b) / (1 - b).
  EXPECT_NEAR(1 / double(middle.history.spread.at(1, 1)), 37.9, 0.01);
  EXPECT_NEAR(double(middle.diagnostics.count_past.at(1, 1)), 19.0, 0.01);
  EXPECT_NEAR(double(middle.diagnostics.count_future.at(1, 1)), 19.0, 0.01);
  EXPECT_NEAR(double(middle.diagnostics.weight.at(1, 1)), 18.0 / 19.0, 1e-6);
  EXPECT_NEAR(double(middle.history.color.at(1, 1).r), 150.0, 1e-3);
  History h;
  for (int i = 0; i <= 150; ++i)
    h = accumulate(ramp[std::size_t(i)].present, h, s.recursive, s.rectify, {}, 1, {}, workers).history;
  EXPECT_NEAR(double(h.color.at(1, 1).r), 141.0, 1e-3) << "one side lags by b / a frames";
}

TEST(TwoSided, TheFrameAfterACutIsAsSteadyAsAnyOther) {
  Workers workers(2);
  const Window w{0, 0, 96, 96};
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0, 1);
  const Settings s = plain_sums();
  std::vector<Present> frames;  // from the cut on; before it another shot
  for (int i = 0; i < 60; ++i) {
    Present p;
    p.color = Plane<glm::vec4>(w, kPresentBorder);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) p.color.at(x, y) = {normal(random), normal(random), normal(random), 1.0f};
    sanitize(p, workers);
    frames.push_back(std::move(p));
  }
  History state;
  for (std::size_t i = frames.size(); i-- > 1;) state = side(frames[i], state, s, workers).state;
  const StrictSide future = side(frames[0], state, s, workers).strict;
  const Accumulated first = both(frames[0], {}, future, s, workers).resolved;
  const auto moments = [&](const Plane<glm::vec4>& color) {
    double sum = 0, squares = 0;
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x)
        for (int k = 0; k < 3; ++k) {
          const double v = double(color.at(x, y)[k]);
          sum += v;
          squares += v * v;
        }
    const double n = 3.0 * double(w.pixels());
    return std::pair(sum / n, squares / n);
  };
  const auto [bias, variance] = moments(first.history.color);
  EXPECT_NEAR(variance, 0.0526, 0.002);
  EXPECT_NEAR(bias, 0, 0.01);
  EXPECT_NEAR(double(first.history.spread.at(5, 5)), 0.0526, 1e-3) << "predicted";
  const Accumulated one_sided = accumulate(frames[0], {}, s.recursive, s.rectify, {}, 1, {}, workers);
  EXPECT_NEAR(moments(one_sided.history.color).second, 1.0, 0.03);
  EXPECT_EQ(first.diagnostics.reject.at(5, 5), unsigned(kRejectCut));
  EXPECT_EQ(first.diagnostics.reject_future.at(5, 5), 0u);
  EXPECT_EQ(first.diagnostics.count_past.at(5, 5), 0.0f);
}

/// Mean squared error of (Wf f + s + W' g) / (Wf + 1 + W'), all unbiased but g; each of variance 1 / its weight.
double merged_error(double weight, double bias, bool discount) {
  const double other = discount ? discounted_weight(weight, bias * bias) : weight;
  const double total = weight + 1 + other;
  const double variance = (weight + 1 + other * other / weight) / (total * total);
  return variance + (other * bias / total) * (other * bias / total);
}

TEST(TwoSided, ADiscountedSideIsNeverWorseThanNone) {
  // Bias in standard deviations of one sample, weight 9 on both sides.
  const double biases[] = {0, 0.5, 1, 2}, plain[] = {0.053, 0.109, 0.278, 0.949},
               discounted[] = {0.053, 0.078, 0.092, 0.098};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(merged_error(9, biases[i], false), plain[i], 2e-3);
    EXPECT_NEAR(merged_error(9, biases[i], true), discounted[i], 1e-3);
  }
  for (const double weight : {0.5, 3.0, 9.0, 100.0})
    for (double bias = 0; bias < 50; bias += 0.1)
      EXPECT_LT(merged_error(weight, bias, true), 1 / (1 + weight)) << weight << " " << bias;
}

TEST(TwoSided, ASideThatHadToBeClippedLosesItsWeight) {
  Workers workers(2);
  const Window w{0, 0, 64, 64};
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, 1);
  const auto noise = [&](float mean, float sigma) {
    Plane<glm::vec4> color(w, kPresentBorder);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x)
        color.at(x, y) = {mean + sigma * normal(random), mean + sigma * normal(random), mean + sigma * normal(random),
                          1.0f};
    return color;
  };
  Present present;
  present.color = noise(0, 1);
  sanitize(present, workers);
  const auto history = [&](float bias) {
    History h;
    h.color = noise(bias, 1.0f / 3);
    h.total = Plane<float>(w, 0, 9.0f);
    h.spread = Plane<float>(w, 0, 1.0f / 9);
    h.rows_valid.assign(64, 1);
    return h;
  };
  const auto error = [&](const Accumulated& a) {
    double sum = 0;
    for (int y = 2; y < w.y1 - 2; ++y)
      for (int x = 2; x < w.x1 - 2; ++x)
        for (int k = 0; k < 3; ++k) sum += double(a.history.color.at(x, y)[k]) * double(a.history.color.at(x, y)[k]);
    return sum / (3 * 60 * 60);
  };
  Settings s, plain;
  plain.rectify.clip_discount = false;
  const History past = history(0);
  const StrictSide nothing = side(present, {}, s, workers).strict;
  const double alone = error(both(present, past, nothing, s, workers).resolved);
  for (const float bias : {3.0f, 6.0f, 100.0f}) {
    const History future = history(bias);
    const double discounted = error(both(present, past, side(present, future, s, workers).strict, s, workers).resolved);
    const double kept =
        error(both(present, past, side(present, future, plain, workers).strict, plain, workers).resolved);
    EXPECT_LT(discounted, alone * 1.05) << bias;
    EXPECT_GT(kept, alone * 1.5) << bias << ": clipping alone does not help enough";
  }
}

TEST(TwoSided, ConstantInConstantOutExactly) {
  Workers workers(1);
  const Window w{0, 0, 19, 11};
  for (const float value : {1.0f, 0.1f, 3.0e-39f, 1e-30f, 65504.0f, 1e30f, 3e38f, -0.7f, 0.0f})
    for (const Settings& s : many_settings()) {
      const glm::vec4 color(value, value * 0.3f, value * 0.77f, 1.0f);
      std::vector<Frame> frames = noise_frames(4, w, {5, 0, 3, 0.05, false, 1}, workers);
      for (Frame& frame : frames) {
        Plane<glm::vec2> motion = std::move(frame.present.motion);
        frame.present = flat_present(w, color, workers);
        frame.present.motion = std::move(motion);
      }
      // A hole in one frame: there the sides speak alone.
      frames[2].present.color.at(9, 5).r = std::numeric_limits<float>::quiet_NaN();
      sanitize(frames[2].present, workers);
      for (const Accumulated& a : resolve_all(frames, s, workers))
        for (int y = 0; y < w.y1; ++y)
          for (int x = 0; x < w.x1; ++x)
            for (int k = 0; k < 4; ++k)
              ASSERT_EQ(a.history.color.at(x, y)[k], color[k]) << value << " " << x << "," << y;
    }
}

TEST(TwoSided, ScalingTheLightByAPowerOfTwoScalesTheResultBitForBit) {
  Workers workers(1);
  const Window w{0, 0, 33, 21};
  for (const Settings& s : many_settings())
    for (const float scale : {2.0f, 1048576.0f, 9.5367431640625e-07f}) {
      const test::NoiseOptions noise{5, 0, 3, 0.02, s.recursive.disocclusion == Disocclusion::depth, 1};
      std::vector<Frame> plain = noise_frames(4, w, noise, workers), scaled = noise_frames(4, w, noise, workers);
      for (Frame& frame : scaled)
        for (int y = 0; y < w.y1; ++y)
          for (int x = 0; x < w.x1; ++x)
            for (int k = 0; k < 3; ++k) frame.present.color.at(x, y)[k] *= scale;
      const std::vector<Accumulated> a = resolve_all(plain, s, workers), b = resolve_all(scaled, s, workers);
      for (std::size_t i = 0; i < a.size(); ++i)
        for (int y = 0; y < w.y1; ++y)
          for (int x = 0; x < w.x1; ++x) {
            for (int k = 0; k < 3; ++k)
              ASSERT_EQ(b[i].history.color.at(x, y)[k], a[i].history.color.at(x, y)[k] * scale) << scale;
            ASSERT_EQ(b[i].history.total.at(x, y), a[i].history.total.at(x, y));
          }
    }
}

TEST(TwoSided, BadSamplesAndExtremesStayFiniteAndWhereTheyAre) {
  Workers workers(2);
  const Window w{0, 0, 23, 17};
  const float values[] = {FLT_MAX, -FLT_MAX, 1.7e38f, 65504.0f, -65504.0f, 1e30f, 1e-38f, 1e-45f, -0.0f, 0.0f};
  for (const Settings& s : many_settings()) {
    std::vector<Frame> frames = noise_frames(4, w, {70, 0.1, 3, 0.1, false, 1}, workers);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x)
          for (int k = 0; k < 3; ++k)
            frames[i].present.color.at(x, y)[k] = values[(std::size_t(x * 7 + y * 3 + k * 5) + i) % 10];
      frames[i].present.color.at(4, 4).g = std::numeric_limits<float>::infinity();
      sanitize(frames[i].present, workers);
    }
    for (const Accumulated& a : resolve_all(frames, s, workers))
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) {
          for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(a.history.color.at(x, y)[k]));
          ASSERT_TRUE(std::isfinite(a.history.total.at(x, y)));
          ASSERT_TRUE(std::isfinite(a.diagnostics.count_past.at(x, y)));
        }
  }
  // One bad sample among good ones touches its own pixel only, which the sides then fill.
  const Settings s = plain_sums();
  std::vector<Frame> good = noise_frames(3, w, {8, 0, 0, 0, false, 1}, workers),
                     bad = noise_frames(3, w, {8, 0, 0, 0, false, 1}, workers);
  bad[1].present.color.at(7, 7).r = std::numeric_limits<float>::quiet_NaN();
  sanitize(bad[1].present, workers);
  const std::vector<Accumulated> a = resolve_all(good, s, workers), b = resolve_all(bad, s, workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x)
      if (x != 7 || y != 7) {
        ASSERT_EQ(a[1].history.color.at(x, y), b[1].history.color.at(x, y));
      }
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(double(b[1].history.color.at(7, 7)[k]),
                double(good[0].present.color.at(7, 7)[k]) / 2 + double(good[2].present.color.at(7, 7)[k]) / 2,
                1e-5 * std::abs(double(b[1].history.color.at(7, 7)[k])));
}

TEST(TwoSided, ThreadsAndProcessorsDoNotChangeAByte) {
  Workers one(1), many(5);
  const Window w{0, 0, 97, 53};
  const test::NoiseOptions noise{7, 0.02, 4, 0.02, false, 1};
  const Present present = noise_present(w, noise, one);
  const Settings s;
  const History h = side(present, {}, s, one).state;
  const StrictSide future = side(present, h, s, one).strict;
  const auto run = [&](Workers& workers, Isa isa) {
    return accumulate_both(present, h, future, s.recursive, s.rectify, {}, 1, kAll, workers, isa).resolved;
  };
  const Accumulated a = run(one, Isa::baseline);
  EXPECT_TRUE(same_bits(a.history.color, run(many, Isa::baseline).history.color));
  EXPECT_TRUE(same_bits(a.history.color, run(many, Isa::avx2).history.color));
}

TEST(TwoSided, AlphaOfOneLeavesThePresentAsItIs) {
  Workers workers(1);
  const Window w{0, 0, 13, 9};
  Settings s;
  s.recursive.alpha = 1;
  std::vector<Frame> frames = noise_frames(3, w, {3, 0, 2, 0, false, 1}, workers);
  const std::vector<Accumulated> resolved = resolve_all(frames, s, workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) EXPECT_EQ(resolved[1].history.color.at(x, y), frames[1].present.color.at(x, y));
}

TEST(TwoSided, SmallestWindows) {
  Workers workers(3);
  for (const Window w : {Window{0, 0, 0, 0}, Window{4, 4, 5, 5}, Window{0, 0, 1, 9}, Window{-2, 0, 7, 1}}) {
    const Settings s;
    if (w.empty()) {
      EXPECT_TRUE(side(Present{}, {}, s, workers).state.color.empty());
      continue;
    }
    std::vector<Frame> frames = noise_frames(3, w, {3, 0, 2, 0, false, 1}, workers);
    EXPECT_EQ(resolve_all(frames, s, workers).size(), 3u);
  }
}

TEST(TwoSided, LooksAheadAsFarAsHoldsNinetyNinePercent) {
  EXPECT_EQ(look_ahead_frames({}, 0.1), 44);
  EXPECT_EQ(look_ahead_frames({}, 0.05), 90);
  EXPECT_EQ(look_ahead_frames({}, 1), 1);
  EXPECT_EQ(look_ahead_frames({}, 1e-9), 10000);
  TwoSidedParameters asked;
  asked.look_ahead = 7;
  EXPECT_EQ(look_ahead_frames(asked, 0.1), 7);
}

}  // namespace
}  // namespace varve
