// Motion: decoding, inversion of forward vectors, dilation.
#include "motion/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion/dilate.h"
#include "reference/accumulate_reference.h"
#include "support/scenes.h"

namespace varve {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

TEST(Motion, EveryUnitDecodesToPixels) {
  Workers workers(1);
  const Window display{0, 0, 200, 100}, w{0, 0, 1, 1};
  const Plane<float> x(w, 0, 0.25f), y(w, 0, -0.5f);
  std::size_t bad = 0;
  MotionEncoding e;
  e.sign_y = -1;
  const auto decode = [&] { return decode_motion(x, y, e, display, 1e4, workers, bad).at(0, 0); };
  EXPECT_EQ(decode(), glm::vec2(0.25f, 0.5f));
  e.unit = MotionUnit::unit;
  EXPECT_EQ(decode(), glm::vec2(50.0f, 50.0f));
  e.unit = MotionUnit::ndc;
  EXPECT_EQ(decode(), glm::vec2(25.0f, 25.0f));
  e.unit = MotionUnit::pixel;
  e.bias = 0.5;
  e.scale = 8;
  e.shutter = 0.5;
  EXPECT_EQ(decode(), glm::vec2(-4.0f, 16.0f));
  EXPECT_EQ(bad, 0u);
}

TEST(Motion, UnusableVectorsBecomeNaNAndAreCounted) {
  Workers workers(1);
  const Window w{0, 0, 5, 1};
  Plane<float> x(w, 0, 0.0f), y(w, 0, 0.0f);
  x.at(1, 0) = kNaN;
  y.at(2, 0) = kInf;
  x.at(3, 0) = 1e30f;
  x.at(4, 0) = 100.0f;
  std::size_t bad = 0;
  const Plane<glm::vec2> m = decode_motion(x, y, {}, w, 99.0, workers, bad);
  EXPECT_EQ(bad, 4u);
  EXPECT_EQ(m.at(0, 0), glm::vec2(0.0f));
  for (int i = 1; i < 5; ++i) EXPECT_TRUE(std::isnan(m.at(i, 0).x) && std::isnan(m.at(i, 0).y));
}

TEST(Motion, BackgroundDepthIsInfinity) {
  Workers workers(1);
  const Window w{0, 0, 8, 1};
  const float stored[8] = {3, 0, -1, 1e10f, kInf, kNaN, -kInf, 9.9e9f};
  Plane<float> z(w);
  for (int i = 0; i < 8; ++i) z.at(i, 0) = stored[i];
  canonical_depth(z, DepthKind::distance, 1e10, workers);
  EXPECT_EQ(z.at(0, 0), 3.0f);
  for (int i = 1; i < 7; ++i) EXPECT_EQ(z.at(i, 0), kInf) << i;
  EXPECT_EQ(z.at(7, 0), 9.9e9f);
  Plane<float> inverse(w, 0, 0.25f), negative(w, 0, -4.0f);
  inverse.at(1, 0) = 0;
  canonical_depth(inverse, DepthKind::inverse, 1e10, workers);
  canonical_depth(negative, DepthKind::negative, 1e10, workers);
  EXPECT_EQ(inverse.at(0, 0), 4.0f);
  EXPECT_EQ(inverse.at(1, 0), kInf);
  EXPECT_EQ(negative.at(0, 0), 4.0f);
}

TEST(Motion, DilationAgreesWithItsSlowTwin) {
  Workers workers(2);
  for (const Window w : {Window{0, 0, 31, 17}, Window{-5, 3, -4, 20}, Window{0, 0, 2, 1}})
    for (const Dilation dilation : {Dilation::none, Dilation::nearest, Dilation::longest}) {
      const Present p = test::noise_present(w, {4, 0, 5, 0.2, true, 1}, workers);
      const DilatedMotion d = dilate_motion(p.motion.clone(), p.depth, dilation, workers);
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
          const glm::vec2 slow = reference::dilated_motion(p.motion, p.depth, dilation, x, y), fast = d.motion.at(x, y);
          ASSERT_TRUE(slow == fast || (std::isnan(slow.x) && std::isnan(fast.x))) << x << "," << y;
        }
    }
}

TEST(Motion, DilationThatKeepsSurfacesApartAgreesWithItsSlowTwin) {
  Workers workers(2);
  for (const Window w : {Window{0, 0, 31, 17}, Window{-5, 3, -4, 20}, Window{0, 0, 2, 1}})
    for (const Dilation dilation : {Dilation::none, Dilation::nearest, Dilation::longest}) {
      Present p = test::noise_present(w, {4, 0, 5, 0.2, true, 1}, workers);
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x)
          if ((x * 7 + y * 3) % 5 < 2) p.depth.at(x, y) = kInf;
      const DilatedMotion d = dilate_surfaces_apart(p.motion.clone(), p.depth, dilation, workers);
      const bool apart = dilation == Dilation::longest;
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
          const glm::vec2 slow = reference::dilated_motion(p.motion, p.depth, dilation, x, y, apart);
          const glm::vec2 fast = d.motion.at(x, y);
          ASSERT_TRUE(slow == fast || (std::isnan(slow.x) && std::isnan(fast.x))) << x << "," << y;
        }
    }
}

