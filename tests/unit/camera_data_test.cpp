// Cameras of real renders: depth and the matrices of Note against the vectors that Cycles wrote. Skipped without the
// development data.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <set>

#include "exr/read_frame.h"
#include "motion/motion.h"
#include "paths.h"
#include "plan/probe.h"
#include "stages/cameras_around.h"
#include "stages/read_present.h"

namespace varve {
namespace {

const std::string kData = VARVE_DATA;

struct Residual {
  double mean = 0, largest = 0;
  std::size_t pixels = 0;
};

/// Vectors to the frame before and to the next against the cameras, on surfaces of these object indices.
Residual residual_of(const std::string& pattern, int frame, const std::string& layer, const std::set<int>& resting) {
  ResolveJob job;
  job.input.color = SequencePattern::parse(kData + pattern);
  if (!layer.empty()) job.roles.layers = {layer};
  const SequenceInfo info = probe_sequence(job.input, {frame - 1, frame, frame + 1}, job.roles, {}, {});
  CameraTrack track = info.cameras;
  const FrameHeaders headers = read_frame_headers(job.input, frame, job.roles, {});
  const CamerasAround cameras = cameras_around(headers, {frame - 1, frame + 1}, job, {}, {}, track).front();
  Workers workers(2);
  DeepFrame untold;
  const FileSet pixels =
      read_files(headers, {.depth = true, .motion = true, .forward = true, .id = true}, untold, workers);
  const Subject& subject = headers.subjects.front();
  const Part& part = headers.files[0].parts[std::size_t(part_of(subject))];
  std::size_t bad = 0;
  const Present present =
      read_present(subject, pixels, part.data_window, part.display_window,
                   {.motion = {}, .use_depth = true, .use_motion = true, .use_forward = true, .use_id = true}, nullptr,
                   bad, workers);
  const glm::dvec2 jitter(headers.jitter->x, headers.jitter->y);
  Residual r;
  for (const bool past : {true, false}) {
    const Plane<glm::vec2> moved =
        camera_motion(present.depth, jitter, past ? *cameras.before : *cameras.after, 1e4, workers);
    const Plane<glm::vec2>& stored = past ? present.motion : present.forward;
    const Window& w = stored.window();
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const float index = std::bit_cast<float>(present.id.at(x, y));
        if (!resting.contains(int(index)) || std::isinf(present.depth.at(x, y))) continue;
        const glm::dvec2 miss(stored.at(x, y) - moved.at(x, y));
        const double length = std::hypot(miss.x, miss.y);
        r.mean += length;
        r.largest = std::max(r.largest, length);
        ++r.pixels;
      }
  }
  r.mean /= double(std::max<std::size_t>(r.pixels, 1));
  return r;
}

TEST(CameraData, CourtyardRestsWhereTheCameraSays) {
  if (!std::filesystem::exists(kData)) GTEST_SKIP() << "no development data";
  for (const int frame : {2, 9, 15}) {
    const Residual r = residual_of("/courtyard/jit/frame.####.exr", frame, "", {1, 2, 3, 4, 5, 6});
    RecordProperty("courtyard_largest_" + std::to_string(frame), std::to_string(r.largest));
    EXPECT_GT(r.pixels, 40000u);
    EXPECT_LT(r.mean, 0.001);
    EXPECT_LT(r.largest, 0.01);
  }
}

TEST(CameraData, AquariumRestsWhereTheCameraSays) {
  if (!std::filesystem::exists(kData)) GTEST_SKIP() << "no development data";
  const Residual r = residual_of("/layers/jit/frame.####.exr", 9, "bg", {1, 2, 3});
  RecordProperty("layers_largest", std::to_string(r.largest));
  EXPECT_GT(r.pixels, 30000u);
  EXPECT_LT(r.mean, 0.001);
  EXPECT_LT(r.largest, 0.01);
}

}  // namespace
}  // namespace varve
