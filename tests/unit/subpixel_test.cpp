// The four sub-pixel histories: their slow twin, and the laws they obey.
#include "subpixel/accumulate_subpixel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "base/reject.h"
#include "reference/subpixel_reference.h"
#include "subpixel/carry_way.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::noise_present;
using test::same_bits;

/// Quarters in turn, each sample at another place of its quarter.
glm::dvec2 jitter_of_frame(int frame) {
  std::mt19937 random(static_cast<unsigned>(frame));
  std::uniform_real_distribution<double> quarter(-0.2499, 0.2499);
  const double x = quarter(random), y = quarter(random);
  return kQuadrantMiddle[std::size_t(frame) % kQuadrants] + glm::dvec2(x, y);
}

struct Settings {
  SubpixelParameters subpixel;
  RecursiveParameters recursive;
  RectifyParameters rectify;
  DiagnosticsWanted wanted{true, true, true, false, false, true, true};
  Settings() { rectify.box = Box::none; }
};

SubpixelStep step_on(const Present& present, SubpixelHistory history, const Settings& s, Workers& workers) {
  const Present* samples[] = {&present};
  const auto table = blur_table_for(s.subpixel, s.recursive);
  return accumulate_subpixel(samples, std::move(history), s.subpixel, s.recursive, s.rectify, table ? &*table : nullptr,
                             kRejectFirstFrame, s.wanted, workers);
}

SubpixelHistory copy_of(const SubpixelHistory& history) {
  SubpixelHistory copy;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const SubpixelBuffer& from = history.quadrants[k];
    SubpixelBuffer& to = copy.quadrants[k];
    if (from.empty()) continue;
    to.color = from.color.clone(), to.total = from.total.clone(), to.spread = from.spread.clone();
    to.moments = from.moments.clone(), to.depth = from.depth.clone(), to.id = from.id.clone();
    to.normal = from.normal.clone(), to.way = from.way.clone(), to.lag = from.lag;
    for (const Plane<glm::vec4>& plane : from.companions) to.companions.push_back(plane.clone());
  }
  return copy;
}

std::vector<Present> noise_frames(const Window& w, test::NoiseOptions noise, int count, Workers& workers) {
  std::vector<Present> frames;
  for (int i = 0; i < count; ++i) {
    ++noise.seed;
    frames.push_back(noise_present(w, noise, workers));
    frames.back().jitter = jitter_of_frame(i);
  }
  return frames;
}

std::vector<Accumulated> resolve_all(const std::vector<Present>& frames, const Settings& s, Workers& workers) {
  SubpixelHistory history;
  std::vector<Accumulated> resolved;
  for (const Present& frame : frames) {
    SubpixelStep step = step_on(frame, std::move(history), s, workers);
    history = std::move(step.history);
    resolved.push_back(std::move(step.resolved));
  }
  return resolved;
}

bool all_finite(const Plane<glm::vec4>& plane) {
  const Window& w = plane.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      for (int k = 0; k < 4; ++k)
        if (!std::isfinite(plane.at(x, y)[k])) return false;
  return true;
}

class SubpixelTwin : public testing::TestWithParam<SubpixelWeights> {};

