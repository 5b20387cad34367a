// The recursive accumulator: its slow twin, and the laws it obeys.
#include "resolve/accumulate.h"

#include <gtest/gtest.h>

#include <cfloat>

#include "base/reject.h"
#include "reference/accumulate_reference.h"
#include "resolve/sample_weights.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::next_history;
using test::noise_present;
using test::same_bits;

constexpr DiagnosticsWanted kAll{true, true, true};

bool all_finite(const Plane<glm::vec4>& color) {
  const Window& w = color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      for (int k = 0; k < 4; ++k)
        if (!std::isfinite(color.at(x, y)[k])) return false;
  return true;
}

void expect_twin(const Present& present, const History& previous, const RecursiveParameters& recursive,
                 const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, Workers& workers) {
  const Accumulated fast = accumulate(present, previous, recursive, rectify, jitter, kRejectCut, kAll, workers);
  const Window& w = present.color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const reference::Pixel slow =
          reference::accumulate_pixel(present, previous, recursive, rectify, jitter, kRejectCut, x, y);
      // Rounding is that of floats of the size of the colors around.
      double size = 1e-30;
      for (int j = -3; j <= 3; ++j)
        for (int i = -3; i <= 3; ++i)
          if (w.contains(x + i, y + j))
            for (int k = 0; k < 4; ++k) size = std::max(size, std::abs(double(present.color.at(x + i, y + j)[k])));
      for (std::size_t k = 0; k < 4; ++k) {
        const double history_size = std::abs(slow.color[k]);
        ASSERT_NEAR(double(fast.history.color.at(x, y)[int(k)]), slow.color[k], 2e-6 * std::max(size, history_size))
            << "pixel " << x << "," << y << " channel " << k;
      }
      ASSERT_EQ(fast.diagnostics.reject.at(x, y), slow.reject) << x << "," << y;
      ASSERT_NEAR(double(fast.history.total.at(x, y)), slow.total, 1e-5 * std::max(1.0, slow.total));
      ASSERT_NEAR(double(fast.history.spread.at(x, y)), slow.spread, 1e-6);
      ASSERT_NEAR(double(fast.diagnostics.weight.at(x, y)), slow.weight, 1e-6);
      ASSERT_NEAR(double(fast.diagnostics.clip.at(x, y)), slow.clip, 1e-4) << x << "," << y;
    }
}

struct TwinCase {
  const char* name;
  RecursiveParameters recursive;
  RectifyParameters rectify;
  test::NoiseOptions noise;
};

