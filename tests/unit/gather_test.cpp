// The gather accumulator: the laws that its results obey.
#include "gather/gather.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <random>

#include "support/gather_scenes.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::same_bits;
using test::Seen;
using test::Shot;
using test::ShotOptions;
using test::take;
using test::TwoPlanes;

constexpr DiagnosticsWanted kAll{.weight = true, .reject = true, .counts = true, .gather = true};

GatherParameters plain() {
  GatherParameters p;
  p.gain = false;
  p.change_limit = 0;
  return p;
}

template <class F>
void each_pixel(const Window& w, const F& f) {
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) f(x, y);
}

bool is_finite(const glm::vec4& c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) && std::isfinite(c.a);
}

/// Root mean square difference of green, a margin left out.
double rms(const Plane<glm::vec4>& picture, const std::function<double(int, int)>& truth, int margin) {
  const Window& w = picture.window();
  double sum = 0;
  int count = 0;
  each_pixel({w.x0 + margin, w.y0 + margin, w.x1 - margin, w.y1 - margin}, [&](int x, int y) {
    const double d = double(picture.at(x, y).g) - truth(x, y);
    sum += d * d;
    ++count;
  });
  return std::sqrt(sum / count);
}

Accumulated resolve(const Shot& shot, std::size_t present, const GatherParameters& p, Workers& workers,
                    Isa isa = Isa::automatic) {
  return gather(shot.sources(), present, p, shot.test(), kAll, workers, isa);
}

TEST(Gather, ConstantInConstantOut) {
  Workers workers(2);
  const glm::vec4 color(0.3f, 1.7f, 65504.0f, 1.0f);
  TwoPlanes world;
  world.front = world.back = [&](glm::dvec2) { return color; };
  double worst = 0;
  for (const SampleFilter filter : {SampleFilter::none, SampleFilter::tent, SampleFilter::blackman_harris})
    for (const bool gain : {false, true}) {
      Shot shot = take(world, {}, workers);
      GatherParameters p;
      p.filter = filter;
      if (gain) shot.measure_light(5, workers);
      const Accumulated out = resolve(shot, 4, p, workers);
      each_pixel(out.history.color.window(), [&](int x, int y) {
        for (int k = 0; k < 4; ++k)
          worst = std::max(worst, std::fabs(double(out.history.color.at(x, y)[k]) / double(color[k]) - 1));
      });
    }
  EXPECT_LE(worst, double(FLT_EPSILON) / 2);
}

TEST(Gather, PowersOfTwoScaleBitForBit) {
  Workers workers(2);
  const TwoPlanes world;
  const auto scaled = [&](float scale) {
    Shot shot = take(
        [&](glm::dvec2 at, int f) {
          Seen s = world(at, f);
          s.color *= glm::vec4(glm::vec3(scale * (f < 3 ? 0.5f : 1.0f)), 1);
          return s;
        },
        {}, workers);
    shot.measure_light(7, workers);
    return resolve(shot, 4, {}, workers).history.color;
  };
  const Plane<glm::vec4> one = scaled(1);
  for (const int power : {10, -20, -90, 100}) {
    const float scale = std::ldexp(1.0f, power);
    const Plane<glm::vec4> other = scaled(scale);
    int differing = 0;
    each_pixel(one.window(), [&](int x, int y) {
      const glm::vec4 a = one.at(x, y) * glm::vec4(glm::vec3(scale), 1), b = other.at(x, y);
      differing += !(a == b);
    });
    EXPECT_EQ(differing, 0) << power;
  }
}

TEST(Gather, ThreadsAndProcessorsGiveTheSameBits) {
  Workers one(1), two(2), three(3);
  Shot shot = take(TwoPlanes{}, {.window_motion = {1, -1}, .companions = 2}, one);
  shot.measure_light(7, one);
  GatherParameters p;
  p.filter = SampleFilter::blackman_harris;
  const Accumulated first = resolve(shot, 4, p, one, Isa::baseline);
  for (Workers* workers : {&one, &two, &three})
    for (const Isa isa : {Isa::baseline, Isa::automatic}) {
      const Accumulated other = resolve(shot, 4, p, *workers, isa);
      EXPECT_TRUE(same_bits(first.history.color, other.history.color));
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_TRUE(same_bits(first.history.companions[k], other.history.companions[k]));
      each_pixel(first.history.color.window(), [&](int x, int y) {
        ASSERT_EQ(first.history.total.at(x, y), other.history.total.at(x, y));
        ASSERT_EQ(first.diagnostics.variance.at(x, y), other.diagnostics.variance.at(x, y));
        ASSERT_EQ(first.diagnostics.frames.at(x, y), other.diagnostics.frames.at(x, y));
      });
    }
}

