// What the gather keeps between frames: vectors in both directions and the light of each frame, made once each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "gather/gather.h"
#include "stages/frame_window.h"
#include "stages/repair_vectors.h"

namespace varve {

/// Of one subject in one frame.
struct GatherFrame {
  Plane<glm::vec2> backward, forward;  ///< made from the neighbor's or checked against them; empty: as in the file
  MotionRepair backward_said, forward_said;  ///< what the test of the file's vectors said; empty without one
  SeenPlanes seen;                           ///< what they are tested by; empty until then
  SurfaceBlocks blocks;
  std::optional<std::uint64_t> print;  ///< color_print() of the frame
  Plane<float> light;                  ///< local_light() of the pilot; empty until it is needed
  Plane<LightRange> range;             ///< local_range() of it
};

/// By place in the schedule; frames that are passed are forgotten.
using GatherMemory = std::map<std::size_t, GatherFrame>;

/// Resolves the frame at `index` from the frames of `window` between `first` and `last`, all held; with a gain, the
/// outermost frame on each side only serves the pilot of its neighbor. Several subjects are samples of the same pixels:
/// all of them make one result, and the further samples that the frames have of `output`, whose subjects they are, with
/// them. `memory` has one entry for each subject, then for each further sample. Vectors are tested and repaired
/// as far as asked for, once for each frame and direction; memory[s][index].backward_said tells of those to the frame
/// before.
Accumulated gather_frame(const FrameWindow& window, std::size_t output, std::span<const std::size_t> subjects,
                         std::size_t index, std::size_t first, std::size_t last, const GatherParameters& parameters,
                         const RepairParameters& repair, std::vector<GatherMemory>& memory,
                         const DiagnosticsWanted& wanted, Workers& workers);

}  // namespace varve
