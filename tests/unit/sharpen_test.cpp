// Sharpening of the output, and the present brought to the pixel centers: twins and laws.
#include "resolve/sharpen.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "reference/history_filter_reference.h"
#include "resolve/sample_weights.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::noise_present;
using test::same_bits;

constexpr Window kOdd{-3, 5, 34, 28};

struct Picture {
  Plane<glm::vec4> color;
  Plane<float> total;
};

Picture noise_picture(Workers& workers, double bad_share = 0.05) {
  test::NoiseOptions noise;
  noise.seed = 12;
  noise.bad_share = bad_share;
  Present p = noise_present(kOdd, noise, workers);
  History h = test::next_history(p, {}, {}, {}, workers);
  for (int y = kOdd.y0; y < kOdd.y1; y += 3) h.color.at(kOdd.x0 + 5, y).r *= -1.0f;
  return {std::move(h.color), std::move(h.total)};
}

TEST(Sharpen, AgreesWithItsTwin) {
  Workers workers(2);
  const Picture p = noise_picture(workers);
  for (const double strength : {0.0, 0.3, 1.0}) {
    const Plane<glm::vec4> fast = sharpen(p.color, p.total, strength, workers);
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) {
        const glm::dvec4 slow = reference::sharpened(p.color, p.total, strength, x, y);
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(double(fast.at(x, y)[k]), slow[k], 2e-7 * std::max(1.0, std::abs(slow[k]))) << x << "," << y;
      }
  }
  EXPECT_TRUE(same_bits(sharpen(p.color, p.total, 0, workers), p.color));
}

TEST(Sharpen, StaysInsideItsNeighborsAndKeepsAlpha) {
  Workers workers(1);
  const Picture p = noise_picture(workers, 0);
  const Plane<glm::vec4> out = sharpen(p.color, p.total, 1, workers);
  int changed = 0;
  for (int y = kOdd.y0; y < kOdd.y1; ++y)
    for (int x = kOdd.x0; x < kOdd.x1; ++x) {
      ASSERT_EQ(out.at(x, y).a, p.color.at(x, y).a);
      for (int k = 0; k < 3; ++k) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (int j = y - 1; j <= y + 1; ++j)
          for (int i = x - 1; i <= x + 1; ++i)
            if (kOdd.contains(i, j))
              low = std::min(low, p.color.at(i, j)[k]), high = std::max(high, p.color.at(i, j)[k]);
        ASSERT_GE(out.at(x, y)[k], low);
        ASSERT_LE(out.at(x, y)[k], high);
        changed += out.at(x, y)[k] != p.color.at(x, y)[k];
      }
    }
  EXPECT_GT(changed, 500);
}

TEST(Sharpen, MakesASoftEdgeSteeper) {
  Workers workers(1);
  const Window w{0, 0, 9, 3};
  Picture p{Plane<glm::vec4>(w), Plane<float>(w, 0, 1.0f)};
  const float profile[] = {1.0f, 1.0f, 1.02f, 1.1f, 1.25f, 1.4f, 1.48f, 1.5f, 1.5f};
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 9; ++x) p.color.at(x, y) = glm::vec4(profile[x]);
  const Plane<glm::vec4> out = sharpen(p.color, p.total, 1, workers);
  EXPECT_LT(out.at(3, 1).r, 1.1f);
  EXPECT_GT(out.at(5, 1).r, 1.4f);
  EXPECT_GT(out.at(5, 1).r - out.at(3, 1).r, 0.3f);
}

TEST(Sharpen, KnowsNoScaleAndNoExtreme) {
  Workers one(1), many(5);
  const Picture p = noise_picture(one);
  const Plane<glm::vec4> plain = sharpen(p.color, p.total, 0.7, one);
  EXPECT_TRUE(same_bits(plain, sharpen(p.color, p.total, 0.7, many)));
  for (const float scale : {0x1p40f, 0x1p-40f, 0x1p-100f}) {
    Plane<glm::vec4> scaled = p.color.clone();
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) scaled.at(x, y) *= scale;
    const Plane<glm::vec4> out = sharpen(scaled, p.total, 0.7, one);
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) ASSERT_EQ(out.at(x, y), plain.at(x, y) * scale);
  }
  Plane<glm::vec4> extreme = p.color.clone();
  const float values[] = {FLT_MAX, -FLT_MAX, 1e30f, 65504.0f, 1e-38f, 1e-45f, -0.0f, 0.0f, -1.0f};
  for (int y = kOdd.y0; y < kOdd.y1; ++y)
    for (int x = kOdd.x0; x < kOdd.x1; ++x) extreme.at(x, y) = glm::vec4(values[(x * 7 + y * 5 + 100) % 9]);
  const Plane<glm::vec4> out = sharpen(extreme, p.total, 1, one);
  for (int y = kOdd.y0; y < kOdd.y1; ++y)
    for (int x = kOdd.x0; x < kOdd.x1; ++x) ASSERT_TRUE(std::isfinite(out.at(x, y).r)) << x << "," << y;
  for (const float value : {1.0f, 1e-30f, 3e-39f, 65504.0f, -0.7f, 3e38f}) {
    const Plane<glm::vec4> flat(kOdd, 0, glm::vec4(value));
    EXPECT_TRUE(same_bits(sharpen(flat, p.total, 1, one), flat));
  }
}

