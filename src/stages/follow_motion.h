// From vectors as stored to the motion that each pixel follows.
#pragma once

#include "motion/motion.h"
#include "resolve/present.h"

namespace varve {

/// What one present leaves to the next frame: needed where only forward vectors are in the file.
struct ForwardMemory {
  Plane<glm::vec2> motion;
  Plane<float> depth;
};

/// Backward vectors as stored, or those of the previous frame turned round where there are only vectors to the next
/// one; then dilated, with depth, id and normal of the surface that lends them. `memory` holds the previous frame's
/// forward vectors where they are needed, and is replaced by this frame's; clear it at a restart.
void follow_motion(Present& present, const MotionParameters& parameters, ForwardMemory& memory, Workers& workers);

}  // namespace varve