std::vector<TwinCase> twin_cases() {
  std::vector<TwinCase> cases;
  unsigned seed = 10;
  for (const HistoryFilter filter :
       {HistoryFilter::bilinear, HistoryFilter::catmull_rom, HistoryFilter::catmull_rom9, HistoryFilter::catmull_rom5})
    for (const bool dering : {true, false}) {
      TwinCase c{"filter", {}, {}, {}};
      c.recursive.history_filter = filter;
      c.recursive.dering = dering;
      c.noise.seed = ++seed;
      cases.push_back(c);
    }
  for (const Box box : {Box::none, Box::minmax, Box::variance, Box::variance_minmax})
    for (const BoxRule rule : {BoxRule::clip, BoxRule::clamp})
      for (const BoxSpace space : {BoxSpace::rgb, BoxSpace::ycocg}) {
        TwinCase c{"box", {}, {}, {}};
        c.rectify.box = box;
        c.rectify.rule = rule;
        c.rectify.space = space;
        c.rectify.gamma = 0.75;
        c.noise.seed = ++seed;
        c.noise.bad_share = 0.03;
        c.noise.bad_motion = 0.05;
        cases.push_back(c);
      }
  for (const int window : {5, 7}) {
    TwinCase c{"window", {}, {}, {}};
    c.rectify.window = window;
    c.rectify.anchor = BoxAnchor::mean;
    c.noise.seed = ++seed;
    c.noise.bad_share = 0.01;
    cases.push_back(c);
  }
  for (const SampleFilter filter :
       {SampleFilter::tent, SampleFilter::gaussian, SampleFilter::blackman_harris, SampleFilter::mitchell}) {
    TwinCase c{"samples", {}, {}, {}};
    c.recursive.sample_filter = filter;
    c.recursive.alpha_rule = seed % 2 ? AlphaRule::fixed : AlphaRule::mean;
    c.noise.seed = ++seed;
    c.noise.bad_share = 0.05;
    cases.push_back(c);
  }
  TwinCase depth{"depth", {}, {}, {}};
  depth.recursive.disocclusion = Disocclusion::depth;
  depth.noise.with_depth = true;
  depth.noise.seed = ++seed;
  cases.push_back(depth);
  // Rejection, each test by itself and then together, with everything it may do.
  const auto add_reject = [&](const char* name, auto set) {
    for (const OnReject then : {OnReject::restart, OnReject::blur, OnReject::weight}) {
      TwinCase c{name, {}, {}, {}};
      c.recursive.reject.on_reject = then;
      c.noise = {++seed, 0.02, 3, 0.03, true, 1, true};
      c.recursive.weight.reactive = 0;
      set(c.recursive);
      cases.push_back(c);
    }
  };
  add_reject("slope", [](RecursiveParameters& p) {
    p.disocclusion = Disocclusion::depth;
    p.reject.depth_slope = 1.5;
  });
  add_reject("normal", [](RecursiveParameters& p) { p.reject.normal_angle = 25; });
  add_reject("id", [](RecursiveParameters& p) { p.reject.id = IdTest::hard; });
  add_reject("soft id", [](RecursiveParameters& p) { p.reject.id = IdTest::soft; });
  add_reject("speed", [](RecursiveParameters& p) { p.reject.speed = 0.8; });
  add_reject("direction", [](RecursiveParameters& p) { p.reject.direction = 50; });
  add_reject("acceleration", [](RecursiveParameters& p) {
    p.reject.acceleration = 5;
    p.reject.acceleration_low = 1;
  });
  add_reject("all tests", [](RecursiveParameters& p) {
    p.disocclusion = Disocclusion::depth;
    p.reject.depth_slope = 1;
    p.reject.normal_angle = 40;
    p.reject.id = IdTest::soft;
    p.reject.acceleration = 6;
    p.weight.reactive = 0.8;
    p.sample_filter = SampleFilter::tent;
  });
  const auto add_weight = [&](const char* name, auto set) {
    for (const AlphaRule rule : {AlphaRule::fixed, AlphaRule::mean}) {
      TwinCase c{name, {}, {}, {}};
      c.recursive.alpha_rule = rule;
      c.noise.seed = ++seed;
      c.noise.bad_share = 0.02;
      set(c.recursive.weight, c.noise);
      cases.push_back(c);
    }
  };
  add_weight("luma", [](WeightParameters& p, auto&) { p.feedback = Feedback::luma; });
  add_weight("speed alpha", [](WeightParameters& p, auto&) { p.speed_alpha = 0.7, p.full_speed = 4; });
  add_weight("anti-flicker", [](WeightParameters& p, auto&) { p.anti_flicker = 0.9; });
  add_weight("masks", [](WeightParameters& p, auto& noise) { p.reactive = 0.9, noise.with_marks = true; });
  add_weight("all weights", [](WeightParameters& p, auto& noise) {
    p.feedback = Feedback::luma;
    p.speed_alpha = 0.4;
    p.anti_flicker = 1;
    noise.with_marks = true;
  });
  return cases;
}

