// Cameras: reprojection against its twin and against geometry that is known, and everything that is no camera.
#include "motion/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "reference/camera_reference.h"

namespace varve {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Camera some_camera(std::mt19937& random, Projection projection) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Camera c;
  c.projection = projection;
  c.to_camera = glm::rotate(glm::dmat4(1), 0.2 * unit(random), glm::dvec3(0.3, 1, 0.1) / std::sqrt(1.1));
  c.to_camera[3] = glm::dvec4(5 * unit(random), 5 * unit(random), 5 * unit(random), 1);
  c.focal = {300 + 50 * unit(random), 280 + 50 * unit(random)};
  c.center = {160 + 10 * unit(random), 90 + 10 * unit(random)};
  return c;
}

bool same(const SeenPoint& a, const SeenPoint& b) {
  if (std::isnan(a.depth) || std::isnan(b.depth)) return std::isnan(a.depth) && std::isnan(b.depth);
  const double size = 1 + std::abs(b.pixel.x) + std::abs(b.pixel.y);
  const bool near = std::isinf(b.depth) ? a.depth == b.depth : std::abs(a.depth - b.depth) <= 1e-9 * b.depth;
  return near && std::abs(a.pixel.x - b.pixel.x) <= 1e-8 * size && std::abs(a.pixel.y - b.pixel.y) <= 1e-8 * size;
}

TEST(Camera, IsItsTwinInEveryProjection) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  int seen = 0, unseen = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto projection = [&](int bit) { return i & bit ? Projection::orthographic : Projection::perspective; };
    const Camera from = some_camera(random, projection(1)), to = some_camera(random, projection(2));
    const double depths[] = {1 + 40 * unit(random), kInf, 1e30, 1e-3, -1, 0, std::nan("")};
    const double x = 320 * unit(random), y = 180 * unit(random);
    for (const double depth : depths) {
      const SeenPoint a = reproject({x, y}, depth, from, to), b = reference::reproject(x, y, depth, from, to);
      EXPECT_TRUE(same(a, b)) << i << " depth " << depth << ": " << a.pixel.x << " " << b.pixel.x;
      (std::isnan(a.depth) ? unseen : seen)++;
    }
  }
  EXPECT_GT(seen, 4000);
  EXPECT_GT(unseen, 4000);
}

TEST(Camera, LeadsBackWhereItCameFrom) {
  std::mt19937 random(4);
  for (int i = 0; i < 200; ++i) {
    const Camera a = some_camera(random, Projection::perspective), b = some_camera(random, Projection::perspective);
    for (const double depth : {20.0, 300.0, kInf}) {
      const SeenPoint there = reproject({100, 50}, depth, a, b), back = reproject(there.pixel, there.depth, b, a);
      EXPECT_NEAR(back.pixel.x, 100, 1e-7);
      EXPECT_NEAR(back.pixel.y, 50, 1e-7);
    }
  }
}

TEST(Camera, GeometryThatIsKnown) {
  Camera a;
  a.focal = {320, 320};
  a.center = {160, 90};
  Camera b = a;
  b.to_camera[3][0] = 2;  // the camera went 2 to the left: what rests goes right
  EXPECT_NEAR(reproject({160, 90}, 320, a, b).pixel.x, 162, 1e-12);
  EXPECT_NEAR(reproject({160, 90}, 640, a, b).pixel.x, 161, 1e-12);
  EXPECT_EQ(reproject({7, 8}, kInf, a, b).pixel, glm::dvec2(7, 8));
  b = a;
  b.to_camera[3][2] = -100;  // forward
  EXPECT_NEAR(reproject({200, 90}, 200, a, b).pixel.x, 240, 1e-12);
  EXPECT_DOUBLE_EQ(reproject({200, 90}, 200, a, b).depth, 100);
  EXPECT_TRUE(std::isnan(reproject({200, 90}, 99, a, b).pixel.x)) << "behind the camera";
  b = a;
  b.focal = {640, 640};
  b.center.x = 170;
  EXPECT_EQ(through_lens({170, 80}, a, b), glm::dvec2(190, 70));
  EXPECT_NEAR(reproject({170, 80}, kInf, a, b).pixel.x, 190, 1e-12);
  b.projection = a.projection = Projection::orthographic;
  b.focal = a.focal;
  b.center = a.center;
  b.to_camera[3] = {0.5, 0, -3, 1};
  EXPECT_NEAR(reproject({100, 50}, 10, a, b).pixel.x, 260, 1e-12);
  EXPECT_TRUE(std::isnan(reproject({100, 50}, 2, a, b).pixel.x));
}

TEST(Camera, ThePlaneIsThePointsAtTheirSamples) {
  Workers one(1), three(3);
  std::mt19937 random(5);
  const Camera a = some_camera(random, Projection::perspective), b = some_camera(random, Projection::perspective);
  Plane<float> depth({-3, 2, 14, 9});
  const float kinds[] = {30, 1e30f, float(kInf), 0.01f, float(std::nan("")), 3.4e38f, -5, 1e-40f};
  int k = 0;
  for (int y = 2; y < 9; ++y)
    for (int x = -3; x < 14; ++x, ++k) depth.at(x, y) = kinds[k % 8] * (1 + 0.01f * float(x));
  const glm::dvec2 jitter(0.25, -0.4);
  const Plane<glm::vec2> motion = camera_motion(depth, jitter, change_between(a, b), 16384, one);
  const Plane<glm::vec2> again = camera_motion(depth, jitter, change_between(a, b), 16384, three);
  const Plane<glm::vec2> rest = camera_motion(depth, jitter, change_between(a, a), 16384, one);
  for (int y = 2; y < 9; ++y)
    for (int x = -3; x < 14; ++x) {
      const double px = x + 0.75, py = y + 0.1;
      const SeenPoint seen = reference::reproject(px, py, double(depth.at(x, y)), a, b);
      const glm::vec2 m = motion.at(x, y);
      EXPECT_EQ(std::memcmp(&m, &again.at(x, y), sizeof m), 0);
      if (std::hypot(seen.pixel.x - px, seen.pixel.y - py) <= 16384) {
        EXPECT_NEAR(double(m.x), seen.pixel.x - px, 1e-6 * (1 + std::abs(seen.pixel.x)));
        EXPECT_NEAR(double(m.y), seen.pixel.y - py, 1e-6 * (1 + std::abs(seen.pixel.y)));
      } else {
        EXPECT_TRUE(std::isnan(m.x) && std::isnan(m.y)) << x << " " << y;
      }
      if (depth.at(x, y) > 0) {
        EXPECT_EQ(rest.at(x, y), glm::vec2(0.0f));
      }
    }
}

TEST(Camera, RayDepthBecomesPlanar) {
  Workers workers(1);
  Camera camera;
  camera.focal = {100, 100};
  camera.center = {0.5, 0.5};
  Plane<float> depth({0, 0, 120, 1}, 0, 50.0f);
  depth.at(1, 0) = float(kInf);
  ray_to_planar_depth(depth, {0, 0}, camera, workers);
  EXPECT_FLOAT_EQ(depth.at(0, 0), 50);
  EXPECT_EQ(depth.at(1, 0), float(kInf));
  EXPECT_FLOAT_EQ(depth.at(100, 0), float(50 / std::sqrt(2.0)));
}

}  // namespace
}  // namespace varve
