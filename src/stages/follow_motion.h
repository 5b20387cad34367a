// From vectors as stored to the motion that each pixel follows.
#pragma once

#include "motion/motion.h"
#include "stages/repair_vectors.h"

namespace varve {

/// What one present leaves to the next frame.
struct ForwardMemory {
  Plane<glm::vec2> motion;  ///< to the next frame; empty unless it is all there is
  Plane<float> depth;       ///< likewise
  SeenPlanes seen;          ///< what the next frame's vectors are tested against; empty unless they are
};

/// Backward vectors as stored, or those of the previous frame turned round where there are only vectors to the next
/// one; tested and repaired against the frame before, as far as asked for; then dilated, with depth, id and normal of
/// the surface that lends them. `memory` holds what is needed of the previous frame, and is replaced by this frame's;
/// clear it at a restart. Returns what the test said, without planes where it was the previous frame's vectors that
/// were tested; empty without a test.
MotionRepair follow_motion(Present& present, const CamerasAround& cameras, const MotionParameters& parameters,
                           const RepairParameters& repair, ForwardMemory& memory, Workers& workers);

}  // namespace varve
