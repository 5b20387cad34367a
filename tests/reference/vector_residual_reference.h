// Slow, obvious twin of validate_motion(), in double.
#pragma once

#include "motion/validate_motion.h"

namespace varve::reference {

/// Residual and verdict of one vector; see validate_motion().
struct Judged {
  double residual = 0;
  VectorVerdict verdict = VectorVerdict::trusted;
};
Judged judge_vector(const SeenFrame& here, const SeenFrame& there, double depth_tolerance, int x, int y,
                    glm::vec2 vector, const Plane<glm::vec2>& back, double doubt);

}  // namespace varve::reference
