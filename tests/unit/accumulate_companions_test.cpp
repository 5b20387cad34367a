// Channels that go with a color: laws of the sum, of constants, of scale, of bad values.
#include "resolve/accumulate_companions.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>

#include "reference/companions_reference.h"
#include "resolve/light_sum.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::noise_present;
using test::same_bits;

/// Splits the color into `count` lights that add up to it as well as floats can: the color becomes their sum. Each
/// light has its own pattern, so that none is a multiple of the color.
void split_into_lights(Present& p, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Window& w = p.color.window();
  for (int i = 0; i < count; ++i) p.companions.emplace_back(w, kPresentBorder, glm::vec4(0.0f));
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      glm::vec4& color = p.color.at(x, y);
      for (int k = 0; k < 4; ++k) {
        double left = double(color[k]), sum = 0;
        for (int i = 0; i < count; ++i) {
          const double share = i + 1 == count ? 1 : (x / 5 + i) % count == 0 ? unit(random) : 0.1 * unit(random);
          const float light = float(left * share);
          p.companions[std::size_t(i)].at(x, y)[k] = light;
          left -= double(light);
          sum += double(light);
        }
        color[k] = float(sum);
      }
    }
}

struct Settings {
  RecursiveParameters recursive;
  RectifyParameters rectify;
  std::optional<glm::dvec2> jitter;
  std::string name;
};

std::vector<Settings> every_setting() {
  std::vector<Settings> all;
  for (const Box box : {Box::none, Box::minmax, Box::variance, Box::variance_minmax})
    for (const BoxRule rule : {BoxRule::clip, BoxRule::clamp})
      for (const BoxAnchor anchor : {BoxAnchor::present, BoxAnchor::mean})
        for (const BoxSpace space : {BoxSpace::rgb, BoxSpace::ycocg})
          for (const int window : {3, 7}) {
            Settings s;
            s.rectify = {box, 0.75, window, WindowMoments::direct, rule, anchor, space};
            s.name = "box " + std::to_string(int(box)) + " rule " + std::to_string(int(rule)) + " anchor " +
                     std::to_string(int(anchor)) + " space " + std::to_string(int(space)) + " window " +
                     std::to_string(window);
            if (box != Box::none || (rule == BoxRule::clip && window == 3)) all.push_back(s);
          }
  for (const HistoryFilter filter :
       {HistoryFilter::bilinear, HistoryFilter::catmull_rom9, HistoryFilter::catmull_rom5, HistoryFilter::catmull_rom})
    for (const bool dering : {true, false})
      for (const double alpha : {0.3, 0.02}) {
        Settings s;
        s.recursive.history_filter = filter;
        s.recursive.dering = dering;
        s.recursive.alpha = alpha;
        s.name =
            "filter " + std::to_string(int(filter)) + (dering ? " dering" : "") + " alpha " + std::to_string(alpha);
        all.push_back(s);
      }
  for (const SampleFilter filter : {SampleFilter::tent, SampleFilter::blackman_harris, SampleFilter::mitchell}) {
    Settings s;
    s.recursive.sample_filter = filter;
    s.recursive.disocclusion = Disocclusion::depth;
    s.jitter = glm::dvec2(0.3, -0.4);
    s.name = "samples " + std::to_string(int(filter));
    all.push_back(s);
  }
  // What other row passes and filters do to the color.
  for (const Box box : {Box::rounded, Box::dynamic4, Box::kdop13, Box::pca, Box::ellipsoid, Box::hull})
    for (const BoxRule rule : {BoxRule::clip, BoxRule::project, BoxRule::off})
      for (const BoxSpace space : {BoxSpace::rgb, BoxSpace::log}) {
        Settings s;
        s.rectify.box = box;
        s.rectify.rule = rule;
        s.rectify.space = space;
        s.rectify.clip_discount = rule == BoxRule::off;
        s.name = "shape " + std::to_string(int(box)) + " rule " + std::to_string(int(rule)) + " space " +
                 std::to_string(int(space));
        all.push_back(s);
      }
  for (const double b : {0.0, 1.0 / 3, 1.0}) {
    Settings s;
    s.recursive.history_filter = HistoryFilter::cubic;
    s.recursive.cubic_b = b;
    s.recursive.cubic_c = (1 - b) / 2;
    s.recursive.unjitter = Unjitter::bilinear;
    s.jitter = glm::dvec2(0.3, -0.4);
    s.name = "unjitter, cubic " + std::to_string(b);
    all.push_back(s);
  }
  for (const OnReject on_reject : {OnReject::restart, OnReject::blur, OnReject::weight})
    for (const Weighing weighing : {Weighing::none, Weighing::luminance, Weighing::logarithm}) {
      Settings s;
      s.recursive.disocclusion = Disocclusion::depth;
      s.recursive.reject.depth_slope = 1;
      s.recursive.reject.acceleration = 2;
      s.recursive.reject.on_reject = on_reject;
      s.recursive.weight.weighing = weighing;
      s.recursive.weight.feedback = Feedback::luma;
      s.recursive.weight.anti_flicker = 0.5;
      s.name = "on reject " + std::to_string(int(on_reject)) + " weighing " + std::to_string(int(weighing));
      all.push_back(s);
    }
  return all;
}