TEST(Gather, AStillSceneConvergesToTheBoxFilteredTruth) {
  Workers workers(2);
  const double k = 2.6;  // beyond what a pixel grid can hold
  const auto color = [&](glm::dvec2 p) { return glm::vec4(float(1 + 0.5 * std::sin(k * p.x + 1.1 * p.y))); };
  const auto truth = [&](int x, int y) {  // mean of the sine over a pixel
    return 1 + 0.5 * std::sin(k * (x + 0.5) + 1.1 * (y + 0.5)) * std::sin(k / 2) / (k / 2) * std::sin(0.55) / 0.55;
  };
  Shot shot = take(test::still(color), {.frames = 1}, workers);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> pixel(-0.5, 0.5);
  // Jitter at random, so that samples crowd here and are missing there.
  ShotOptions o{.frames = 1, .jitter = false};
  Shot all;
  for (int f = 0; f < 33; ++f) {
    const glm::dvec2 j(pixel(random), pixel(random));
    Shot frame = take(test::still([&](glm::dvec2 p) { return color(p + j); }), o, workers);
    all.presents.push_back(std::move(frame.presents[0]));
    all.backward.push_back(std::move(frame.backward[0]));
    all.forward.push_back(std::move(frame.forward[0]));
    all.blocks.push_back(std::move(frame.blocks[0]));
    all.jitter.push_back(j);
  }
  std::vector<double> errors;
  for (const std::size_t reach : {std::size_t(0), std::size_t(2), std::size_t(6), std::size_t(16)}) {
    const Accumulated out = gather(all.sources(16 - reach, 17 + reach), reach, plain(), all.test(), {}, workers);
    errors.push_back(rms(out.history.color, truth, 2));
  }
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i], 0.8 * errors[i - 1]) << i;
  Plane<glm::vec4> mean(o.window, 0, glm::vec4(0));
  each_pixel(o.window, [&](int x, int y) {
    for (const Present& p : all.presents) mean.at(x, y) += p.color.at(x, y) / 33.0f;
  });
  EXPECT_LT(errors.back(), 0.6 * rms(mean, truth, 2));
}

/// Root mean square of how far coverage is off at the edge: of the gather, of the share of samples that fall into a
/// pixel, and of the present alone.
struct EdgeError {
  double gathered = 0, counted = 0, raw = 0, inside = 0;
};

EdgeError edge_error(glm::dvec2 speed, Workers& workers) {
  const int present = 16, frames = 33;
  TwoPlanes world;
  world.front_speed = speed;
  world.edge = 24 - speed.x * present;
  world.front = [](glm::dvec2) { return glm::vec4(1); };
  world.back = [](glm::dvec2) { return glm::vec4(0); };
  const Shot shot = take(world, {.frames = frames}, workers);
  Plane<glm::vec2> count(shot.presents[0].color.window(), 0, glm::vec2(0));  // samples, and those of the front
  for (int f = 0; f < frames; ++f)
    each_pixel(count.window(), [&](int x, int y) {
      const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) + shot.jitter[std::size_t(f)],
                       here = at + speed * double(present - f);
      const int hx = int(std::floor(here.x)), hy = int(std::floor(here.y));
      if (count.window().contains(hx, hy)) count.at(hx, hy) += glm::vec2(1, world.covers(at, f) ? 1 : 0);
    });
  const Accumulated out = resolve(shot, present, GatherParameters{.gain = false}, workers);
  EdgeError e;
  int edges = 0;
  each_pixel(Window{2, 2, 35, 27}, [&](int x, int y) {
    int covered = 0;
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) covered += world.covers({x + (i + 0.5) / 32, y + (j + 0.5) / 32}, present);
    const double truth = covered / 1024.0, off = double(out.history.color.at(x, y).g) - truth;
    if (covered == 0 || covered == 1024) {
      e.inside = std::max(e.inside, std::fabs(off));
      return;
    }
    const double counted = double(count.at(x, y).y) / double(count.at(x, y).x) - truth,
                 raw = double(shot.presents[present].color.at(x, y).g) - truth;
    e.gathered += off * off, e.counted += counted * counted, e.raw += raw * raw;
    ++edges;
  });
  EXPECT_GT(edges, 20);
  for (double* sum : {&e.gathered, &e.counted, &e.raw}) *sum = std::sqrt(*sum / edges);
  return e;
}