TEST(Motion, AThingAtRestDoesNotFollowTheSkyThatACameraMoves) {
  Workers workers(1);
  const Window w{0, 0, 5, 1};
  Plane<glm::vec2> motion(w, 0, glm::vec2(9, 0));
  Plane<float> depth(w, 0, kInf);
  motion.at(1, 0) = glm::vec2(1, 0), depth.at(1, 0) = 5;
  motion.at(2, 0) = glm::vec2(0, 2), depth.at(2, 0) = 4;
  const DilatedMotion d = dilate_surfaces_apart(motion.clone(), depth, Dilation::longest, workers);
  EXPECT_EQ(d.motion.at(0, 0), glm::vec2(1, 0));
  EXPECT_EQ(d.motion.at(1, 0), glm::vec2(0, 2));
  EXPECT_EQ(d.depth.at(1, 0), 4.0f);
  EXPECT_EQ(d.motion.at(2, 0), glm::vec2(0, 2));
  EXPECT_EQ(d.motion.at(3, 0), glm::vec2(0, 2));
  EXPECT_EQ(d.motion.at(4, 0), glm::vec2(9, 0));
  EXPECT_EQ(dilate_motion(motion.clone(), depth, Dilation::longest, workers).motion.at(1, 0), glm::vec2(9, 0));
}

TEST(Motion, DilationTakesTheDepthOfTheChosenPixel) {
  Workers workers(1);
  const Window w{0, 0, 3, 1};
  Plane<glm::vec2> motion(w, 0, glm::vec2(0.0f));
  Plane<float> depth(w, 0, 9.0f);
  motion.at(2, 0) = glm::vec2(4, 0);
  depth.at(2, 0) = 1;
  for (const Dilation dilation : {Dilation::nearest, Dilation::longest}) {
    const DilatedMotion d = dilate_motion(motion.clone(), depth, dilation, workers);
    EXPECT_EQ(d.motion.at(1, 0), glm::vec2(4, 0));
    EXPECT_EQ(d.depth.at(1, 0), 1.0f);
    EXPECT_EQ(d.motion.at(0, 0), glm::vec2(0.0f));
    EXPECT_EQ(d.depth.at(0, 0), 9.0f);
  }
}

TEST(Motion, DilationCarriesIdAndNormalWithTheVector) {
  Workers workers(1);
  const Window w{-2, 5, 11, 14};
  for (const Dilation dilation : {Dilation::none, Dilation::nearest, Dilation::longest}) {
    const Present p = test::noise_present(w, {4, 0, 5, 0.2, true, 1}, workers);
    // Each pixel's own place as its id and its normal: what comes out tells which pixel lent its vector.
    SurfaceMarks marks{Plane<std::uint32_t>(w), Plane<glm::vec3>(w)};
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        marks.id.at(x, y) = std::uint32_t((y + 10) * 1000 + x + 10);
        marks.normal.at(x, y) = glm::vec3(float(x), float(y), 1.0f);
      }
    const DilatedMotion d = dilate_motion(p.motion.clone(), p.depth, dilation, workers, std::move(marks));
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const int lx = int(d.marks.id.at(x, y) % 1000) - 10, ly = int(d.marks.id.at(x, y) / 1000) - 10;
        ASSERT_TRUE(std::abs(lx - x) <= 1 && std::abs(ly - y) <= 1 && w.contains(lx, ly));
        const glm::vec2 lent = p.motion.at(lx, ly), got = d.motion.at(x, y);
        ASSERT_TRUE(lent == got || (std::isnan(lent.x) && std::isnan(got.x)));
        ASSERT_EQ(d.depth.at(x, y), p.depth.at(lx, ly));
        ASSERT_EQ(d.marks.normal.at(x, y), glm::vec3(float(lx), float(ly), 1.0f));
      }
  }
}

TEST(Motion, InvertingAUniformMoveGivesItsOpposite) {
  const Window before{0, 0, 20, 10}, now{6, 0, 26, 10};
  for (const glm::vec2 move : {glm::vec2(3, 0), glm::vec2(2.5f, -0.75f), glm::vec2(0.0f)}) {
    const Plane<glm::vec2> then(before, 0, move), unused(now, 0, glm::vec2(99.0f));
    const Plane<glm::vec2> backward = invert_forward_motion(then, {}, unused);
    for (int y = 2; y < 8; ++y)
      for (int x = 7; x < 19; ++x) EXPECT_EQ(backward.at(x, y), -move) << x << "," << y;
    EXPECT_EQ(backward.at(25, 5), glm::vec2(-99.0f));  // nothing landed there: this frame's own vector, turned round
  }
}