/// A frame of a sequence: the window moves, some samples and vectors are bad. Tame: no highlights, and opaque.
Present frame_of(int frame, int lights, Workers& workers, float scale = 1, bool tame = false) {
  const int shift = frame % 3;
  test::NoiseOptions noise;
  noise.seed = unsigned(100 + frame);
  noise.bad_motion = 0.02;
  noise.with_depth = true;
  noise.scale = scale;
  noise.motion = frame % 4 == 3 ? 0 : 2.5;
  Present p = noise_present({shift - 2, 3 - shift, 35 + shift, 30}, noise, workers);
  const Window& w = p.color.window();
  for (int y = w.y0; tame && y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) p.color.at(x, y) = glm::vec4(glm::min(glm::vec3(p.color.at(x, y)), 1.0f), 1.0f);
  split_into_lights(p, lights, unsigned(frame));
  for (int y = w.y0; tame && y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) p.color.at(x, y).a = 1;
  // Bad in the color: the lights are repaired by the same neighbors.
  p.color.at(5, 5 + frame % 7).g = std::numeric_limits<float>::quiet_NaN();
  p.color.at(6, 5).r = std::numeric_limits<float>::infinity();
  sanitize(p, workers);
  sanitize_companions(p, workers);
  return p;
}

TEST(Companions, LightsAddUpToTheColorUnderEverySetting) {
  Workers workers(2);
  for (const Settings& s : every_setting()) {
    SCOPED_TRACE(s.name);
    History history;
    std::size_t clipped = 0;
    double worst = 0;
    for (int frame = 0; frame < 24; ++frame) {
      const Present p = frame_of(frame, 3, workers);
      Accumulated a = accumulate(p, history, s.recursive, s.rectify, s.jitter, 1, {}, workers);
      const LightSum sum = measure_light_sum(p, a.history, workers);
      ASSERT_EQ(sum.adding_up, sum.pixels);
      ASSERT_LT(sum.input, 2e-7);
      worst = std::max(worst, sum.resolved);
      clipped += a.counts.clipped;
      history = std::move(a.history);
    }
    EXPECT_LT(worst, 1e-6);
    EXPECT_TRUE(s.rectify.box == Box::none || s.rectify.rule == BoxRule::off || clipped > 500)
        << "nothing was put to the test";
  }
}

TEST(Companions, AgreeWithTheirSlowTwin) {
  Workers workers(2);
  std::size_t compared = 0, moved = 0;
  for (const HistoryFilter filter :
       {HistoryFilter::bilinear, HistoryFilter::catmull_rom, HistoryFilter::catmull_rom9, HistoryFilter::catmull_rom5})
    for (const Box box : {Box::none, Box::variance})
      for (const BoxRule rule : {BoxRule::clip, BoxRule::clamp})
        for (const BoxAnchor anchor : {BoxAnchor::present, BoxAnchor::mean})
          for (const bool dering : {true, false}) {
            SCOPED_TRACE(std::to_string(int(filter)) + std::to_string(int(box)) + std::to_string(int(rule)) +
                         std::to_string(int(anchor)) + std::to_string(dering));
            RecursiveParameters recursive;
            recursive.history_filter = filter;
            recursive.dering = dering;
            recursive.disocclusion = Disocclusion::depth;
            const RectifyParameters rectify{box, 1.5, 3, WindowMoments::direct, rule, anchor, BoxSpace::rgb};
            History previous;
            for (int frame = 0; frame < 3; ++frame) {
              // Rounding of the color beside highlights would decide the part of the way; alpha the twin leaves out.
              const Present p = frame_of(frame, 3, workers, 1, true);
              Accumulated a = accumulate(p, previous, recursive, rectify, {}, 1, {}, workers);
              for (std::size_t c = 0; c < 3; ++c) {
                const reference::AsColor companion = reference::as_color(p, previous, c);
                const Window& w = p.color.window();
                for (int y = w.y0; y < w.y1; ++y)
                  for (int x = w.x0; x < w.x1; ++x) {
                    bool determined = true;
                    const reference::Color slow =
                        reference::companion_pixel(p, previous, companion, recursive, rectify, x, y, determined);
                    if (!determined) continue;
                    ++compared;
                    // Rounding is that of floats of the size of the colors around, over the length of the move.
                    double size = 1e-30;
                    for (int v = -3; v <= 3; ++v)
                      for (int u = -3; u <= 3; ++u)
                        if (w.contains(x + u, y + v))
                          for (int k = 0; k < 3; ++k)
                            size = std::max(size, std::abs(double(p.color.at(x + u, y + v)[k])));
                    for (int k = 0; k < 3; ++k)
                      ASSERT_NEAR(double(a.history.companions[c].at(x, y)[k]), slow[std::size_t(k)], 2e-5 * size)
                          << x << "," << y << " frame " << frame << " light " << c << " channel " << k;
                  }
              }
              moved += a.counts.clipped;
              previous = std::move(a.history);
            }
          }
  EXPECT_GT(compared, 100000u);
  EXPECT_GT(moved, 3000u);
}

