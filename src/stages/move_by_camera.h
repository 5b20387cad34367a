// Vectors that come from cameras, for one subject of a frame that was read.
#pragma once

#include <cstddef>
#include <string>

#include "exr/channel_names.h"
#include "resolve/present.h"
#include "stages/cameras_around.h"

namespace varve {

/// Pixels of a frame whose vectors to the frame before (or to the next, where there are no others) come from a camera.
struct CameraVectors {
  std::size_t pixels = 0;      ///< that have vectors now
  std::size_t made = 0;        ///< there were no vectors
  std::size_t background = 0;  ///< background whose vectors were zero
  std::size_t lens = 0;        ///< zoom or lens shift was added
  std::string remark;          ///< what is odd, a sentence; empty: nothing
};

/// Makes or completes present.motion, and present.forward where it is there or `want_forward`, as parameters.camera
/// says. Looks at the subject's own depth, which must be planar, at the jitter of the present, and at the cameras.
/// Throws Failure(inconsistent) where vectors are to be made and a neighbor has no camera.
void move_by_camera(Present& present, const Subject& subject, const CamerasAround& cameras,
                    const NeighborFrames& neighbors, const MotionParameters& parameters, bool want_forward,
                    CameraVectors& counts, Workers& workers);

}  // namespace varve
