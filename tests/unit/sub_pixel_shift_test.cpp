// Shifts below a pixel between point-sampled pictures; detail that sticks to the screen; prints of frames.
#include "diagnose/sub_pixel_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "diagnose/color_print.h"
#include "diagnose/stuck_detail.h"
#include "reference/sub_pixel_shift_reference.h"
#include "support/scenes.h"

namespace varve {
namespace {

/// A picture without a filter: discs with hard edges and a soft ground, sampled at pixel + offset.
double scene_at(double x, double y) {
  double v = 0.4 + 0.2 * std::sin(0.31 * x) * std::cos(0.23 * y);
  for (int k = 0; k < 40; ++k) {
    const double cx = 13 + 97.0 * std::fmod(k * 0.618034, 1.0), cy = 9 + 71.0 * std::fmod(k * 0.754878, 1.0);
    const double r = 3 + 5 * std::fmod(k * 0.41421, 1.0);
    if ((x - cx) * (x - cx) + (y - cy) * (y - cy) < r * r) v = 0.1 + 0.8 * std::fmod(k * 0.7320508, 1.0);
  }
  return v;
}

Plane<glm::vec4> sampled(glm::dvec2 offset, double gain = 1) {
  Plane<glm::vec4> p({0, 0, 120, 90});
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x)
      p.at(x, y) = glm::vec4(glm::vec3(float(gain * scene_at(x + offset.x, y + offset.y))), 1);
  return p;
}

Plane<float> tone(const Plane<glm::vec4>& color, Workers& workers) {
  const Plane<float> valid(color.window(), 0, 1.0f);
  return tone_plane(color, valid, middle_luma(color, valid), workers);
}

TEST(SubPixelShift, IsFoundAtRestAndAlongAMove) {
  Workers workers(2);
  const Plane<float> before = tone(sampled({0.1, -0.2}), workers);
  for (const glm::dvec2 shift : {glm::dvec2(0, 0), {0.3, -0.4}, {-0.6, 0.25}, {0.5, 0.5}})
    for (const glm::dvec2 move : {glm::dvec2(0, 0), {2.3, -1.6}}) {
      // What is at x now was at x + move.
      const Plane<float> now = tone(sampled(glm::dvec2(0.1, -0.2) + shift + move), workers);
      const SubPixelShift s = measure_shift(now, before, Plane<glm::vec2>(now.window(), 0, glm::vec2(move)), workers);
      ASSERT_TRUE(s.found);
      EXPECT_NEAR(s.shift.x, shift.x, 0.08) << shift.x << " " << move.x;
      EXPECT_NEAR(s.shift.y, shift.y, 0.08) << shift.y << " " << move.y;
      EXPECT_LT(s.sigma.x + s.sigma.y, 0.2);
      if (move.x == 0 && shift.x == 0) {
        EXPECT_EQ(s.shift.x, 0);
        EXPECT_EQ(s.identical, 1);
        EXPECT_EQ(s.still, 1);
      } else {
        EXPECT_LT(s.identical, 0.9);
      }
    }
}

TEST(SubPixelShift, IsWhatTheSlowTwinFinds) {
  Workers workers(2);
  const Plane<glm::vec4> a = sampled({0.1, -0.2}), b = sampled({2.3 + 0.4, -1.6 + 0.1});
  // An odd part of the picture, and motion with a step in it.
  const Window w{-3, 5, 74, 58};
  Plane<glm::vec4> now(w), before(w);
  Plane<glm::vec2> motion(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      now.at(x, y) = b.at(x + 20, y + 10), before.at(x, y) = a.at(x + 20, y + 10);
      motion.at(x, y) = x + y < 20 ? glm::vec2(0.7f, 0.2f) : glm::vec2(2.3f, -1.6f);
    }
  const Plane<float> tone_now = tone(now, workers), tone_before = tone(before, workers);
  const SubPixelShift fast = measure_shift(tone_now, tone_before, motion, workers);
  const reference::Shift slow = reference::sub_pixel_shift(tone_now, tone_before, motion);
  ASSERT_TRUE(fast.found);
  EXPECT_NEAR(fast.shift.x, slow.shift.x, 2e-4);
  EXPECT_NEAR(fast.shift.y, slow.shift.y, 2e-4);
  EXPECT_NEAR(fast.sigma.x, slow.sigma.x, 0.01 * slow.sigma.x);
  EXPECT_NEAR(fast.sigma.y, slow.sigma.y, 0.01 * slow.sigma.y);
}

TEST(SubPixelShift, WhatMovesWithoutVectorsHardlyBendsIt) {
  Workers workers(2);
  const glm::dvec2 shift(0.3, -0.4);
  Plane<glm::vec4> before = sampled({}), now = sampled(shift);
  for (int y = 20; y < 60; ++y)  // a shadow that goes four pixels to the right
    for (int x = 0; x < 120; ++x) {
      if (x >= 30 && x < 60) before.at(x, y) *= 0.2f;
      if (x >= 34 && x < 64) now.at(x, y) *= 0.2f;
    }
  const SubPixelShift s = measure_shift(tone(now, workers), tone(before, workers), {}, workers);
  ASSERT_TRUE(s.found);
  EXPECT_NEAR(s.shift.x, shift.x, 0.1);
  EXPECT_NEAR(s.shift.y, shift.y, 0.1);
}

TEST(SubPixelShift, ExposureIsNothingAndThreadsAreNothing) {
  Workers one(1), three(3);
  const SubPixelShift a = measure_shift(tone(sampled({0.3, 0.1}), one), tone(sampled({}), one), {}, one);
  const SubPixelShift b =
      measure_shift(tone(sampled({0.3, 0.1}, 1024), three), tone(sampled({}, 1024), three), {}, three);
  EXPECT_EQ(std::memcmp(&a.shift, &b.shift, sizeof a.shift), 0);
  EXPECT_EQ(std::memcmp(&a.sigma, &b.sigma, sizeof a.sigma), 0);
}

TEST(SubPixelShift, FlatEmptyAndHostilePicturesTellNothing) {
  Workers workers(1);
  const Window w{0, 0, 40, 30};
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {0.0f, 1.0f, -3.0f, 3e38f, 1e-45f, inf, nan}) {
    const Plane<float> flat = tone(Plane<glm::vec4>(w, 0, glm::vec4(value)), workers);
    EXPECT_FALSE(measure_shift(flat, flat, {}, workers).found) << value;
    const Plane<float> raw(w, 0, value);
    EXPECT_FALSE(measure_shift(raw, raw, Plane<glm::vec2>(w, 0, glm::vec2(value)), workers).found) << value;
  }
  EXPECT_FALSE(measure_shift({}, {}, {}, workers).found);
  const Plane<float> tiny(Window{3, 3, 4, 4}, 0, 1.0f);
  EXPECT_FALSE(measure_shift(tiny, tiny, {}, workers).found);
  // One edge tells of one axis only.
  Plane<glm::vec4> edge(w, 0, glm::vec4(1));
  for (int y = 0; y < 30; ++y)
    for (int x = 20; x < 40; ++x) edge.at(x, y) = glm::vec4(3);
  EXPECT_FALSE(measure_shift(tone(edge, workers), tone(edge, workers), {}, workers).found);
}