TEST_P(SubpixelTwin, AgreesOnOddSizes) {
  Workers workers(2);
  Settings s;
  s.subpixel.weights = GetParam();
  s.subpixel.radius = 0.5625;
  s.recursive.disocclusion = Disocclusion::depth;
  s.recursive.reject.id = IdTest::hard;
  s.recursive.reject.normal_angle = 40;
  for (const Window& w : {Window{0, 0, 1, 1}, Window{3, -2, 14, 5}, Window{-7, 1, 10, 10}}) {
    test::NoiseOptions noise;
    noise.bad_share = 0.03, noise.bad_motion = 0.02, noise.with_depth = noise.with_marks = true, noise.motion = 0.8;
    SubpixelHistory history;
    for (const Present& frame : noise_frames(w, noise, 7, workers)) {
      SubpixelHistory carried = copy_of(history);
      for (SubpixelBuffer& q : carried.quadrants)
        if (!q.empty()) q.way = carry_way(q.way, frame.motion, w, workers);
      const std::size_t target = quadrant_of(*frame.jitter);
      SubpixelStep step = step_on(frame, std::move(history), s, workers);
      const SubpixelBuffer& made = step.history.quadrants[target];
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
          const reference::QuarterPixel before =
              reference::reconstructed_quarter(carried, frame, s.subpixel, s.recursive, target, x, y);
          const reference::QuarterPixel now = reference::blended_quarter(before, frame, s.recursive, target, x, y);
          ASSERT_NEAR(double(made.total.at(x, y)), now.total, 1e-5 * (1 + now.total));
          ASSERT_NEAR(double(made.spread.at(x, y)), now.spread, 1e-5);
          const reference::QuarterPixel shown =
              reference::picture_pixel(step.history, frame, s.subpixel, s.recursive, x, y);
          for (int k = 0; k < 4; ++k) {
            ASSERT_NEAR(double(made.color.at(x, y)[k]), now.color[k], 2e-5 * (1 + std::abs(now.color[k])));
            ASSERT_NEAR(double(step.resolved.history.color.at(x, y)[k]), shown.color[k],
                        2e-5 * (1 + std::abs(shown.color[k])));
          }
          if (now.known) {
            for (int k = 0; k < 3; ++k) ASSERT_NEAR(double(made.moments.at(x, y)[k]), now.moments[k], 1e-5);
          }
          ASSERT_NEAR(double(step.resolved.history.spread.at(x, y)), shown.spread, 1e-5);
          ASSERT_NEAR(double(step.resolved.history.total.at(x, y)), shown.total, 1e-5 * (1 + shown.total));
          if (shown.known) {
            ASSERT_NEAR(double(step.resolved.diagnostics.blur.at(x, y)), shown.moments.z, 1e-5);
          }
        }
      history = std::move(step.history);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Weights, SubpixelTwin,
                         testing::Values(SubpixelWeights::plain, SubpixelWeights::first_order,
                                         SubpixelWeights::bilinear));

TEST(Subpixel, AConstantStaysThatConstant) {
  Workers workers(1);
  const Window w{0, 0, 9, 7};
  const glm::vec4 color(0.1f, 65504.0f, 1e-8f, 0.3f);
  for (const SubpixelWeights weights : {SubpixelWeights::plain, SubpixelWeights::first_order,
                                        SubpixelWeights::second_order, SubpixelWeights::bilinear}) {
    Settings s;
    s.subpixel.weights = weights;
    s.recursive.blur_limit = 0.3;
    s.recursive.residual_limit = 0.2;
    SubpixelHistory history;
    for (int i = 0; i < 9; ++i) {
      Present frame = flat_present(w, color, workers);
      frame.motion = Plane<glm::vec2>(w, 0, glm::vec2(0.31f, -0.17f));
      frame.jitter = jitter_of_frame(i);
      SubpixelStep step = step_on(frame, std::move(history), s, workers);
      history = std::move(step.history);
      for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) ASSERT_EQ(step.resolved.history.color.at(x, y), color);
    }
  }
}

TEST(Subpixel, ScalesBitForBit) {
  Workers workers(2);
  const Window w{0, 0, 13, 9};
  Settings s;
  s.recursive.residual_limit = 0.1;
  s.recursive.blur_limit = 0.4;
  s.rectify.box = Box::variance;
  test::NoiseOptions noise;
  noise.motion = 1;
  const std::vector<Accumulated> one = resolve_all(noise_frames(w, noise, 9, workers), s, workers);
  for (const float scale : {0x1p-30f, 0x1p20f}) {
    noise.scale = scale;
    // Alpha of the noise is not scaled, so only light is compared.
    std::vector<Present> frames = noise_frames(w, noise, 9, workers);
    const std::vector<Accumulated> scaled = resolve_all(frames, s, workers);
    for (std::size_t i = 0; i < one.size(); ++i)
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 13; ++x) {
          ASSERT_EQ(one[i].diagnostics.residual.at(x, y), scaled[i].diagnostics.residual.at(x, y));
          for (int k = 0; k < 3; ++k)
            ASSERT_EQ(one[i].history.color.at(x, y)[k] * scale, scaled[i].history.color.at(x, y)[k]);
        }
  }
}

