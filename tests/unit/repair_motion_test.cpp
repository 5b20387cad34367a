#include "motion/repair_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "reference/vector_residual_reference.h"

namespace varve {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// One frame with everything that a test of vectors may know.
struct Frame {
  Plane<float> light, depth;
  Plane<std::uint32_t> id;
  Plane<glm::vec2> motion;
  glm::dvec2 jitter{0};

  explicit Frame(const Window& w) : light(w), depth(w), id(w), motion(w, 0, glm::vec2(0.0f)) {}
  SeenFrame view(bool ids = true, bool depths = true) const {
    return {&light, depths ? &depth : nullptr, ids ? &id : nullptr, jitter};
  }
};

double pattern(double x, double y) {
  return 0.4 + 0.15 * std::sin(0.71 * x + 0.33 * y) + 0.12 * std::sin(-0.42 * x + 0.93 * y + 1) +
         0.1 * std::sin(1.13 * x - 0.57 * y + 2);
}

/// A textured wall that rests, and before it a textured square that moves by (3.25, -1.5) a frame.
constexpr glm::dvec2 kStep{3.25, -1.5};
Frame moving_square(const Window& w, int time, glm::dvec2 jitter, double scale = 1) {
  Frame f(w);
  f.jitter = jitter;
  const glm::dvec2 corner = glm::dvec2(12, 20) + double(time) * kStep;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) + jitter, inside = at - corner;
      const bool square = inside.x >= 0 && inside.y >= 0 && inside.x < 30 && inside.y < 26;
      f.id.at(x, y) = square ? 7 : 1;
      f.depth.at(x, y) = square ? 4 : 10;
      f.light.at(x, y) = float(scale * (square ? pattern(inside.x + 300, inside.y) : 0.7 * pattern(at.x, at.y)));
    }
  return f;
}

void give_right_vectors(Frame& f) {
  const Window& w = f.motion.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) f.motion.at(x, y) = f.id.at(x, y) == 7 ? glm::vec2(-kStep) : glm::vec2(0.0f);
}

const Window kSmall{-3, 2, 77, 66};
const RepairParameters kOn{.mode = RepairMotion::on};
const Plane<glm::vec2> kNone;

double mean_miss(const Frame& f, const Plane<glm::vec2>& motion) {
  double sum = 0, count = 0;
  for (int y = kSmall.y0; y < kSmall.y1; ++y)
    for (int x = kSmall.x0; x < kSmall.x1; ++x)
      if (f.id.at(x, y) == 7) {
        const glm::dvec2 off = glm::dvec2(motion.at(x, y)) + kStep;
        sum += std::hypot(off.x, off.y), ++count;
      }
  return sum / count;
}

class RepairMotionTest : public testing::Test {
 protected:
  Workers workers{2};
};

TEST_F(RepairMotionTest, RightVectorsStayBitForBit) {
  const Frame there = moving_square(kSmall, 0, {0.2, -0.3});
  Frame here = moving_square(kSmall, 1, {-0.1, 0.4});
  give_right_vectors(here);
  for (const bool ids : {true, false})
    for (const bool depths : {true, false}) {
      Plane<glm::vec2> motion = here.motion.clone();
      const MotionRepair said =
          repair_motion(motion, here.view(ids, depths), there.view(ids, depths), kNone, kNone, kOn, workers);
      EXPECT_EQ(0, std::memcmp(motion.row(kSmall.y0), here.motion.row(kSmall.y0), here.motion.bytes()));
      EXPECT_EQ(said.count[0], kSmall.pixels());
    }
}

TEST_F(RepairMotionTest, AnObjectWithoutVectorsFollowsItsPixels) {
  const Frame there = moving_square(kSmall, 0, {0.2, -0.3}), here = moving_square(kSmall, 1, {-0.1, 0.4});
  for (const bool ids : {true, false}) {  // without ids depth tells the square from the wall
    Plane<glm::vec2> motion = here.motion.clone();
    const MotionRepair said = repair_motion(motion, here.view(ids), there.view(ids), kNone, kNone, kOn, workers);
    EXPECT_LT(mean_miss(here, motion), 0.25);
    const auto row =
        std::find_if(said.surfaces.begin(), said.surfaces.end(), [](const SurfaceVectors& s) { return s.wrong; });
    ASSERT_NE(row, said.surfaces.end());
    if (ids) {
      EXPECT_EQ(row->label, 7u);
    }
    EXPECT_EQ(row->zero, row->pixels);
    EXPECT_NEAR(row->found.x, -kStep.x, 0.25);
    EXPECT_NEAR(row->found.y, -kStep.y, 0.25);
    EXPECT_EQ(motion.at(70, 60), glm::vec2(0.0f));  // the wall keeps its own
  }
}