TEST(Unjitter, AgreesWithItsTwinAndKeepsAConstant) {
  Workers workers(2);
  test::NoiseOptions noise;
  noise.bad_share = 0.05;
  const Present p = noise_present(kOdd, noise, workers);
  for (const glm::dvec2 jitter :
       {glm::dvec2(0.31, -0.22), glm::dvec2(0, 0), glm::dvec2(-0.5, 0.5), glm::dvec2(1, -1)}) {
    const Plane<glm::vec4> fast = unjitter_bilinear(p, jitter, workers);
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) {
        const glm::dvec4 slow = reference::unjittered(p, jitter, x, y);
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(double(fast.at(x, y)[k]), slow[k], 3e-7 * std::max(200.0, slow[k])) << x << "," << y;
      }
  }
  const glm::vec4 value(0.1f, 1e-30f, 65504.0f, 1.0f);
  const Present flat = flat_present(kOdd, value, workers);
  const Plane<glm::vec4> out = unjitter_bilinear(flat, {0.3, -0.1}, workers);
  for (int y = kOdd.y0; y < kOdd.y1; ++y)
    for (int x = kOdd.x0; x < kOdd.x1; ++x) ASSERT_EQ(out.at(x, y), value);
}

TEST(Unjitter, KnowsNoScaleNoThreadAndNoExtreme) {
  Workers one(1), many(5);
  test::NoiseOptions noise;
  noise.bad_share = 0.05;
  Present p = noise_present(kOdd, noise, one);
  const glm::dvec2 jitter(0.31, -0.22);
  const Plane<glm::vec4> plain = unjitter_bilinear(p, jitter, one);
  EXPECT_TRUE(same_bits(plain, unjitter_bilinear(p, jitter, many)));
  for (const float scale : {0x1p40f, 0x1p-80f}) {
    Present scaled = noise_present(kOdd, noise, one);
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) scaled.color.at(x, y) = p.color.at(x, y) * scale;
    const Plane<glm::vec4> out = unjitter_bilinear(scaled, jitter, one);
    for (int y = kOdd.y0; y < kOdd.y1; ++y)
      for (int x = kOdd.x0; x < kOdd.x1; ++x) ASSERT_EQ(out.at(x, y), plain.at(x, y) * scale);
  }
  const float values[] = {FLT_MAX, -FLT_MAX, 1e30f, 65504.0f, 1e-38f, 1e-45f, -0.0f, 0.0f};
  for (int y = kOdd.y0; y < kOdd.y1; ++y)
    for (int x = kOdd.x0; x < kOdd.x1; ++x) p.color.at(x, y) = glm::vec4(values[(x * 7 + y * 5 + 100) % 8]);
  const Plane<glm::vec4> extreme = unjitter_bilinear(p, jitter, one);
  for (int y = kOdd.y0; y < kOdd.y1; ++y)
    for (int x = kOdd.x0; x < kOdd.x1; ++x) ASSERT_TRUE(std::isfinite(extreme.at(x, y).r)) << x << "," << y;
}

TEST(Unjitter, PutsARampWhereItBelongs) {
  // A ramp of 1 per pixel seen at p + jitter reads x + jitter; at the centers it is x again.
  Workers workers(1);
  const Window w{0, 0, 20, 10};
  const glm::dvec2 jitter(0.375, -0.25);
  Present p = flat_present(w, glm::vec4(0.0f), workers);
  for (int y = 0; y < w.y1; ++y)
    for (int x = 0; x < w.x1; ++x) p.color.at(x, y) = glm::vec4(float(x + jitter.x), float(y + jitter.y), 0, 1);
  RecursiveParameters recursive;
  recursive.unjitter = Unjitter::bilinear;
  const History h = accumulate(p, {}, recursive, {}, jitter, 1, {}, workers).history;
  for (int y = 1; y < w.y1 - 1; ++y)
    for (int x = 1; x < w.x1 - 1; ++x) {
      ASSERT_NEAR(double(h.color.at(x, y).r), x, 2e-6);
      ASSERT_NEAR(double(h.color.at(x, y).g), y, 2e-6);
      ASSERT_EQ(h.total.at(x, y), 1.0f);  // the weight of a frame is not touched
    }
  const History plain = accumulate(p, {}, recursive, {}, {}, 1, {}, workers).history;  // nothing to undo
  EXPECT_TRUE(same_bits(plain.color, test::next_history(p, {}, {}, {}, workers).color));
}

}  // namespace
}  // namespace varve
