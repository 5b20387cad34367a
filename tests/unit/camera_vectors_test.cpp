// Vectors completed by cameras: what is filled, what is left, and what evidence it takes.
#include "motion/camera_vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "reference/camera_reference.h"
#include "stages/move_by_camera.h"
#include "support/refusal.h"

namespace varve {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kFar = 16384;
const glm::dvec2 kJitter(0.3, -0.2);

Camera camera_at(double time, double zoom = 0) {
  Camera c;
  c.to_camera = glm::rotate(glm::dmat4(1), 0.02 * time, glm::dvec3(0, 1, 0));
  c.to_camera[3] = {0.5 * time, 0.1 * time, 0, 1};
  c.focal = glm::dvec2(100 * std::exp(zoom * time));
  c.center = {37, 21};
  return c;
}

/// A sky above a slanted ground, on an odd window; one pixel in nine moves by itself.
struct Frame {
  Window window{-2, 3, 71, 44};
  Plane<float> depth{window};
  Plane<glm::vec2> motion{window};

  Frame(const Camera& from, const Camera& to, bool lens_known) {
    Camera bare = to;
    if (!lens_known) bare.focal = from.focal, bare.center = from.center;
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x) {
        depth.at(x, y) = y < 16 ? kInf : 400.0f / float(y - 12);
        const glm::dvec2 pixel = glm::dvec2(x, y) + 0.5 + kJitter;
        const SeenPoint seen = reference::reproject(pixel.x, pixel.y, double(depth.at(x, y)), from, bare);
        motion.at(x, y) = y < 16 ? glm::vec2(0.0f) : glm::vec2(seen.pixel - pixel);
        if (y >= 16 && (x + y) % 9 == 0) motion.at(x, y) += glm::vec2(3.0f, -2.0f);
      }
  }
};

TEST(CameraVectors, ZeroBackgroundTurnsWithTheCamera) {
  const Camera from = camera_at(1), to = camera_at(0);
  Frame f(from, to, true);
  f.motion.at(5, 5) = glm::vec2(kNaN);
  f.motion.at(6, 5) = {1, 0};
  f.depth.at(7, 30) = kNaN;
  const Plane<glm::vec2> before = f.motion.clone();
  Workers one(1), three(3);
  Plane<glm::vec2> again = f.motion.clone();
  const CameraChange change = change_between(from, to);
  const CameraFilled filled = complete_vectors(f.motion, f.depth, kJitter, change, {true, false}, kFar, one);
  complete_vectors(again, f.depth, kJitter, change, {true, false}, kFar, three);
  EXPECT_EQ(filled.background, 13u * 73 - 1);
  EXPECT_EQ(filled.lens, 0u);
  for (int y = f.window.y0; y < f.window.y1; ++y)
    for (int x = f.window.x0; x < f.window.x1; ++x) {
      EXPECT_EQ(std::memcmp(&f.motion.at(x, y), &again.at(x, y), sizeof(glm::vec2)), 0);
      if (y >= 16 || (x == 6 && y == 5)) {
        EXPECT_EQ(f.motion.at(x, y), before.at(x, y));
        continue;
      }
      const glm::dvec2 p = glm::dvec2(x, y) + 0.5 + kJitter;
      const SeenPoint seen = reference::reproject(p.x, p.y, double(kInf), from, to);
      EXPECT_NEAR(double(f.motion.at(x, y).x), seen.pixel.x - p.x, 1e-5);
      EXPECT_NEAR(double(f.motion.at(x, y).y), seen.pixel.y - p.y, 1e-5);
    }
}

TEST(CameraVectors, ACameraThatOnlyShiftsLeavesTheSky) {
  Camera from = camera_at(0), to = from;
  to.to_camera[3][0] += 3;
  Frame f(from, to, true);
  Workers workers(1);
  EXPECT_EQ(
      complete_vectors(f.motion, f.depth, kJitter, change_between(from, to), {true, true}, kFar, workers).background,
      0u);
  EXPECT_EQ(f.motion.at(5, 5), glm::vec2(0.0f));
}