TEST_F(RepairMotionTest, CheckTellsAndChangesNothing) {
  const Frame there = moving_square(kSmall, 0, {0, 0}), here = moving_square(kSmall, 1, {0, 0});
  Plane<glm::vec2> motion = here.motion.clone();
  const MotionRepair said =
      repair_motion(motion, here.view(), there.view(), kNone, kNone, {.mode = RepairMotion::check}, workers);
  EXPECT_GT(said.count[std::size_t(RepairedBy::search)], 700u);
  EXPECT_EQ(0, std::memcmp(motion.row(kSmall.y0), here.motion.row(kSmall.y0), here.motion.bytes()));
}

TEST_F(RepairMotionTest, TheCameraGoesFirstWhereItExplainsThePixels) {
  const Frame there = moving_square(kSmall, 0, {0, 0}), here = moving_square(kSmall, 1, {0, 0});
  Plane<glm::vec2> camera(kSmall, 0, glm::vec2(-kStep)), motion = here.motion.clone();
  const MotionRepair right = repair_motion(motion, here.view(), there.view(), kNone, camera, kOn, workers);
  EXPECT_GT(right.count[std::size_t(RepairedBy::camera)], 700u);
  EXPECT_EQ(mean_miss(here, motion), 0);
  camera = Plane<glm::vec2>(kSmall, 0, glm::vec2(9.0f, 9.0f));
  motion = here.motion.clone();
  const MotionRepair wrong = repair_motion(motion, here.view(), there.view(), kNone, camera, kOn, workers);
  EXPECT_EQ(wrong.count[std::size_t(RepairedBy::camera)], 0u);
  EXPECT_LT(mean_miss(here, motion), 0.25);
}

TEST_F(RepairMotionTest, UnusableVectorsFollowTheirSurface) {
  const Frame there = moving_square(kSmall, 0, {0, 0});
  Frame here = moving_square(kSmall, 1, {0, 0});
  give_right_vectors(here);
  for (int y = 24; y < 40; y += 3)
    for (int x = 18; x < 40; x += 4) here.motion.at(x, y) = glm::vec2(kNaN);
  Plane<glm::vec2> motion = here.motion.clone();
  const MotionRepair said = repair_motion(motion, here.view(), there.view(), kNone, kNone, kOn, workers);
  EXPECT_EQ(said.count[std::size_t(RepairedBy::neighbor)], said.census.unusable);
  EXPECT_EQ(mean_miss(here, motion), 0);
}

TEST_F(RepairMotionTest, WhatIsNowhereIsDropped) {
  // The frame before has the wall only, and the square claims to have rested.
  Frame there = moving_square(kSmall, 100, {0, 0});
  const Frame here = moving_square(kSmall, 1, {0, 0});
  Plane<glm::vec2> motion = here.motion.clone();
  const MotionRepair said = repair_motion(motion, here.view(), there.view(), kNone, kNone, kOn, workers);
  EXPECT_GT(said.count[std::size_t(RepairedBy::dropped)], 700u);
  EXPECT_FALSE(motion.at(30, 30).x == motion.at(30, 30).x);
  EXPECT_EQ(motion.at(70, 60), glm::vec2(0.0f));
}

TEST_F(RepairMotionTest, ChangingLightIsNoWrongVector) {
  // A shadow slides over a resting wall, and every sample has noise of its own.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  Frame there = moving_square(kSmall, 100, {0.2, 0.1}), here = moving_square(kSmall, 101, {-0.3, 0.2});
  for (Frame* f : {&there, &here}) {
    const double edge = f == &here ? 34 : 30;
    for (int y = kSmall.y0; y < kSmall.y1; ++y)
      for (int x = kSmall.x0; x < kSmall.x1; ++x) {
        f->id.at(x, y) = 1, f->depth.at(x, y) = 10;
        const double shade = 0.3 + 0.7 / (1 + std::exp(-(x - edge) / 3));
        f->light.at(x, y) = float(pattern(x + f->jitter.x, y + f->jitter.y) * shade * (1 + 0.15 * unit(random)));
      }
  }
  for (const bool ids : {true, false}) {
    Plane<glm::vec2> motion = here.motion.clone();
    const MotionRepair said =
        repair_motion(motion, here.view(ids, ids), there.view(ids, ids), kNone, kNone, kOn, workers);
    EXPECT_EQ(said.count[0], kSmall.pixels());
  }
}

/// Everything the repair says, to be compared bit for bit.
struct Said {
  Plane<glm::vec2> motion;
  MotionRepair repair;
  bool operator==(const Said& o) const {
    const auto same = [](const auto& a, const auto& b) {
      const Window& w = a.window();
      for (int y = w.y0; y < w.y1; ++y)
        if (std::memcmp(a.row(y), b.row(y), sizeof(*a.row(y)) * std::size_t(w.width())) != 0) return false;
      return true;
    };
    return same(motion, o.motion) && same(repair.residual, o.repair.residual) && same(repair.how, o.repair.how) &&
           repair.count == o.repair.count;
  }
};