TEST(Subpixel, ThreadsChangeNoBit) {
  Workers one(1), three(3);
  test::NoiseOptions noise;
  noise.bad_share = 0.02;
  noise.with_depth = true;
  const Window w{-3, 2, 34, 27};
  Settings s;
  s.recursive.disocclusion = Disocclusion::depth;
  s.recursive.residual_limit = 0.2;
  s.recursive.blur_limit = 0.3;
  const std::vector<Present> frames = noise_frames(w, noise, 6, one);
  const std::vector<Accumulated> a = resolve_all(frames, s, one), b = resolve_all(frames, s, three);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same_bits(a[i].history.color, b[i].history.color));
}

TEST(Subpixel, ExtremesStayFinite) {
  Workers workers(1);
  const Window w{0, 0, 11, 8};
  const float values[] = {65504.0f, 1e30f, -1e30f, 3.4e38f, -3.4e38f, 1e-42f, -5.0f, 0.0f};
  Settings s;
  s.recursive.residual_limit = 0.2;
  s.recursive.blur_limit = 0.3;
  SubpixelHistory history;
  std::mt19937 random(5);
  for (int i = 0; i < 8; ++i) {
    Present frame;
    frame.color = Plane<glm::vec4>(w, kPresentBorder);
    frame.motion = Plane<glm::vec2>(w);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 11; ++x) {
        for (int k = 0; k < 4; ++k) frame.color.at(x, y)[k] = values[random() % 8];
        if (random() % 20 == 0) frame.color.at(x, y).r = std::numeric_limits<float>::quiet_NaN();
        frame.motion.at(x, y) = glm::vec2(random() % 9 == 0 ? 1e30f : 0.3f, random() % 9 == 0 ? NAN : 0.2f);
      }
    sanitize(frame, workers);
    frame.jitter = jitter_of_frame(i);
    SubpixelStep step = step_on(frame, std::move(history), s, workers);
    history = std::move(step.history);
    EXPECT_TRUE(all_finite(step.resolved.history.color)) << i;
  }
}

TEST(Subpixel, ANaNReachesNoOtherPixel) {
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  Settings s;
  s.recursive.blur_limit = 0.3;
  const auto run = [&](bool damaged) {
    test::NoiseOptions noise;
    noise.motion = 0.7;
    std::vector<Present> frames = noise_frames(w, noise, 9, workers);
    SubpixelHistory history;
    Plane<glm::vec4> last;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Present& frame = frames[i];
      frame.motion.fill(glm::vec2(0.0f));
      if (damaged && i == 3) {
        frame.color.at(4, 4).g = std::numeric_limits<float>::quiet_NaN();
        sanitize(frame, workers);
      }
      SubpixelStep step = step_on(frame, std::move(history), s, workers);
      history = std::move(step.history);
      if (i == 3) last = std::move(step.resolved.history.color);
    }
    return last;
  };
  const Plane<glm::vec4> clean = run(false), damaged = run(true);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) {
      // Quarters are seen through samples of up to one pixel around.
      if (std::abs(x - 4) <= 2 && std::abs(y - 4) <= 2) continue;
      ASSERT_EQ(clean.at(x, y), damaged.at(x, y)) << x << " " << y;
    }
  EXPECT_TRUE(all_finite(damaged));
}