/// Weighing by brightness: these scale with the light only if the exposure follows.
std::vector<TwinCase> weighing_cases() {
  std::vector<TwinCase> cases;
  unsigned seed = 500;
  for (const Weighing weighing : {Weighing::luminance, Weighing::logarithm})
    for (const double exposure : {0.0, -3.0}) {
      TwinCase c{"weighing", {}, {}, {}};
      c.recursive.weight.weighing = weighing;
      c.recursive.weight.exposure = exposure;
      c.noise.seed = ++seed;
      c.noise.bad_share = 0.02;
      cases.push_back(c);
    }
  return cases;
}

std::vector<TwinCase> all_cases() {
  std::vector<TwinCase> cases = twin_cases();
  for (const TwinCase& c : weighing_cases()) cases.push_back(c);
  return cases;
}

TEST(Accumulate, AgreesWithItsSlowTwin) {
  Workers workers(2);
  for (const TwinCase& c : all_cases()) {
    SCOPED_TRACE(std::string(c.name) + " seed " + std::to_string(c.noise.seed));
    const Window first{-3, 5, 34, 28}, second{2, 3, 43, 24};  // odd sizes; the window moves
    test::NoiseOptions before = c.noise;
    before.seed += 1000;
    const glm::dvec2 jitter(0.31, -0.22);
    const Present earlier = noise_present(first, before, workers);
    const History one = accumulate(earlier, {}, c.recursive, c.rectify, jitter, 1, {}, workers).history;
    const Present middle = noise_present(first, before, workers);
    const History two = accumulate(middle, one, c.recursive, c.rectify, jitter, 1, {}, workers).history;
    expect_twin(noise_present(second, c.noise, workers), two, c.recursive, c.rectify, jitter, workers);
  }
}

TEST(Accumulate, PredictionAgreesWithItsSlowTwinAndOwesNothingToThePresentPixel) {
  Workers workers(2);
  const Window w{0, 0, 37, 23};
  for (const TwinCase& c : twin_cases()) {
    SCOPED_TRACE(std::string(c.name) + " seed " + std::to_string(c.noise.seed));
    test::NoiseOptions before = c.noise;
    before.seed += 1000;
    const History h = next_history(noise_present(w, before, workers), {}, c.recursive, c.rectify, workers);
    const Present present = noise_present(w, c.noise, workers);
    const History fast = predict(present, h, c.recursive, c.rectify, workers);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) {
        const reference::Pixel slow = reference::predict_pixel(present, h, c.recursive, c.rectify, x, y);
        ASSERT_EQ(fast.total.at(x, y) > 0, slow.total > 0) << x << "," << y;
        for (std::size_t k = 0; k < 4; ++k)
          ASSERT_NEAR(double(fast.color.at(x, y)[int(k)]), slow.color[k], 2e-6 * (300 + std::abs(slow.color[k])))
              << x << "," << y;
      }
    Present other = noise_present(w, c.noise, workers);
    other.color.at(18, 11) = glm::vec4(65504.0f);
    other.valid.at(18, 11) = present.valid.at(18, 11);
    EXPECT_EQ(predict(other, h, c.recursive, c.rectify, workers).color.at(18, 11), fast.color.at(18, 11));
  }
}

TEST(Accumulate, BothProcessorsGiveTheSameBits) {
  Workers workers(2);
  for (const TwinCase& c : all_cases()) {
    const Window w{0, 0, 61, 37};
    const Present a = noise_present(w, c.noise, workers);
    const History h = next_history(a, {}, c.recursive, c.rectify, workers);
    const Accumulated slow =
        accumulate(a, h, c.recursive, c.rectify, glm::dvec2(.2, .1), 1, kAll, workers, Isa::baseline);
    const Accumulated fast = accumulate(a, h, c.recursive, c.rectify, glm::dvec2(.2, .1), 1, kAll, workers, Isa::avx2);
    EXPECT_TRUE(same_bits(slow.history.color, fast.history.color)) << c.name;
    for (int y = 0; y < w.y1; ++y) {
      EXPECT_EQ(0, std::memcmp(slow.diagnostics.clip.row(y), fast.diagnostics.clip.row(y), sizeof(float) * 61));
      EXPECT_EQ(0, std::memcmp(slow.history.spread.row(y), fast.history.spread.row(y), sizeof(float) * 61));
    }
  }
}

