// The test and repair of vectors, between the frames that the accumulators hold.
#pragma once

#include "motion/repair_motion.h"
#include "plan/parameters.h"
#include "resolve/present.h"
#include "stages/cameras_around.h"

namespace varve {

/// What the test of vectors needs of a frame; empty where nothing is tested.
struct SeenPlanes {
  Plane<float> light, depth;
  Plane<std::uint32_t> id;
  glm::dvec2 jitter{0};
  CamerasAround cameras = {};

  bool empty() const { return light.empty(); }
  SeenFrame view() const { return seen_frame(light, depth, id, jitter); }

  static SeenFrame seen_frame(const Plane<float>& light, const Plane<float>& depth, const Plane<std::uint32_t>& id,
                              glm::dvec2 jitter) {
    return {&light, depth.empty() ? nullptr : &depth, id.empty() ? nullptr : &id, jitter};
  }
};

/// Copies of a present's planes as they are read, before dilation; empty under RepairMotion::off.
SeenPlanes seen_planes(const Present& present, const CamerasAround& cameras, const RepairParameters& parameters,
                       Workers& workers);

/// How what rests in the world moves in the picture: a motion that repair tries first. Empty where camera or depth are
/// not known; NaN where it is longer than the picture is large. `depth` is planar.
Plane<glm::vec2> resting_motion(const std::optional<CameraChange>& change, const Plane<float>& depth, glm::dvec2 jitter,
                                Workers& workers);

/// Vectors that were put in place of wrong ones stay, whatever a later test against the unrepaired vectors of the other
/// direction made of them in `tested`.
void keep_repaired(Plane<glm::vec2>& tested, const Plane<glm::vec2>& repaired, const MotionRepair& repair,
                   Workers& workers);

}  // namespace varve