TEST(CameraVectors, EvidenceTellsWhetherVectorsKnowTheZoom) {
  for (const bool known : {false, true})
    for (const double zoom : {0.002, 0.03, -0.1}) {
      const Camera from = camera_at(1, zoom), to = camera_at(0, zoom);
      const Frame f(from, to, known);
      const CameraEvidence e = compare_with_camera(f.motion, f.depth, kJitter, change_between(from, to));
      EXPECT_EQ(lacks_lens(e), !known) << zoom << " " << e.with_lens << " " << e.without_lens;
      EXPECT_FALSE(lens_is_unclear(e));
      EXPECT_FALSE(contradicts(e));
    }
  const Camera from = camera_at(1, 0.1), to = camera_at(0, 0.1);
  Frame f(from, to, true);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-9, 9);
  for (int y = f.window.y0; y < f.window.y1; ++y)
    for (int x = f.window.x0; x < f.window.x1; ++x) f.motion.at(x, y) = {unit(random), unit(random)};
  const CameraEvidence noise = compare_with_camera(f.motion, f.depth, kJitter, change_between(from, to));
  EXPECT_FALSE(lacks_lens(noise));
  EXPECT_TRUE(lens_is_unclear(noise));
  EXPECT_TRUE(contradicts(noise));
  EXPECT_FALSE(all_zero(noise));
  f.motion.fill(glm::vec2(0.0f));
  EXPECT_TRUE(all_zero(compare_with_camera(f.motion, f.depth, kJitter, change_between(from, to))));
}

TEST(CameraVectors, ZoomIsAddedToWhatMovesToo) {
  const Camera from = camera_at(1, 0.05), to = camera_at(0, 0.05);
  Frame lacking(from, to, false);
  const Frame full(from, to, true);
  Workers workers(1);
  lacking.motion.at(20, 30) = glm::vec2(kNaN);
  const CameraFilled filled =
      complete_vectors(lacking.motion, lacking.depth, kJitter, change_between(from, to), {true, true}, kFar, workers);
  EXPECT_EQ(filled.background, 13u * 73);
  EXPECT_EQ(filled.lens, 28u * 73 - 1);
  const double zoom = to.focal.x / from.focal.x;
  for (int y = 16; y < full.window.y1; ++y)
    for (int x = full.window.x0; x < full.window.x1; ++x) {
      if (x == 20 && y == 30) continue;
      // What moves by itself was moved in the picture of the lens of this frame.
      const glm::dvec2 extra = (x + y) % 9 == 0 ? (zoom - 1) * glm::dvec2(3, -2) : glm::dvec2(0);
      EXPECT_NEAR(double(lacking.motion.at(x, y).x), double(full.motion.at(x, y).x) + extra.x, 2e-5);
      EXPECT_NEAR(double(lacking.motion.at(x, y).y), double(full.motion.at(x, y).y) + extra.y, 2e-5);
    }
}

TEST(CameraVectors, JitterInTheMatricesIsTakenOut) {
  using Known = std::optional<glm::dvec2>;
  const glm::dvec2 j0(0.25, -0.3), j1(-0.4, 0.1);
  const Camera still = camera_at(0);
  Camera a = still, b = still;
  a.center -= j0, b.center -= j1;
  take_out_jitter(a, b, Known(j0), Known(j1));
  EXPECT_NEAR(a.center.x, still.center.x, 1e-12);
  EXPECT_EQ(a.center, b.center);
  a = b = still;
  a.center -= j0, b.center -= j1;
  take_out_jitter(a, b, std::nullopt, Known(j1));
  EXPECT_EQ(a.center, b.center) << "below a pixel and nothing to tell by";
  a = b = still;
  b.center.x += 2;
  take_out_jitter(a, b, Known(j0), Known(j1));
  EXPECT_EQ(b.center.x, still.center.x + 2) << "a lens that slides";
  a = b = still;
  b.center.x += 1.5;
  take_out_jitter(a, b, std::nullopt, std::nullopt);
  EXPECT_EQ(b.center.x, still.center.x + 1.5);
  a = b = still;
  b.center.x += 0.01;
  take_out_jitter(a, b, Known(j0), Known(j0));
  EXPECT_EQ(a, still);
}

/// One subject through the stage.
struct Stage {
  Present present;
  Subject subject;
  CamerasAround cameras;
  NeighborFrames neighbors{1, 3};
  MotionParameters parameters;
  CameraVectors counts;
  Workers workers{1};

