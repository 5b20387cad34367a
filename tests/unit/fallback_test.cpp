// The motion blur and the soft first frames: output only, and nothing where neither is called for.
#include "resolve/fallback.h"

#include <gtest/gtest.h>

#include <cfloat>

#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::noise_present;
using test::same_bits;

History history_of(const Window& w, const glm::vec4& color, float total) {
  History h;
  h.color = Plane<glm::vec4>(w, 0, color);
  h.total = Plane<float>(w, 0, total);
  h.spread = Plane<float>(w, 0, 1.0f);
  return h;
}

FallbackParameters blur(MotionBlur kind = MotionBlur::own) {
  FallbackParameters p;
  p.motion_blur = kind;
  return p;
}

/// One pixel, straight from the definition.
glm::dvec4 slow(const Present& p, const History& h, const FallbackParameters& f, int x, int y, glm::dvec2 v) {
  const Window& w = p.color.window();
  glm::dvec4 blurred(0.0);
  for (int i = -3; i <= 3; ++i) {
    const double px = std::clamp(x + v.x / 2 * i / 3, double(w.x0), double(w.x1 - 1));
    const double py = std::clamp(y + v.y / 2 * i / 3, double(w.y0), double(w.y1 - 1));
    glm::dvec4 sum(0.0);
    for (int b = w.y0; b < w.y1; ++b)
      for (int a = w.x0; a < w.x1; ++a)
        sum += glm::dvec4(p.color.at(a, b)) * std::max(0.0, 1 - std::abs(a - px)) * std::max(0.0, 1 - std::abs(b - py));
    blurred += sum / 7.0;
  }
  const double share = std::clamp((std::hypot(v.x, v.y) - f.blur_from) / (f.blur_to - f.blur_from), 0.0, 1.0);
  return glm::dvec4(h.color.at(x, y)) * (1 - share) + blurred * share;
}

TEST(Fallback, MotionBlurAgreesWithItsSlowTwin) {
  Workers workers(2);
  const Window w{-3, 2, 20, 15};
  const Present p = noise_present(w, {3, 0, 14, 0.05, false, 1}, workers);
  const History h = history_of(w, glm::vec4(0.3f, 0.2f, 0.1f, 1), 9);
  const Plane<glm::vec4> out = fall_back(p, h, blur(), workers);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::dvec2 v(p.motion.at(x, y));
      const glm::dvec4 expected = v.x == v.x ? slow(p, h, blur(), x, y, v) : glm::dvec4(h.color.at(x, y));
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(double(out.at(x, y)[k]), expected[k], 1e-5 * (1 + expected[k]));
    }
}

TEST(Fallback, SlowPixelsKeepTheirBitsAndFastOnesAreTheBlur) {
  Workers workers(1);
  const Window w{0, 0, 60, 20};
  Present p = noise_present(w, {3, 0, 0, 0, false, 1}, workers);
  const History h = history_of(w, glm::vec4(0.1f), 9);
  p.motion.fill(glm::vec2(2, 0));
  EXPECT_TRUE(same_bits(fall_back(p, h, blur(), workers), h.color));
  p.motion.at(50, 10) = glm::vec2(15, 0);
  p.motion.at(10, 10) = glm::vec2(8.5f, 0);
  p.color.fill(glm::vec4(3.0f));
  const Plane<glm::vec4> own = fall_back(p, h, blur(), workers);
  EXPECT_EQ(own.at(50, 10).r, 3.0f);
  EXPECT_NEAR(own.at(10, 10).r, 1.55f, 1e-5f);
  EXPECT_EQ(own.at(45, 10), h.color.at(45, 10));
  // The tiles around have a say, those further away do not.
  const Plane<glm::vec4> around = fall_back(p, h, blur(MotionBlur::neighbors), workers);
  EXPECT_EQ(around.at(21, 3).r, 3.0f);
  EXPECT_NEAR(around.at(2, 3).r, 1.55f, 1e-5f);
}

TEST(Fallback, YoungPixelsAreShownSoft) {
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  Present p = flat_present(w, glm::vec4(0.0f), workers);
  p.color.at(4, 4) = glm::vec4(16.0f);
  History h = history_of(w, glm::vec4(0.0f), 5);
  h.color.at(4, 4) = glm::vec4(16.0f);
  FallbackParameters f;
  f.young_frames = 4;
  EXPECT_TRUE(same_bits(fall_back(p, h, f, workers), h.color));
  for (const auto& [total, expected] : {std::pair{1.0f, 4.0f}, {2.0f, 7.0f}, {3.0f, 10.0f}, {5.0f, 16.0f}}) {
    h.total.fill(total);
    EXPECT_EQ(fall_back(p, h, f, workers).at(4, 4).r, expected);
  }
}

TEST(Fallback, ConstantsStayExactExtremesFiniteThreadsAndScaleChangeNothing) {
  Workers one(1), many(5);
  const Window w{0, 0, 43, 31};
  FallbackParameters f = blur(MotionBlur::neighbors);
  f.young_frames = 8;
  Present p = noise_present(w, {3, 0, 30, 0.05, false, 1}, one);
  p.motion.at(3, 3) = glm::vec2(1e9f, -1e9f);
  const History h = history_of(w, glm::vec4(0.5f), 3);
  EXPECT_TRUE(same_bits(fall_back(p, h, f, one), fall_back(p, h, f, many)));
  const Plane<glm::vec4> plain = fall_back(p, h, f, one);
  for (const float scale : {0.5f, 1048576.0f}) {
    Present scaled = noise_present(w, {3, 0, 30, 0.05, false, 1}, one);
    scaled.motion = p.motion.clone();
    for (int y = 0; y < 31; ++y)
      for (int x = 0; x < 43; ++x) scaled.color.at(x, y) = p.color.at(x, y) * scale;
    const Plane<glm::vec4> out = fall_back(scaled, history_of(w, glm::vec4(0.5f * scale), 3), f, one);
    for (int y = 0; y < 31; ++y)
      for (int x = 0; x < 43; ++x) ASSERT_EQ(out.at(x, y), plain.at(x, y) * scale);
  }
  for (const float value : {1e-30f, 65504.0f, 1e30f, FLT_MAX, -FLT_MAX, 3e-39f}) {
    p.color.fill(glm::vec4(value));
    sanitize(p, one);
    const Plane<glm::vec4> out = fall_back(p, history_of(w, glm::vec4(value), 3), f, one);
    for (int y = 0; y < 31; ++y)
      for (int x = 0; x < 43; ++x) ASSERT_EQ(out.at(x, y), glm::vec4(value));
  }
  EXPECT_TRUE(fall_back(p, h, {}, one).empty());
}

}  // namespace
}  // namespace varve
