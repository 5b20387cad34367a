#include "stages/follow_motion.h"

#include <utility>

namespace varve {

void follow_motion(Present& present, const MotionParameters& parameters, ForwardMemory& memory, Workers& workers) {
  Plane<glm::vec2> motion = std::move(present.motion);
  if (motion.empty() && present.forward.empty()) return;
  if (motion.empty()) {
    motion = invert_forward_motion(memory.motion, memory.depth, present.forward);
    memory = {std::move(present.forward), present.depth.clone()};
  }
  DilatedMotion followed = dilate_motion(std::move(motion), present.depth, parameters.dilation, workers,
                                         {std::move(present.id), std::move(present.normal)});
  present.motion = std::move(followed.motion);
  present.depth = std::move(followed.depth);
  present.id = std::move(followed.marks.id);
  present.normal = std::move(followed.marks.normal);
}

}  // namespace varve