Said repair(double scale, int threads) {
  Workers workers(threads);
  const Frame there = moving_square(kSmall, 0, {0.2, -0.3}, scale), here = moving_square(kSmall, 1, {-0.1, 0.4}, scale);
  Said said{here.motion.clone(), {}};
  said.motion.at(20, 30) = glm::vec2(kNaN);
  said.repair = repair_motion(said.motion, here.view(), there.view(), kNone, kNone, kOn, workers);
  return said;
}

TEST_F(RepairMotionTest, ThreadsAndPowersOfTwoChangeNothing) {
  const Said one = repair(1, 1);
  EXPECT_GT(one.repair.count[std::size_t(RepairedBy::search)], 700u);
  EXPECT_TRUE(one == repair(1, 4));
  EXPECT_TRUE(one == repair(std::exp2(40), 2));
  EXPECT_TRUE(one == repair(std::exp2(-60), 3));
}

/// Frames of anything at all.
Frame wild_frame(const Window& w, unsigned seed) {
  std::mt19937 random(seed);
  const auto pick = [&](std::initializer_list<float> values) { return values.begin()[random() % values.size()]; };
  Frame f(w);
  f.jitter = {0.3, -0.45};
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      f.light.at(x, y) = pick({0, 0.25f, 1, 2, 65504, 1e-40f, 3e38f, 0.5f, 0.7f});
      f.depth.at(x, y) = pick({1, 1.05f, 3, 1e30f, kInfinite, 1e-38f});
      f.id.at(x, y) = std::uint32_t(random() % 3);
      f.motion.at(x, y) = glm::vec2(pick({0, 1.5f, -2, 1e30f, kNaN, -0.4f}), pick({0, 0.5f, 3, -1e30f, 1e9f}));
      if (!(f.motion.at(x, y).x == f.motion.at(x, y).x)) f.motion.at(x, y) = glm::vec2(kNaN);
    }
  return f;
}

TEST_F(RepairMotionTest, SurvivesAnything) {
  for (const Window w : {Window{0, 0, 1, 1}, Window{5, -7, 8, 60}, Window{-20, -3, 31, 4}, kSmall})
    for (const bool ids : {true, false}) {
      const Frame here = wild_frame(w, 1), there = wild_frame({w.x0 + 2, w.y0 - 1, w.x1 + 9, w.y1 + 3}, 2);
      Plane<glm::vec2> motion = here.motion.clone();
      const MotionRepair said =
          repair_motion(motion, here.view(ids, !ids), there.view(ids, !ids), there.motion, kNone, kOn, workers);
      std::size_t sum = 0;
      for (const std::size_t n : said.count) sum += n;
      EXPECT_EQ(sum, w.pixels());
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
          EXPECT_TRUE(said.residual.at(x, y) >= 0 && said.residual.at(x, y) <= 1);
          if (said.how.at(x, y) == std::uint8_t(RepairedBy::search)) {
            EXPECT_TRUE(std::isfinite(motion.at(x, y).x) && std::isfinite(motion.at(x, y).y));
          }
        }
    }
}

TEST_F(RepairMotionTest, ResidualsAreThoseOfTheTwin) {
  const Window w{-2, 3, 17, 14};
  for (const bool wild : {false, true})
    for (int known = 0; known < 4; ++known) {
      const bool ids = known & 1, depths = known & 2;
      Frame there = wild ? wild_frame({-4, 2, 16, 17}, 5) : moving_square(w, 0, {0.2, 0.1});
      Frame here = wild ? wild_frame(w, 6) : moving_square(w, 1, {-0.3, 0.4});
      const SeenPair pair(here.view(ids, depths), there.view(ids, depths), 0.15, workers);
      const MotionValidity said = validate_motion(pair, here.motion, there.motion, 0.1, workers);
      for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
          const glm::vec2 v = here.motion.at(x, y);
          if (!(std::fabs(v.x) < 1e6f && std::fabs(v.y) < 1e6f) && v.x == v.x) continue;  // beyond int in the twin
          const reference::Judged twin = reference::judge_vector(here.view(ids, depths), there.view(ids, depths), 0.15,
                                                                 x, y, v, there.motion, 0.1);
          EXPECT_NEAR(double(said.residual.at(x, y)), twin.residual, 1e-6) << x << " " << y;
          if (std::fabs(twin.residual - 0.1) > 1e-5) {
            EXPECT_EQ(VectorVerdict(said.verdict.at(x, y)), twin.verdict) << x << " " << y << " " << known;
          }
        }
    }
}

}  // namespace
}  // namespace varve