TEST(Gather, CoverageOfAMovingEdge) {
  Workers workers(2);
  for (const glm::dvec2 speed :
       {glm::dvec2(0), glm::dvec2(1, 0), glm::dvec2(0.63, -0.21), glm::dvec2(0.3717, 0.2191), glm::dvec2(0.5, 0.25)}) {
    const EdgeError e = edge_error(speed, workers);
    EXPECT_GT(e.raw, 0.25);
    // Speeds and jitter together may leave parts of a pixel unseen; what is seen is used better than by counting.
    EXPECT_LT(e.gathered, 0.8 * e.counted) << speed.x;
    EXPECT_LT(e.gathered, speed.x == 0.5 ? 0.1 : 0.055) << speed.x;
    EXPECT_TRUE(speed.y != 0 || e.gathered < 0.025) << speed.x << ": " << e.gathered;
    EXPECT_LT(e.inside, 0.07) << speed.x;
  }
}

TEST(Gather, ABadSampleTouchesItsFootprintOnly) {
  Workers workers(2);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const auto shot_with = [&](auto&& damage) {
    Shot shot = take(test::still(test::texture), {}, workers);
    damage(shot);
    for (Present& p : shot.presents) sanitize(p, workers);
    return resolve(shot, 4, plain(), workers).history.color;
  };
  const Plane<glm::vec4> whole = shot_with([](Shot&) {});
  const auto expect_local = [&](const char* what, auto&& damage) {
    const Plane<glm::vec4> hurt = shot_with(damage);
    int touched = 0;
    each_pixel(whole.window(), [&](int x, int y) {
      EXPECT_TRUE(is_finite(hurt.at(x, y))) << what << x << "," << y;
      const bool near = std::abs(x - 12) <= 1 && std::abs(y - 9) <= 1;
      EXPECT_TRUE(near || whole.at(x, y) == hurt.at(x, y)) << what << x << "," << y;
      touched += !(whole.at(x, y) == hurt.at(x, y));
    });
    EXPECT_GT(touched, 0) << what;
  };
  for (const std::size_t f : {std::size_t(2), std::size_t(4)})
    for (const float bad : {nan, inf, -inf})
      expect_local("color", [&](Shot& s) { s.presents[f].color.at(12, 9).g = bad; });
  for (const float bad : {nan, inf, -inf, 1e30f, -3e38f})
    expect_local("vector", [&](Shot& s) { s.forward[0].at(12, 9) = glm::vec2(bad); });
  expect_local("one axis", [&](Shot& s) { s.forward[0].at(12, 9) = glm::vec2(0, nan); });
}

TEST(Gather, NothingMakesItInfinite) {
  Workers workers(2);
  std::mt19937 random(11);
  const float odd[] = {0,   -1,    1e-30f, 1e-42f, 65504, 1e30f, -1e30f, 3e38f, std::numeric_limits<float>::infinity(),
                       NAN, 1e-3f, 1,      2,      0.5f};
  const auto any = [&] { return odd[random() % std::size(odd)]; };
  for (const SampleFilter filter : {SampleFilter::none, SampleFilter::mitchell})
    for (int round = 0; round < 12; ++round) {
      Shot shot = take(
          [&](glm::dvec2 at, int f) {
            Seen s = TwoPlanes{}(at, f);
            if (random() % 3 == 0) s.color = {any(), any(), any(), any()};
            s.color *= glm::vec4(std::exp2(float(f * 9 * (round % 3) - 30)));
            if (random() % 4 == 0) s.back = s.on = {double(any()), double(any())};
            if (random() % 4 == 0) s.back += glm::dvec2(1e-3 * double(random() % 4000)), s.on *= 1.3;
            if (random() % 5 == 0) s.id = std::uint32_t(random());
            const float depth = std::fabs(any());
            if (random() % 5 == 0 && depth == depth) s.depth = depth;
            return s;
          },
          {.frames = 7, .window = {-5, 3, 21, 20}, .window_motion = {1, 1}, .companions = 1}, workers);
      shot.measure_light(7, workers);
      GatherParameters p;
      p.filter = filter;
      const Accumulated out = resolve(shot, 3, p, workers);
      int bad = 0;
      each_pixel(out.history.color.window(), [&](int x, int y) {
        bad += !is_finite(out.history.color.at(x, y)) || !is_finite(out.history.companions[0].at(x, y));
        for (const Plane<float>* plane : {&out.diagnostics.variance, &out.diagnostics.frames, &out.diagnostics.gain,
                                          &out.diagnostics.weight, &out.diagnostics.round_trip})
          bad += !std::isfinite(plane->at(x, y));
      });
      EXPECT_EQ(bad, 0) << round;
    }
}