TEST(Motion, InvertingLetsTheNearestSurfaceWinAndIgnoresBadVectors) {
  const Window w{0, 0, 12, 3};
  Plane<glm::vec2> then(w, 0, glm::vec2(0.0f));
  Plane<float> depth(w, 0, 9.0f);
  then.at(2, 1) = glm::vec2(5, 0);  // a near thing moves over the background
  depth.at(2, 1) = 1;
  then.at(9, 1) = glm::vec2(kNaN);
  then.at(10, 1) = glm::vec2(1e30f, 0);
  const Plane<glm::vec2> backward = invert_forward_motion(then, depth, Plane<glm::vec2>(w, 0, glm::vec2(1, 1)));
  EXPECT_EQ(backward.at(7, 1), glm::vec2(-5, 0));
  EXPECT_EQ(backward.at(2, 1), glm::vec2(-1, -1));  // uncovered
  EXPECT_EQ(backward.at(9, 1), glm::vec2(-1, -1));
  EXPECT_EQ(backward.at(5, 0), glm::vec2(0.0f));
}

TEST(Motion, InvertingIsTheSameInBothDirectionsOfTimeAndLeavesHoles) {
  const Window w{0, 0, 16, 5};
  // A near thing at columns 4..6 of the next frame came from 2 pixels to the left; the rest stood still.
  Plane<glm::vec2> backward(w, 0, glm::vec2(0.0f));
  Plane<float> depth_there(w, 0, 9.0f), depth_here(w, 0, 9.0f);
  for (int y = 0; y < 5; ++y)
    for (int x = 4; x <= 6; ++x) {
      backward.at(x, y) = glm::vec2(-2, 0);
      depth_there.at(x, y) = 1;
      depth_here.at(x - 2, y) = 1;
    }
  const auto holes = [&] { return Plane<glm::vec2>(w, 0, glm::vec2(kNaN)); };
  const Plane<glm::vec2> forward = invert_motion(backward, depth_there, depth_here, 0.05, holes());
  for (int x = 0; x < 16; ++x) {
    const glm::vec2 v = forward.at(x, 2);
    if (x >= 2 && x <= 4)
      EXPECT_EQ(v, glm::vec2(2, 0)) << x;
    else if (x == 5 || x == 6)
      EXPECT_TRUE(std::isnan(v.x)) << x << ": hidden in the next frame";
    else
      EXPECT_EQ(v, glm::vec2(0.0f)) << x;
  }
  // Background that lands where something else is seen did not come from there.
  depth_there = Plane<float>(w, 0, 9.0f);
  EXPECT_TRUE(std::isnan(invert_motion(backward, depth_there, depth_here, 0.05, holes()).at(3, 2).x));
  EXPECT_FALSE(std::isnan(invert_motion(backward, depth_there, {}, 0.05, holes()).at(3, 2).x)) << "not tested";
}

TEST(Motion, VectorsThatDoNotLeadBackAreRejected) {
  Workers workers(2);
  const Window w{0, 0, 12, 3};
  Plane<glm::vec2> motion(w, 0, glm::vec2(2, 0)), back(w, 0, glm::vec2(-2, 0));
  back.at(5, 1) = glm::vec2(-2.4f, 0);      // misses by less than half a pixel
  back.at(6, 1) = glm::vec2(-2.6f, 0);      // by more
  back.at(7, 1) = glm::vec2(kNaN);          // unknown
  motion.at(0, 0) = glm::vec2(kNaN, kNaN);  // stays what it is
  motion.at(1, 0) = glm::vec2(1e30f, 0);
  reject_one_way_motion(motion, back, 0.5, workers);
  EXPECT_EQ(motion.at(3, 1), glm::vec2(2, 0));
  EXPECT_TRUE(std::isnan(motion.at(4, 1).x));
  EXPECT_EQ(motion.at(5, 1), glm::vec2(2, 0));
  EXPECT_EQ(motion.at(11, 1), glm::vec2(2, 0)) << "it leaves the window";
  EXPECT_EQ(motion.at(1, 0).x, 1e30f);
  // Long vectors may miss by a hundredth of their length.
  Plane<glm::vec2> fast(w, 0, glm::vec2(0, 0)), other(w, 0, glm::vec2(0, 0));
  fast.at(0, 1) = glm::vec2(11, 0);
  other.at(11, 1) = glm::vec2(-11.12f, 0);
  reject_one_way_motion(fast, other, 0.01, workers);
  EXPECT_EQ(fast.at(0, 1), glm::vec2(11, 0));
}

}  // namespace
}  // namespace varve
