// Edges smoothed by their shape: against the slow twin, against the area a contour truly covers, and what it must
// leave.
#include "resolve/morphology.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "reference/morphology_reference.h"
#include "resolve/fallback.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::noise_present;
using test::same_bits;

/// 1 below the line y = x * slope + 2.2, 0 above; sampled at pixel centers.
Plane<glm::vec4> slant(const Window& w, double slope, float bright = 1) {
  Plane<glm::vec4> color(w, 0, glm::vec4(0.0f));
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (y + 0.5 > (x + 0.5) * slope + 2.2) color.at(x, y) = glm::vec4(bright);
  return color;
}

/// The share of the pixel that lies below that line.
double covered(int x, int y, double slope) {
  double sum = 0;
  for (int i = 0; i < 64; ++i) sum += std::clamp(y + 1 - ((x + (i + 0.5) / 64) * slope + 2.2), 0.0, 1.0) / 64;
  return sum;
}

TEST(Morphology, AgreesWithItsSlowTwin) {
  Workers workers(2);
  const Window w{-3, 2, 42, 27};
  for (const int quantized : {0, 1}) {
    const Present p = noise_present(w, {3, 0, 0, 0, false, 1}, workers);
    Plane<glm::vec4> color(w);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x)  // blocks have edges to follow, noise has none
        color.at(x, y) = quantized
                             ? glm::vec4(p.color.at(x, y).r > 0.5f * float(1 + (x / 9 + y / 4) % 2) ? 2.0f : 0.25f)
                             : p.color.at(x, y);
    const Plane<glm::vec4> out = smooth_edges(color, workers);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const glm::dvec4 expected = reference::smoothed_pixel(color, x, y);
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(double(out.at(x, y)[k]), expected[k], 1e-5 * (1 + std::abs(expected[k]))) << x << ' ' << y;
      }
  }
}

TEST(Morphology, BringsASlantNearerToItsTrueCoverage) {
  Workers workers(1);
  const Window w{0, 0, 60, 30};
  for (const double slope : {0.11, 0.23, 0.4}) {
    const Plane<glm::vec4> raw = slant(w, slope), out = smooth_edges(raw, workers);
    double before = 0, after = 0;
    for (int y = 0; y < w.y1; ++y)
      for (int x = 10; x < 50; ++x) {
        const double truth = covered(x, y, slope);
        before += std::pow(double(raw.at(x, y).g) - truth, 2);
        after += std::pow(double(out.at(x, y).g) - truth, 2);
      }
    EXPECT_LT(after, 0.25 * before) << slope;  // 6 dB
  }
}

TEST(Morphology, LeavesWhatHasNoStairs) {
  Workers workers(1);
  const Window w{0, 0, 40, 24};
  Plane<glm::vec4> flat(w, 0, glm::vec4(0.3f, 0.2f, 0.7f, 1.0f)), straight = flat.clone(), ramp = flat.clone();
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      if (y >= 12) straight.at(x, y) = glm::vec4(5.0f);
      ramp.at(x, y) = glm::vec4(1.0f + 0.05f * float(x));
    }
  for (const Plane<glm::vec4>* picture : {&flat, &straight, &ramp})
    EXPECT_TRUE(same_bits(smooth_edges(*picture, workers), *picture));
}

TEST(Morphology, ScaleMirrorThreadsAndExtremes) {
  Workers one(1), many(5);
  const Window w{0, 0, 53, 31};
  const Plane<glm::vec4> raw = slant(w, 0.3), plain = smooth_edges(raw, one);
  EXPECT_TRUE(same_bits(plain, smooth_edges(raw, many)));
  for (const float scale : {0x1p-100f, 0.5f, 0x1p100f}) {
    const Plane<glm::vec4> out = smooth_edges(slant(w, 0.3, scale), one);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x) ASSERT_EQ(out.at(x, y), plain.at(x, y) * scale);
  }
  Plane<glm::vec4> turned(w);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) turned.at(x, y) = raw.at(w.x1 - 1 - x, w.y1 - 1 - y);
  const Plane<glm::vec4> mirrored = smooth_edges(turned, one);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) ASSERT_EQ(mirrored.at(x, y), plain.at(w.x1 - 1 - x, w.y1 - 1 - y));
  for (const float value : {FLT_MAX, -FLT_MAX, 1e30f, -1.0f, 3e-39f, 65504.0f}) {
    const Plane<glm::vec4> out = smooth_edges(slant(w, 0.3, value), one);
    for (int y = 0; y < w.y1; ++y)
      for (int x = 0; x < w.x1; ++x)
        for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(out.at(x, y)[k]));
  }
  for (const Window& tiny : {Window{0, 0, 0, 0}, {0, 0, 1, 1}, {5, 5, 6, 30}, {-9, 0, 40, 1}}) {
    const Plane<glm::vec4> picture(tiny, 0, glm::vec4(2.0f));
    EXPECT_TRUE(same_bits(smooth_edges(picture, one), picture));
  }
}

TEST(Morphology, StandsInForYoungPixelsOnly) {
  Workers workers(1);
  const Window w{0, 0, 40, 20};
  Present p;
  p.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0.0f));
  const Plane<glm::vec4> raw = slant(w, 0.2);
  for (int y = 0; y < w.y1; ++y) std::copy_n(raw.row(y), w.width(), p.color.row(y));
  sanitize(p, workers);
  History h;
  h.color = Plane<glm::vec4>(w, 0, glm::vec4(7.0f));
  h.total = Plane<float>(w, 0, 5.0f);
  FallbackParameters f;
  f.young_frames = 4;
  f.young_filter = YoungFilter::morphological;
  h.total.at(20, 6) = 1;
  const Plane<glm::vec4> out = fall_back(p, h, f, workers);
  EXPECT_EQ(out.at(20, 6), smooth_edges(raw, workers).at(20, 6));
  EXPECT_NE(out.at(20, 6), raw.at(20, 6));
  EXPECT_EQ(out.at(21, 6), glm::vec4(7.0f));
  // Where the jitter is known what stands in lies at the pixel centers.
  p.jitter = glm::dvec2(0.5, 0);
  const glm::vec4 moved = fall_back(p, h, f, workers).at(20, 6);
  const Plane<glm::vec4> smooth = smooth_edges(raw, workers);
  EXPECT_NEAR(moved.g, 0.5f * (smooth.at(19, 6).g + smooth.at(20, 6).g), 1e-6f);
}

}  // namespace
}  // namespace varve