TEST(Accumulate, ThreadsDoNotChangeAByte) {
  Workers one(1), many(5);
  const Window w{0, 0, 97, 53};
  const glm::dvec2 jitter(-0.4, 0.3);
  for (const TwinCase& c : all_cases()) {
    const Present present = noise_present(w, c.noise, one);
    const History h = next_history(present, {}, c.recursive, c.rectify, one);
    const Accumulated a = accumulate(present, h, c.recursive, c.rectify, jitter, 1, kAll, one);
    const Accumulated b = accumulate(present, h, c.recursive, c.rectify, jitter, 1, kAll, many);
    EXPECT_TRUE(same_bits(a.history.color, b.history.color)) << c.name;
    EXPECT_EQ(a.counts.rejected, b.counts.rejected) << c.name;
    EXPECT_EQ(a.counts.restarted, b.counts.restarted) << c.name;
  }
}

TEST(Accumulate, ConstantInConstantOutExactly) {
  Workers workers(1);
  const Window w{0, 0, 19, 11};
  for (const float value : {1.0f, 0.1f, 3.0e-39f, 1e-30f, 65504.0f, 1e30f, 3e38f, -0.7f, 0.0f})
    for (const TwinCase& c : all_cases()) {
      const glm::vec4 color(value, value * 0.3f, value * 0.77f, 1.0f);
      Present present = flat_present(w, color, workers);
      present.motion = noise_present(w, c.noise, workers).motion;
      History h;
      for (int frame = 0; frame < 5; ++frame) h = next_history(present, h, c.recursive, c.rectify, workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x)
          for (int k = 0; k < 4; ++k)
            ASSERT_EQ(h.color.at(x, y)[k], color[k]) << c.name << " " << value << " at " << x << "," << y;
    }
}

TEST(Accumulate, StillSceneConvergesToTheMean) {
  Workers workers(1);
  const Window w{0, 0, 9, 7};
  RecursiveParameters recursive;
  recursive.alpha = 1e-6;
  RectifyParameters rectify;
  rectify.box = Box::none;
  History h;
  std::vector<double> sum(w.pixels(), 0.0);
  const int frames = 300;
  for (int f = 0; f < frames; ++f) {
    Present p = noise_present(w, {unsigned(f + 1), 0, 0, 0, false, 1}, workers);
    p.motion = {};
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) sum[std::size_t(y * 9 + x)] += double(p.color.at(x, y).g);
    h = next_history(p, h, recursive, rectify, workers);
  }
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) {
      const double mean = sum[std::size_t(y * 9 + x)] / frames;
      EXPECT_NEAR(double(h.color.at(x, y).g), mean, 1e-5 * mean);
      EXPECT_NEAR(1 / double(h.spread.at(x, y)), frames, 1e-2);  // every frame counts the same
    }
}

TEST(Accumulate, ScalingTheLightByAPowerOfTwoScalesTheResultBitForBit) {
  Workers workers(1);
  const Window w{0, 0, 33, 21};
  for (const TwinCase& c : twin_cases())
    for (const float scale : {2.0f, 0.5f, 1048576.0f, 9.5367431640625e-07f}) {
      const Present plain = noise_present(w, c.noise, workers);
      Present scaled = noise_present(w, c.noise, workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x)
          for (int k = 0; k < 3; ++k) scaled.color.at(x, y)[k] *= scale;
      const History h1 = next_history(plain, {}, c.recursive, c.rectify, workers);
      const History h2 = next_history(scaled, {}, c.recursive, c.rectify, workers);
      const Accumulated a = accumulate(plain, h1, c.recursive, c.rectify, glm::dvec2(.1, .2), 1, kAll, workers);
      const Accumulated b = accumulate(scaled, h2, c.recursive, c.rectify, glm::dvec2(.1, .2), 1, kAll, workers);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) {
          for (int k = 0; k < 3; ++k)
            ASSERT_EQ(b.history.color.at(x, y)[k], a.history.color.at(x, y)[k] * scale) << c.name << " " << scale;
          ASSERT_EQ(b.diagnostics.clip.at(x, y), a.diagnostics.clip.at(x, y)) << c.name;
        }
    }
}

