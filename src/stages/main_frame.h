// The main layer of a frame, for looking at a sequence before it is resolved: color and vectors, nothing else.
#pragma once

#include <optional>

#include "motion/motion.h"
#include "plan/probe.h"
#include "resolve/present.h"

namespace varve {

struct MainFrame {
  int frame = 0;
  Present present;  ///< motion leads to the frame before; forward to the next, where that is all there is
  std::optional<glm::dvec2> jitter;                    ///< as stated
  std::optional<std::vector<double>> world_to_camera;  ///< 16 numbers, row major, as the attribute has them
};

/// Reads one layer of a frame: the one that is asked for, or the main one where several are. Throws Failure naming the
/// frame.
MainFrame read_main_frame(const InputSequence& input, int frame, const RoleRequest& roles, const JitterSource& jitter,
                          const MotionParameters& motion, Workers& workers);

/// Motion to the frame before: the file's, or that frame's vectors to this one turned round (NaN where none lands);
/// empty where there are no vectors. `before` may be null.
Plane<glm::vec2> motion_to_previous(const MainFrame& now, const MainFrame* before);

}  // namespace varve
