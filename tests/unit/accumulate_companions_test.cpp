// Channels that go with a color: laws of the sum, of constants, of scale, of bad values.
#include "resolve/accumulate_companions.h"

#include <gtest/gtest.h>

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
            s.rectify = {box, 0.75, window, rule, anchor, space};
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
  return all;
}

/// A frame of a sequence: the window moves, some samples and vectors are bad.
Present frame_of(int frame, int lights, Workers& workers, float scale = 1) {
  const int shift = frame % 3;
  test::NoiseOptions noise;
  noise.seed = unsigned(100 + frame);
  noise.bad_motion = 0.02;
  noise.with_depth = true;
  noise.scale = scale;
  noise.motion = frame % 4 == 3 ? 0 : 2.5;
  Present p = noise_present({shift - 2, 3 - shift, 35 + shift, 30}, noise, workers);
  split_into_lights(p, lights, unsigned(frame));
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
    EXPECT_TRUE(s.rectify.box == Box::none || clipped > 500) << "nothing was put to the test";
  }
}

}  // namespace
}  // namespace varve
