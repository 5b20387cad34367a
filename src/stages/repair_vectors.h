// The test and repair of vectors, between the frames that the accumulators hold.
#pragma once

#include "motion/repair_motion.h"
#include "plan/parameters.h"
#include "resolve/present.h"

namespace varve {

/// What the test of vectors needs of a frame; empty where nothing is tested.
struct SeenPlanes {
  Plane<float> light, depth;
  Plane<std::uint32_t> id;
  glm::dvec2 jitter{0};

  bool empty() const { return light.empty(); }
  SeenFrame view() const { return seen_frame(light, depth, id, jitter); }

  static SeenFrame seen_frame(const Plane<float>& light, const Plane<float>& depth, const Plane<std::uint32_t>& id,
                              glm::dvec2 jitter) {
    return {&light, depth.empty() ? nullptr : &depth, id.empty() ? nullptr : &id, jitter};
  }
};

/// Copies of a present's planes as they are read, before dilation; empty under RepairMotion::off.
SeenPlanes seen_planes(const Present& present, const RepairParameters& parameters, Workers& workers);

/// Vectors that were put in place of wrong ones stay, whatever a later test against the unrepaired vectors of the other
/// direction made of them in `tested`.
void keep_repaired(Plane<glm::vec2>& tested, const Plane<glm::vec2>& repaired, const MotionRepair& repair,
                   Workers& workers);

}  // namespace varve
