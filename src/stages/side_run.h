// One direction of time: what is carried from frame to frame, and the vectors that lead there.
#pragma once

#include <memory>
#include <vector>

#include "plan/parameters.h"
#include "resolve/two_sided.h"
#include "stages/frame_window.h"
#include "stages/repair_vectors.h"

namespace varve {

/// Vectors of one subject as its file has them, and what is known of the surfaces that they move; empty where there is
/// nothing.
struct SideVectors {
  Plane<glm::vec2> backward, forward;
  Plane<float> depth;
  SurfaceMarks marks;
  Plane<float> light = {};  ///< for the test of the vectors; empty unless it is asked for
  glm::dvec2 jitter{0};
  CamerasAround cameras = {};
};
/// One for each subject of a frame; shared by the runs that pass it.
using SharedVectors = std::shared_ptr<const std::vector<SideVectors>>;

/// Takes the vectors out of the presents of a frame that was read as stored.
SharedVectors take_vectors(SourceFrame& source, const RepairParameters& repair, Workers& workers);

/// Through the past: frames in ascending order, each fetching from the one before. Through the future: the mirror
/// image.
enum class Side { past, future };

/// Motion from a frame to its neighbor on one side, dilated, with depth and marks of the surface that lent it. Vectors
/// come from the file, or from the neighbor's vectors to this frame, inverted with a depth test; holes (hidden there)
/// are NaN. `neighbor` may be null at the end of a run. Without any vectors the motion is empty: at rest. Vectors are
/// tested and repaired as far as asked for; `said` gets what the test said of this frame's own vectors, and no planes
/// where it was the neighbor's that were tested.
DilatedMotion motion_to(Side side, const SideVectors& here, const SideVectors* neighbor, const Parameters& parameters,
                        MotionRepair& said, Workers& workers);

/// What one direction carries. Nothing of it depends on frames before the first that it was given.
struct SideRun {
  Side side = Side::past;
  std::vector<History> states;  ///< one for each subject; empty before the first frame
  SharedVectors neighbor;
};

/// What the steps have in common.
struct StepOptions {
  const Parameters& parameters;
  DiagnosticsWanted wanted;
};

/// Passes a frame: what the side says of it, and on to the next. `source` gets the motion of this side.
std::vector<StrictSide> pass_frame(SideRun& run, SourceFrame& source, const SharedVectors& vectors,
                                   const StepOptions& options, Workers& workers);

/// The same, and merges with what the other side says of the frame.
std::vector<Accumulated> merge_frame(SideRun& run, SourceFrame& source, const SharedVectors& vectors,
                                     const std::vector<StrictSide>& others, const StepOptions& options,
                                     Workers& workers);

}  // namespace varve