// A light that is half of the color is half of what becomes of it, whatever was done.
TEST(Companions, HalfOfTheColorStaysHalf) {
  Workers workers(2);
  for (const Settings& s : every_setting()) {
    SCOPED_TRACE(s.name);
    History history;
    for (int frame = 0; frame < 6; ++frame) {
      Present p = frame_of(frame, 0, workers);
      const Window& w = p.color.window();
      p.companions.emplace_back(w, kPresentBorder, glm::vec4(0.0f));
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) p.companions[0].at(x, y) = 0.5f * p.color.at(x, y);
      history = accumulate(p, history, s.recursive, s.rectify, s.jitter, 1, {}, workers).history;
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x)
          for (int k = 0; k < 4; ++k)
            ASSERT_EQ(history.companions[0].at(x, y)[k], 0.5f * history.color.at(x, y)[k]) << x << "," << y;
    }
  }
}

// In proportion to what each has, the steady light would fall as well: 2.5 and 2.5.
TEST(Companions, ALightThatGoesOutLeavesTheOthersAsTheyAre) {
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  const RecursiveParameters recursive;
  for (const BoxRule rule : {BoxRule::clip, BoxRule::clamp})
    for (const BoxAnchor anchor : {BoxAnchor::present, BoxAnchor::mean})
      for (const BoxSpace space : {BoxSpace::rgb, BoxSpace::ycocg}) {
        const RectifyParameters rectify{Box::variance, 1, 3, WindowMoments::direct, rule, anchor, space};
        History history;
        for (const float key : {5.0f, 5.0f, 5.0f, 0.0f}) {
          Present p = test::flat_present(w, glm::vec4(key + 4, key + 5, key + 6, 1), workers);
          p.companions.emplace_back(w, kPresentBorder, glm::vec4(key, key, key, 0));
          p.companions.emplace_back(w, kPresentBorder, glm::vec4(4, 5, 6, 1));
          sanitize_companions(p, workers);
          history = accumulate(p, history, recursive, rectify, {}, 1, {}, workers).history;
        }
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(double(history.companions[0].at(4, 4)[k]), 0, 2e-5);
          EXPECT_NEAR(double(history.companions[1].at(4, 4)[k]), 4 + k, 2e-5);
        }
      }
}

TEST(Companions, TheColorDoesNotKnowThem) {
  Workers workers(2);
  History with, without;
  for (int frame = 0; frame < 4; ++frame) {
    Present p = frame_of(frame, 3, workers);
    Accumulated a = accumulate(p, with, {}, {}, {}, 1, {true, true, true}, workers);
    p.companions.clear();
    Accumulated b = accumulate(p, without, {}, {}, {}, 1, {true, true, true}, workers);
    EXPECT_TRUE(same_bits(a.history.color, b.history.color));
    EXPECT_EQ(a.counts.clipped, b.counts.clipped);
    EXPECT_EQ(a.history.companions.size(), 3u);
    EXPECT_TRUE(b.history.companions.empty());
    with = std::move(a.history);
    without = std::move(b.history);
  }
}

TEST(Companions, ConstantsStayThatConstant) {
  Workers workers(2);
  for (const HistoryFilter filter : {HistoryFilter::bilinear, HistoryFilter::catmull_rom, HistoryFilter::catmull_rom5})
    for (const float value : {0.0f, 0.3f, -7.1f, 65504.0f, 1e30f, 1e-30f, 1e-42f}) {
      RecursiveParameters recursive;
      recursive.history_filter = filter;
      History history;
      for (int frame = 0; frame < 6; ++frame) {
        Present p = frame_of(frame, 0, workers);
        p.companions.emplace_back(p.color.window(), kPresentBorder, glm::vec4(value));  // beside a color that is noise
        p.companion_is_color = {0};
        sanitize_companions(p, workers);
        history = accumulate(p, history, recursive, {}, {}, 1, {}, workers).history;
      }
      const Window& w = history.color.window();
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x)
          for (int k = 0; k < 4; ++k) ASSERT_EQ(history.companions[0].at(x, y)[k], value) << x << "," << y;
    }
}