TEST(Accumulate, FarPixelsHaveNoInfluence) {
  Workers workers(1);
  const Window w{0, 0, 41, 31};
  RecursiveParameters recursive;
  recursive.sample_filter = SampleFilter::blackman_harris;
  const glm::dvec2 jitter(0.3, 0.3);
  test::NoiseOptions noise{3, 0, 0, 0, false, 1};
  const Present a = noise_present(w, noise, workers);
  Present b = noise_present(w, noise, workers);
  const History h = next_history(a, {}, recursive, {}, workers);
  b.color.at(20, 15) = glm::vec4(65504.0f);  // one bright pixel, and one that is no number
  b.color.at(21, 15).g = std::numeric_limits<float>::quiet_NaN();
  sanitize(b, workers);
  const Accumulated x1 = accumulate(a, h, recursive, {}, jitter, 1, {}, workers);
  const Accumulated x2 = accumulate(b, h, recursive, {}, jitter, 1, {}, workers);
  EXPECT_TRUE(all_finite(x2.history.color));
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) {
      if (x >= 18 && x <= 23 && y >= 13 && y <= 17) continue;
      for (int k = 0; k < 4; ++k)
        ASSERT_EQ(x1.history.color.at(x, y)[k], x2.history.color.at(x, y)[k]) << x << "," << y;
    }
}

// Filters of four and six taps once fell back to two along the whole row of a pixel that never had data.
TEST(Accumulate, APixelWithoutHistoryIsNoMatterOfItsRow) {
  Workers workers(1);
  const Window w{0, 0, 48, 15};
  for (const HistoryFilter filter : {HistoryFilter::bilinear, HistoryFilter::catmull_rom, HistoryFilter::catmull_rom9,
                                     HistoryFilter::catmull_rom5, HistoryFilter::cubic}) {
    RecursiveParameters recursive;
    recursive.history_filter = filter;
    const test::NoiseOptions noise{5, 0, 0.8, 0, false, 1};
    const Present good = noise_present(w, noise, workers), next = noise_present(w, {6, 0, 0.8, 0, false, 1}, workers);
    Present bad = noise_present(w, noise, workers);
    bad.color.at(8, 7).g = std::numeric_limits<float>::quiet_NaN();
    sanitize(bad, workers);
    const History one = next_history(next, next_history(good, {}, recursive, {}, workers), recursive, {}, workers);
    const History other = next_history(next, next_history(bad, {}, recursive, {}, workers), recursive, {}, workers);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) {
        if (std::abs(x - 8) <= 4 && std::abs(y - 7) <= 4) continue;
        ASSERT_EQ(one.color.at(x, y), other.color.at(x, y)) << x << "," << y;
      }
  }
}