TEST(Gather, CompanionsStillSumToTheColor) {
  Workers workers(2);
  Shot shot = take(
      [](glm::dvec2 at, int f) {
        Seen s = TwoPlanes{}(at, f);
        s.color *= glm::vec4(glm::vec3(f < 4 ? 0.6f : 1.0f), 1);
        return s;
      },
      {.companions = 2}, workers);
  shot.measure_light(7, workers);
  const History h = resolve(shot, 4, {}, workers).history;
  each_pixel(h.color.window(), [&](int x, int y) {
    const glm::vec4 sum = h.companions[0].at(x, y) + h.companions[1].at(x, y);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], h.color.at(x, y)[k], 1e-6 * double(h.color.at(x, y)[k]));
  });
}

TEST(Gather, OneFrameIsThePresentReconstructed) {
  Workers workers(2);
  const auto ramp = [](glm::dvec2 p) { return glm::vec4(float(1 + 0.1 * p.x + 0.05 * p.y)); };
  const Shot shot = take(test::still(ramp), {.frames = 1, .jitter = false}, workers);
  const Accumulated out = resolve(shot, 0, {}, workers);
  each_pixel(Window{1, 1, 36, 28}, [&](int x, int y) {
    EXPECT_NEAR(out.history.color.at(x, y).g, ramp({x + 0.5, y + 0.5}).g, 1e-5);
    EXPECT_EQ(out.diagnostics.frames.at(x, y), 1);
    EXPECT_EQ(out.diagnostics.weight.at(x, y), 0);
  });
  EXPECT_EQ(out.counts.restarted, 0u);
}

TEST(Gather, AnySizeAndAnyDataWindow) {
  Workers workers(2);
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 23), glm::ivec2(23, 1), glm::ivec2(17, 33)})
    for (const glm::ivec2 motion : {glm::ivec2(0), glm::ivec2(2, -1), glm::ivec2(40, 0)}) {
      const Window w{-7, -3, -7 + size.x, -3 + size.y};
      const Shot shot = take(test::still([](glm::dvec2) { return glm::vec4(0.7f); }),
                             {.frames = 5, .window = w, .window_motion = motion}, workers);
      for (const std::size_t present : {std::size_t(0), std::size_t(2), std::size_t(4)}) {
        const Accumulated out = resolve(shot, present, {}, workers);
        EXPECT_TRUE(out.history.color.window() == shot.presents[present].color.window());
        each_pixel(out.history.color.window(), [&](int x, int y) {
          EXPECT_NEAR(out.history.color.at(x, y).g, 0.7f, 1e-7) << size.x << "x" << size.y;
          EXPECT_TRUE(motion.x != 40 || out.diagnostics.frames.at(x, y) == 1);
        });
      }
    }
}

TEST(Gather, WhereNothingIsKnownThePresentStands) {
  Workers workers(1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Shot none = take(test::still([&](glm::dvec2) { return glm::vec4(nan); }), {.frames = 3}, workers);
  const Accumulated out = resolve(none, 1, {}, workers);
  EXPECT_EQ(out.counts.restarted, 37u * 29u);
  each_pixel(out.history.color.window(), [&](int x, int y) { EXPECT_EQ(out.history.color.at(x, y), glm::vec4(0)); });
  // A frame that is lost as a whole is made of those around it.
  const Shot middle = take(
      [&](glm::dvec2 at, int f) {
        return Seen{f == 1 ? glm::vec4(nan) : test::texture(at * 0.1), 1, 10, {}, {}};
      },
      {.frames = 3}, workers);
  const Accumulated found = resolve(middle, 1, {}, workers);
  EXPECT_EQ(found.counts.restarted, 0u);
  EXPECT_LT(rms(
                found.history.color,
                [](int x, int y) { return double(test::texture(glm::dvec2(x + 0.5, y + 0.5) * 0.1).g); }, 2),
            0.005);
}

TEST(Gather, AGlobalChangeOfLightIsFollowed) {
  Workers workers(2);
  Shot shot = take(
      [](glm::dvec2 at, int f) {
        return Seen{test::texture(at * 0.3) * (f < 8 ? 0.5f : 1.0f), 1, 10, {}, {}};
      },
      {.frames = 17}, workers);
  shot.measure_light(15, workers);
  const auto truth = [](int x, int y) { return double(test::texture(glm::dvec2(x + 0.5, y + 0.5) * 0.3).g); };
  GatherParameters p = plain();
  const double off = rms(resolve(shot, 8, p, workers).history.color, truth, 2);
  p.gain = true;
  const double on = rms(resolve(shot, 8, p, workers).history.color, truth, 2);
  EXPECT_GT(off, 0.08);
  EXPECT_LT(on, 0.005);
}

}  // namespace
}  // namespace varve