TEST(Companions, ScaledByAPowerOfTwoBitForBit) {
  Workers workers(2);
  for (const BoxSpace space : {BoxSpace::rgb, BoxSpace::ycocg})
    for (const float scale : {0x1p-40f, 0x1p30f}) {
      RectifyParameters rectify;
      rectify.space = space;
      History one, scaled;
      for (int frame = 0; frame < 5; ++frame) {
        one = accumulate(frame_of(frame, 2, workers), one, {}, rectify, {}, 1, {}, workers).history;
        scaled = accumulate(frame_of(frame, 2, workers, scale), scaled, {}, rectify, {}, 1, {}, workers).history;
      }
      const Window& w = one.color.window();
      for (const std::size_t c : {0u, 1u})
        for (int y = w.y0; y < w.y1; ++y)
          for (int x = w.x0; x < w.x1; ++x)
            for (int k = 0; k < 3; ++k)
              ASSERT_EQ(one.companions[c].at(x, y)[k] * scale, scaled.companions[c].at(x, y)[k]) << x << "," << y;
    }
}

TEST(Companions, BadValuesDoNotSpread) {
  Workers workers(2);
  const auto run = [&](bool bad) {
    History history;
    for (int frame = 0; frame < 4; ++frame) {
      Present p = frame_of(frame, 2, workers);
      if (bad && frame == 1) {
        p.companions[0].at(10, 10).g = std::numeric_limits<float>::quiet_NaN();
        p.companions[0].at(20, 12).r = -std::numeric_limits<float>::infinity();
        sanitize_companions(p, workers);
        EXPECT_EQ(p.companions_not_finite, 2u);
        float low = 1e30f, high = 0;
        for (int j = 9; j <= 11; ++j)
          for (int i = 9; i <= 11; ++i)
            if (i != 10 || j != 10) {
              low = std::min(low, p.companions[0].at(i, j).g);
              high = std::max(high, p.companions[0].at(i, j).g);
            }
        EXPECT_GE(p.companions[0].at(10, 10).g, low);
        EXPECT_LE(p.companions[0].at(10, 10).g, high);
      }
      history = accumulate(p, history, {}, {}, {}, 1, {}, workers).history;
    }
    return history;
  };
  const History good = run(false), bad = run(true);
  EXPECT_TRUE(same_bits(good.color, bad.color));
  EXPECT_TRUE(same_bits(good.companions[1], bad.companions[1]));
  EXPECT_FALSE(same_bits(good.companions[0], bad.companions[0])) << "nothing was put to the test";
  std::size_t touched = 0;
  const Window& w = bad.color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      for (int k = 0; k < 4; ++k) {
        ASSERT_TRUE(std::isfinite(bad.companions[0].at(x, y)[k]));
        touched += bad.companions[0].at(x, y)[k] != good.companions[0].at(x, y)[k];
      }
  EXPECT_LT(touched, 200u) << "two frames of motion and filters reach a few pixels";
}

TEST(Companions, ExtremesStayFinite) {
  Workers workers(2);
  for (const float extreme : {3.4e38f, -3.4e38f, 65504.0f, 1e30f, 1e-30f, 1e-45f, -1.0f}) {
    History history;
    for (int frame = 0; frame < 5; ++frame) {
      Present p = frame_of(frame, 2, workers);
      const Window& w = p.color.window();
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x)
          if ((x * 7 + y * 3 + frame) % 5 == 0) {
            p.companions[0].at(x, y) = glm::vec4(extreme);
            if ((x + frame) % 2) p.color.at(x, y) = glm::vec4(extreme);
          }
      sanitize(p, workers);
      sanitize_companions(p, workers);
      history = accumulate(p, history, {}, {}, {}, 1, {}, workers).history;
      for (const Plane<glm::vec4>& plane : history.companions)
        for (int y = w.y0; y < w.y1; ++y)
          for (int x = w.x0; x < w.x1; ++x)
            for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(plane.at(x, y)[k])) << extreme;
    }
  }
}

TEST(Companions, SameBytesForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    Workers workers(threads);
    History history;
    for (int frame = 0; frame < 3; ++frame)
      history = accumulate(frame_of(frame, 2, workers), history, {}, {}, {}, 1, {}, workers).history;
    return history;
  };
  const History one = run(1), three = run(3);
  for (const std::size_t c : {0u, 1u}) EXPECT_TRUE(same_bits(one.companions[c], three.companions[c]));
}

}  // namespace
}  // namespace varve