TEST(Subpixel, SeveralSamplesOfAFrameGoToTheirQuarters) {
  Workers workers(1);
  const Window w{0, 0, 7, 5};
  std::vector<Present> frames = noise_frames(w, {}, 4, workers);
  Settings s;
  std::vector<const Present*> samples;
  for (Present& frame : frames) {
    frame.motion = {};
    samples.push_back(&frame);
  }
  const SubpixelStep step =
      accumulate_subpixel(samples, {}, s.subpixel, s.recursive, s.rectify, nullptr, kRejectFirstFrame, {}, workers);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x) {
      // The second and later quarters have read the first ones, and count as old as these.
      EXPECT_EQ(step.history.quadrants[0].color.at(x, y), frames[0].color.at(x, y));
      for (const SubpixelBuffer& q : step.history.quadrants) EXPECT_GE(q.total.at(x, y), 1.0f);
    }
  EXPECT_TRUE(all_finite(step.resolved.history.color));
}

TEST(Subpixel, PartlyValidSamplesLeaveTheRestAsItWas) {
  Workers workers(1);
  const Window w{0, 0, 8, 6};
  std::vector<Present> frames = noise_frames(w, {}, 2, workers);
  frames[0].motion = {};
  frames[1].motion = {};
  frames[1].jitter = frames[0].jitter;  // the same quarter, in the same frame: nothing is read between pixels
  frames[1].valid.fill(0.0f);
  frames[1].valid.at(3, 3) = 1;
  const Present* samples[] = {&frames[0], &frames[1]};
  Settings s;
  const SubpixelStep step =
      accumulate_subpixel(samples, {}, s.subpixel, s.recursive, s.rectify, nullptr, kRejectFirstFrame, {}, workers);
  const SubpixelBuffer& q = step.history.quadrants[quadrant_of(*frames[0].jitter)];
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x)
      if (x != 3 || y != 3) {
        EXPECT_EQ(q.color.at(x, y), frames[0].color.at(x, y));
      }
  EXPECT_EQ(q.total.at(3, 3), 2.0f);
}

TEST(Subpixel, CompanionsThatAddUpStillDo) {
  Workers workers(2);
  const Window w{0, 0, 15, 11};
  Settings s;
  s.recursive.blur_limit = 0.3;
  test::NoiseOptions noise;
  noise.motion = 1.5;
  SubpixelHistory history;
  for (Present& frame : noise_frames(w, noise, 8, workers)) {
    frame.companions.emplace_back(w, kPresentBorder);
    frame.companions.emplace_back(w, kPresentBorder);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        frame.companions[0].at(x, y) = frame.color.at(x, y) * 0.25f;
        frame.companions[1].at(x, y) = frame.color.at(x, y) * 0.75f;
      }
    SubpixelStep step = step_on(frame, std::move(history), s, workers);
    history = std::move(step.history);
    const History& h = step.resolved.history;
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x)
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(h.companions[0].at(x, y)[k] + h.companions[1].at(x, y)[k], h.color.at(x, y)[k],
                      2e-6 * (1 + std::abs(h.color.at(x, y)[k])));
  }
}

/// Where the phase of a sinusoid that moves by v a frame ends up, minus where it should be, px along x.
double drift_of(SubpixelWeights weights, Workers& workers) {
  constexpr double kVelocity = 1.0 / 3, kPeriod = 12;
  const Window w{0, 0, 60, 12};
  Settings s;
  s.subpixel.weights = weights;
  s.recursive.alpha = 0.1;
  s.recursive.alpha_rule = AlphaRule::fixed;
  SubpixelHistory history;
  double drift = 0;
  const double wave = 2 * 3.14159265358979323846 / kPeriod;
  for (int i = 0; i < 120; ++i) {
    Present frame;
    frame.color = Plane<glm::vec4>(w, kPresentBorder);
    frame.jitter = kQuadrantMiddle[std::size_t(i) % kQuadrants];
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x)
        frame.color.at(x, y) = glm::vec4(float(2 + std::sin(wave * (x + frame.jitter->x - kVelocity * i))));
    frame.motion = Plane<glm::vec2>(w, 0, glm::vec2(float(-kVelocity)));
    sanitize(frame, workers);
    SubpixelStep step = step_on(frame, std::move(history), s, workers);
    history = std::move(step.history);
    double sine = 0, cosine = 0;
    for (int x = 24; x < 36; ++x) {
      const double phase = wave * (x - kVelocity * i), c = double(step.resolved.history.color.at(x, 6).r);
      sine += c * std::sin(phase);
      cosine += c * std::cos(phase);
    }
    if (i >= 100) drift += std::atan2(-cosine, sine) / wave / 20;
  }
  return drift;
}