  explicit Stage(double zoom = 0, bool lens_known = true) {
    Frame f(camera_at(2, zoom), camera_at(1, zoom), lens_known), g(camera_at(2, zoom), camera_at(3, zoom), lens_known);
    present.depth = std::move(f.depth);
    present.motion = std::move(f.motion);
    present.forward = std::move(g.motion);
    present.jitter = kJitter;
    subject.backward = subject.forward = VectorChannels{};
    cameras = {camera_at(2, zoom), change_between(camera_at(2, zoom), camera_at(1, zoom)),
               change_between(camera_at(2, zoom), camera_at(3, zoom))};
  }
  void run(CameraUse use, bool want_forward = true) {
    parameters.camera = use;
    move_by_camera(present, subject, cameras, neighbors, parameters, want_forward, counts, workers);
  }
  bool sky_moves() const { return present.motion.at(3, 5) != glm::vec2(0.0f); }
};

TEST(CameraStage, EachUseDoesItsOwn) {
  for (const CameraUse use : {CameraUse::missing, CameraUse::background, CameraUse::zoom, CameraUse::all}) {
    Stage s(0.05, false);
    const glm::vec2 ground = s.present.motion.at(30, 40), ahead = s.present.forward.at(30, 40);
    s.run(use);
    const bool background = use == CameraUse::background || use == CameraUse::all;
    const bool zoom = use == CameraUse::zoom || use == CameraUse::all;
    EXPECT_EQ(s.counts.background, background ? 13u * 73 : 0u);
    EXPECT_EQ(s.counts.lens > 0, zoom);
    EXPECT_EQ(s.counts.made, 0u);
    EXPECT_EQ(s.present.motion.at(30, 40) != ground, zoom);
    EXPECT_EQ(s.present.forward.at(30, 40) != ahead, zoom);
    EXPECT_EQ(s.sky_moves(), background || zoom);
    EXPECT_EQ(s.counts.remark, "");
  }
}

TEST(CameraStage, MissingVectorsAreMadeBothWays) {
  Stage s(0.05);
  const Plane<glm::vec2> backward = s.present.motion.clone(), forward = s.present.forward.clone();
  s.present.motion = {}, s.present.forward = {};
  s.subject.backward = s.subject.forward = std::nullopt;
  s.run(CameraUse::missing);
  EXPECT_EQ(s.counts.made, 73u * 41);
  for (int y = 16; y < 44; ++y)
    for (int x = -2; x < 71; ++x) {
      if ((x + y) % 9 == 0) continue;
      EXPECT_NEAR(double(s.present.motion.at(x, y).x), double(backward.at(x, y).x), 1e-5);
      EXPECT_NEAR(double(s.present.forward.at(x, y).y), double(forward.at(x, y).y), 1e-5);
    }
  EXPECT_TRUE(s.sky_moves());

  Stage alone;
  alone.present.motion = {}, alone.present.forward = {};
  alone.subject.backward = alone.subject.forward = std::nullopt;
  alone.neighbors = {};
  alone.run(CameraUse::missing);
  EXPECT_TRUE(alone.present.motion.empty()) << "no frame to lead to";
  alone.neighbors.before = 1;
  alone.cameras.before = std::nullopt;
  EXPECT_NE(test::message_of([&] { alone.run(CameraUse::missing); }).find("frame 1"), std::string::npos);
}

TEST(CameraStage, ContradictoryEvidenceDoesNothingAndSaysSo) {
  Stage s(0.05, false);
  for (int y = 16; y < 44; ++y)
    for (int x = -2; x < 71; ++x) s.present.motion.at(x, y) = -s.present.motion.at(x, y) + glm::vec2(1, 5);
  s.run(CameraUse::all);
  EXPECT_FALSE(s.sky_moves());
  EXPECT_NE(s.counts.remark.find("contradict"), std::string::npos);

  Stage zero;
  zero.present.motion.fill(glm::vec2(0.0f));
  zero.run(CameraUse::all);
  EXPECT_NE(zero.counts.remark.find("every vector is zero"), std::string::npos);
  EXPECT_FALSE(zero.sky_moves());
}

}  // namespace
}  // namespace varve