TEST(Accumulate, BadPixelsKeepTheirHistoryAndSpreadNowhere) {
  Workers workers(1);
  const Window w{0, 0, 15, 15};
  const Present good = noise_present(w, {5, 0, 0, 0, false, 1}, workers);
  Present bad = noise_present(w, {5, 0, 0, 0, false, 1}, workers);
  bad.color.at(7, 7).r = std::numeric_limits<float>::infinity();
  sanitize(bad, workers);
  EXPECT_EQ(bad.not_finite, 1u);
  RectifyParameters no_box;
  no_box.box = Box::none;
  const History h = next_history(good, {}, {}, no_box, workers);
  const Accumulated now = accumulate(bad, h, {}, no_box, {}, 1, kAll, workers);
  EXPECT_EQ(now.history.color.at(7, 7), h.color.at(7, 7));
  EXPECT_EQ(now.diagnostics.reject.at(7, 7), unsigned(kRejectPresent));
  EXPECT_EQ(now.history.total.at(7, 7), h.total.at(7, 7));
  // Without history the neighbors' mean stands in, and the next frame does not build on it.
  const Accumulated first = accumulate(bad, {}, {}, no_box, {}, kRejectFirstFrame, kAll, workers);
  EXPECT_EQ(first.history.total.at(7, 7), 0.0f);
  EXPECT_TRUE(all_finite(first.history.color));
  const Accumulated second = accumulate(good, first.history, {}, no_box, {}, 1, kAll, workers);
  EXPECT_EQ(second.diagnostics.reject.at(7, 7), unsigned(kRejectEmptyHistory));
  EXPECT_EQ(second.history.color.at(7, 7), good.color.at(7, 7));
}

TEST(Accumulate, ExtremeValuesStayFinite) {
  Workers workers(1);
  const Window w{0, 0, 23, 17};
  for (const TwinCase& c : all_cases()) {
    Present p = noise_present(w, c.noise, workers);
    const float values[] = {FLT_MAX, -FLT_MAX, 1.7e38f, 65504.0f, -65504.0f, 1e30f, 1e-38f, 1e-45f, -0.0f, 0.0f};
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x)
        for (int k = 0; k < 3; ++k) p.color.at(x, y)[k] = values[(x * 7 + y * 3 + k * 5) % 10];
    sanitize(p, workers);
    History h;
    for (int f = 0; f < 4; ++f) {
      const Accumulated a = accumulate(p, h, c.recursive, c.rectify, glm::dvec2(.3, -.4), 1, kAll, workers);
      ASSERT_TRUE(all_finite(a.history.color)) << c.name;
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) ASSERT_TRUE(std::isfinite(a.diagnostics.clip.at(x, y)));
      h = accumulate(p, h, c.recursive, c.rectify, glm::dvec2(.3, -.4), 1, kAll, workers).history;
    }
  }
}

TEST(Accumulate, SmallestWindows) {
  Workers workers(3);
  for (const Window w :
       {Window{0, 0, 0, 0}, Window{4, 4, 5, 5}, Window{0, 0, 1, 9}, Window{-2, 0, 7, 1}, Window{0, 0, 2, 2}})
    for (const TwinCase& c : all_cases()) {
      if (w.empty()) {
        EXPECT_TRUE(accumulate(Present{}, {}, c.recursive, c.rectify, {}, 1, {}, workers).history.color.empty());
        continue;
      }
      const Present p = noise_present(w, c.noise, workers);
      History h;
      for (int f = 0; f < 3; ++f) h = next_history(p, h, c.recursive, c.rectify, workers);
      EXPECT_TRUE(all_finite(h.color));
    }
}

TEST(Accumulate, AtRestTheFetchIsTheHistoryItself) {
  Workers workers(1);
  const Window w{0, 0, 21, 15};
  const Present p = noise_present(w, {5, 0, 0, 0, false, 1}, workers);
  for (const HistoryFilter filter : {HistoryFilter::bilinear, HistoryFilter::catmull_rom, HistoryFilter::catmull_rom9,
                                     HistoryFilter::catmull_rom5}) {
    RecursiveParameters recursive;
    recursive.history_filter = filter;
    RectifyParameters none;
    none.box = Box::none;
    const History h = next_history(p, {}, recursive, none, workers);
    Present same = noise_present(w, {5, 0, 0, 0, false, 1}, workers);
    same.motion = {};
    EXPECT_TRUE(same_bits(next_history(same, h, recursive, none, workers).color, h.color));
  }
}