TEST(Subpixel, FirstOrderWeightsDoNotDriftAndPlainOnesDo) {
  Workers workers(2);
  EXPECT_GT(std::abs(drift_of(SubpixelWeights::plain, workers)), 0.4);
  EXPECT_LT(std::abs(drift_of(SubpixelWeights::first_order, workers)), 0.06);
  EXPECT_LT(std::abs(drift_of(SubpixelWeights::second_order, workers)), 0.06);
}

TEST(Subpixel, TheBlurThatIsTrackedIsThatOfAnEdge) {
  // A step of light, moving: the second moment of the derivative of what is shown is that of the kernel along x.
  Workers workers(2);
  const Window w{0, 0, 48, 10};
  for (const double limit : {0.25, 0.5}) {
    Settings s;
    s.recursive.alpha = 0.05;
    s.recursive.blur_limit = limit;
    SubpixelHistory history;
    double place = 10, most = 0, claimed = 0;
    for (int i = 0; i < 60; ++i) {
      place += 0.37;
      Present frame;
      frame.color = Plane<glm::vec4>(w, kPresentBorder);
      frame.jitter = jitter_of_frame(i);
      for (int y = 0; y < w.y1; ++y)
        for (int x = 0; x < w.x1; ++x) frame.color.at(x, y) = glm::vec4(x + frame.jitter->x >= place ? 1.0f : 0.0f);
      frame.motion = Plane<glm::vec2>(w, 0, glm::vec2(-0.37f, -0.37f));
      sanitize(frame, workers);
      SubpixelStep step = step_on(frame, std::move(history), s, workers);
      history = std::move(step.history);
      if (i < 40) continue;
      const int y = 5;
      double mean = 0, square = 0;
      for (int x = 1; x < w.x1; ++x) {
        const double d = double(step.resolved.history.color.at(x, y).r - step.resolved.history.color.at(x - 1, y).r);
        mean += d * (x - 0.5 - place), square += d * (x - 0.5 - place) * (x - 0.5 - place);
      }
      // A difference of neighbors is seen through a box of one pixel.
      most += (square - mean * mean - 1.0 / 12) / 20;
      claimed = std::max(claimed, double(step.resolved.diagnostics.blur.at(int(place), y)));
    }
    EXPECT_LT(most, limit * 1.05);
    EXPECT_LT(claimed, limit * 1.1);
  }
}

TEST(CarryWay, AddsVectorsAndStopsAtEdges) {
  Workers workers(1);
  const Window w{0, 0, 8, 3};
  Plane<glm::vec2> way(w, 0, glm::vec2(1.0f, 0.25f)), motion(w, 0, glm::vec2(-0.5f, 0.0f));
  for (int y = 0; y < 3; ++y)
    for (int x = 4; x < 8; ++x) way.at(x, y) = glm::vec2(-3.0f, 0.0f);
  motion.at(6, 1) = glm::vec2(NAN);
  const Plane<glm::vec2> on = carry_way(way, motion, w, workers);
  EXPECT_EQ(on.at(2, 1), glm::vec2(0.5f, 0.25f));
  EXPECT_EQ(on.at(7, 1), glm::vec2(-3.5f, 0.0f));
  EXPECT_EQ(on.at(4, 1), glm::vec2(-3.5f, 0.0f));  // 3.5 lies between two surfaces: the nearest, not their mean
  EXPECT_FALSE(std::isfinite(on.at(6, 1).x));
  EXPECT_EQ(on.at(0, 1), glm::vec2(0.5f, 0.25f));  // the window's edge
  EXPECT_TRUE(std::isnan(carry_way(way, Plane<glm::vec2>(w, 0, glm::vec2(-9.0f)), w, workers).at(2, 1).x));
}

}  // namespace
}  // namespace varve
