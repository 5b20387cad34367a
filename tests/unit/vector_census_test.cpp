// What stored vectors look like: clamped, premultiplied, antialiased, constant, zero.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "motion/vector_census.h"

namespace varve {
namespace {

constexpr Window kWindow{-3, 5, 77, 53};

Plane<float> plane(const std::function<double(int x, int y)>& value) {
  Plane<float> p(kWindow);
  for (int y = kWindow.y0; y < kWindow.y1; ++y)
    for (int x = kWindow.x0; x < kWindow.x1; ++x) p.at(x, y) = float(value(x, y));
  return p;
}

VectorCensus census(const Plane<float>& x, const Plane<float>& y, const Plane<float>& alpha = {}) {
  VectorCensus c;
  add_frame(c, x, y, alpha);
  return c;
}

double smooth(int x, int y) { return 0.07 * x + 0.01 * y * y; }
double other(int x, int y) { return 0.05 * y - 0.02 * x; }

TEST(VectorCensus, ZeroAndConstant) {
  const Plane<float> zero = plane([](int, int) { return 0; }), half = plane([](int, int) { return 0.5; });
  EXPECT_TRUE(census(zero, zero).all_zero());
  EXPECT_FALSE(census(zero, half).all_zero());
  EXPECT_TRUE(census(half, zero).constant(0));
  EXPECT_FALSE(census(half, zero).constant(1));
  EXPECT_FALSE(census(plane(smooth), zero).constant(0));
}

TEST(VectorCensus, ClampedIsAPileAtTheEndOfWhatVaries) {
  const auto clamped = [](int x, int y) { return std::min(smooth(x, y), 9.0); };
  EXPECT_TRUE(census(plane(clamped), plane(other)).clamped(0));
  EXPECT_FALSE(census(plane(smooth), plane(other)).clamped(0));
  EXPECT_FALSE(census(plane(clamped), plane(other)).clamped(1));
  // A flat thing that slides has one vector, and is the fastest.
  const auto slides = [](int x, int y) { return x > 20 && x < 60 && y > 20 && y < 40 ? 7.0 : 0.01 * x; };
  const auto falls = [](int x, int y) { return x > 20 && x < 60 && y > 20 && y < 40 ? -2.0 : 0.01 * y; };
  EXPECT_FALSE(census(plane(slides), plane(falls)).clamped(0));
}

TEST(VectorCensus, PremultipliedFollowsAlpha) {
  const auto alpha = [](int x, int) { return x < 20 ? 1.0 : x > 22 ? 0.0 : 1 - 0.25 * (x - 19); };
  const auto whole = [](int x, int) { return x > 22 ? 0.0 : 6.0; };
  const auto weighed = [&](int x, int y) { return 6 * alpha(x, y); };
  const VectorCensus by_alpha = census(plane(weighed), plane(weighed), plane(alpha));
  EXPECT_TRUE(by_alpha.premultiplied());
  EXPECT_FALSE(census(plane(whole), plane(whole), plane(alpha)).premultiplied());
  EXPECT_FALSE(census(plane(weighed), plane(weighed)).premultiplied()) << "without alpha nothing is known";
}

TEST(VectorCensus, AntialiasedLiesBetweenBothSides) {
  const auto sharp = [](int x, int) { return x < 30 ? 4.0 : -3.0; };
  const auto mixed = [](int x, int) { return x < 30 ? 4.0 : x == 30 ? 0.4 : -3.0; };
  EXPECT_FALSE(census(plane(sharp), plane(sharp)).antialiased());
  EXPECT_TRUE(census(plane(mixed), plane(mixed)).antialiased());
  EXPECT_FALSE(census(plane(smooth), plane(other)).antialiased());
}

TEST(VectorCensus, ValuesThatAreNotFiniteAreCountedAndHaveNoSay) {
  Plane<float> x = plane(smooth), y = plane(other);
  x.at(0, 10) = std::nanf("");
  y.at(1, 10) = -INFINITY;
  const VectorCensus c = census(x, y);
  EXPECT_EQ(c.not_finite, 2u);
  EXPECT_TRUE(std::isfinite(c.greatest[0]) && std::isfinite(c.least[1]));
}

}  // namespace
}  // namespace varve