TEST(StuckDetail, IsNoiseThatStaysWhileThePictureMoves) {
  Workers workers(2);
  const auto noisy = [](glm::dvec2 offset, unsigned seed) {
    Plane<glm::vec4> p = sampled(offset);
    unsigned state = seed;
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 120; ++x)
        p.at(x, y) +=
            glm::vec4(glm::vec3(0.4f * float((state = state * 1664525u + 1013904223u) >> 8) / 16777216.0f), 0);
    return p;
  };
  const Plane<glm::vec2> motion({0, 0, 120, 90}, 0, glm::vec2(4, 3));
  const Plane<float> before = tone(noisy({}, 7), workers);
  EXPECT_GT(stuck_detail(tone(noisy({4, 3}, 7), workers), before, motion, workers).correlation, 0.5);
  const StuckDetail fresh = stuck_detail(tone(noisy({4, 3}, 99), workers), before, motion, workers);
  EXPECT_LT(std::abs(fresh.correlation), 0.1);
  EXPECT_GT(fresh.pixels, 9000u);
  EXPECT_EQ(stuck_detail(before, before, Plane<glm::vec2>({0, 0, 120, 90}, 0, glm::vec2(0)), workers).pixels, 0u);
}

TEST(ColorPrint, TellsEveryBitAndIgnoresThreadsAndFlatness) {
  Workers one(1), three(3);
  Plane<glm::vec4> p = sampled({});
  const std::uint64_t print = color_print(p, one);
  EXPECT_EQ(print, color_print(p, three));
  EXPECT_NE(print, 0u);
  p.at(119, 89).a = std::nextafter(1.0f, 2.0f);
  EXPECT_NE(print, color_print(p, one));
  EXPECT_EQ(color_print(Plane<glm::vec4>({0, 0, 9, 9}, 0, glm::vec4(2)), one), 0u);
  EXPECT_EQ(color_print({}, one), 0u);
}

}  // namespace
}  // namespace varve