TEST(Accumulate, IntegerMotionMovesHistoryExactly) {
  Workers workers(1);
  const Window w{0, 0, 24, 18};
  const Present p = noise_present(w, {9, 0, 0, 0, false, 1}, workers);
  const History h = next_history(p, {}, {}, {}, workers);
  Present moved;  // the picture goes 3 right and 2 down
  moved.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0.5f));
  moved.motion = Plane<glm::vec2>(w, 0, glm::vec2(-3, -2));
  for (int y = 2; y < w.y1; ++y)
    for (int x = 3; x < w.x1; ++x) moved.color.at(x, y) = p.color.at(x - 3, y - 2);
  sanitize(moved, workers);
  const Accumulated a = accumulate(moved, h, {}, {}, {}, 1, kAll, workers);
  for (int y = 2; y < w.y1; ++y)
    for (int x = 3; x < w.x1; ++x) EXPECT_NEAR(double(a.history.total.at(x, y)), 2.0, 0.0);
  EXPECT_EQ(a.diagnostics.reject.at(0, 0), unsigned(kRejectWindow));
  EXPECT_EQ(a.history.total.at(0, 0), 1.0f);
}

TEST(Accumulate, DepthRestartsWhatWasHidden) {
  Workers workers(1);
  const Window w{0, 0, 12, 12};
  RecursiveParameters recursive;
  recursive.disocclusion = Disocclusion::depth;
  Present before = flat_present(w, glm::vec4(1.0f), workers), after = flat_present(w, glm::vec4(1.0f), workers);
  before.depth = Plane<float>(w, 0, 5.0f);
  after.depth = Plane<float>(w, 0, 5.1f);
  after.depth.at(6, 6) = std::numeric_limits<float>::infinity();
  const History h = next_history(before, {}, recursive, {}, workers);
  const Accumulated a = accumulate(after, h, recursive, {}, {}, 1, kAll, workers);
  EXPECT_EQ(a.diagnostics.reject.at(6, 6), unsigned(kRejectDepth));
  EXPECT_EQ(a.history.total.at(6, 6), 1.0f);
  EXPECT_EQ(a.diagnostics.reject.at(3, 3), 0u);
  EXPECT_EQ(a.history.total.at(3, 3), 2.0f);
}

TEST(Accumulate, ClippingLeavesNothingOutsideTheBox) {
  // A black history over a white present: the box is a point, so the history must become it.
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  for (const BoxRule rule : {BoxRule::clip, BoxRule::clamp})
    for (const BoxSpace space : {BoxSpace::rgb, BoxSpace::ycocg}) {
      RectifyParameters rectify;
      rectify.rule = rule;
      rectify.space = space;
      const History black = next_history(flat_present(w, glm::vec4(0, 0, 0, 1), workers), {}, {}, rectify, workers);
      const Accumulated a =
          accumulate(flat_present(w, glm::vec4(1.0f), workers), black, {}, rectify, {}, 1, kAll, workers);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(double(a.history.color.at(4, 4)[k]), 1.0, 4e-6);
      EXPECT_NEAR(double(a.diagnostics.clip.at(4, 4)), 1.0, 1e-5);
      EXPECT_EQ(a.counts.clipped, w.pixels());
    }
}

TEST(SampleWeights, KernelsIntegrateToOneAndEndAtTheirRadius) {
  for (const SampleFilter filter :
       {SampleFilter::tent, SampleFilter::gaussian, SampleFilter::blackman_harris, SampleFilter::mitchell}) {
    double sum = 0;
    const double step = 1e-3;
    for (double x = -4 + step / 2; x < 4; x += step) sum += reconstruction_kernel(filter, x) * step;
    EXPECT_NEAR(sum, 1.0, 2e-3);
    EXPECT_EQ(reconstruction_kernel(filter, reconstruction_radius(filter)), 0.0);
    EXPECT_EQ(reconstruction_kernel(filter, std::numeric_limits<double>::quiet_NaN()), 0.0);
  }
}

}  // namespace
}  // namespace varve
