#include "stages/follow_motion.h"

#include <utility>

#include "motion/dilate.h"

namespace varve {

MotionRepair follow_motion(Present& present, const CamerasAround& cameras, const MotionParameters& parameters,
                           const RepairParameters& repair, ForwardMemory& memory, Workers& workers) {
  Plane<glm::vec2> motion = std::move(present.motion);
  if (motion.empty() && present.forward.empty()) return {};
  SeenPlanes seen = seen_planes(present, cameras, repair, workers);
  const bool test = !seen.empty() && !memory.seen.empty();
  MotionRepair said;
  if (motion.empty()) {
    if (test && !memory.motion.empty()) {
      const SeenPlanes& last = memory.seen;
      said = repair_motion(memory.motion, last.view(), seen.view(), {},
                           resting_motion(last.cameras.after, last.depth, last.jitter, workers), repair, workers);
      said.residual = {}, said.how = {};  // of the pixels of the frame before
    }
    motion = invert_forward_motion(memory.motion, memory.depth, present.forward);
    memory.motion = std::move(present.forward), memory.depth = present.depth.clone();
  } else if (test) {
    said = repair_motion(motion, seen.view(), memory.seen.view(), {},
                         resting_motion(cameras.before, seen.depth, seen.jitter, workers), repair, workers);
  }
  memory.seen = std::move(seen);
  const auto dilate = moves_background(parameters.camera) ? dilate_surfaces_apart : dilate_motion;
  DilatedMotion followed = dilate(std::move(motion), present.depth, parameters.dilation, workers,
                                  {std::move(present.id), std::move(present.normal)});
  present.motion = std::move(followed.motion);
  present.depth = std::move(followed.depth);
  present.id = std::move(followed.marks.id);
  present.normal = std::move(followed.marks.normal);
  return said;
}

}  // namespace varve
