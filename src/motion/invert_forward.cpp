#include <cmath>
#include <limits>

#include "motion/motion.h"

namespace varve {
namespace {

/// What has landed on a pixel so far.
struct Landing {
  float depth = std::numeric_limits<float>::infinity();
  float distance = std::numeric_limits<float>::infinity();  // of the landing point from the pixel's centre, squared
};

}  // namespace

Plane<glm::vec2> invert_forward_motion(const Plane<glm::vec2>& previous_forward, const Plane<float>& previous_depth,
                                       const Plane<glm::vec2>& forward) {
  const Window& window = forward.window();
  Plane<glm::vec2> backward(window);
  Plane<Landing> landed(window, 0, Landing{});
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) backward.at(x, y) = -forward.at(x, y);

  // Serial on purpose: the order in which pixels land decides ties.
  const Window& from = previous_forward.window();
  for (int y = from.y0; y < from.y1; ++y)
    for (int x = from.x0; x < from.x1; ++x) {
      const glm::vec2 motion = previous_forward.at(x, y);
      if (!(std::abs(motion.x) < 1e6f && std::abs(motion.y) < 1e6f)) continue;  // NaN as well
      const double to_x = x + double(motion.x), to_y = y + double(motion.y);
      const int left = int(std::floor(to_x)), top = int(std::floor(to_y));
      const float depth = previous_depth.empty() ? 0.0f : previous_depth.at(x, y);
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          if (!window.contains(left + i, top + j)) continue;
          const float dx = float(to_x - (left + i)), dy = float(to_y - (top + j));
          const float distance = dx * dx + dy * dy;
          if (distance >= 1.0f) continue;  // a pixel away or more: no part of this pixel came from there
          Landing& best = landed.at(left + i, top + j);
          if (depth < best.depth || (depth == best.depth && distance < best.distance)) {
            best = {depth, distance};
            backward.at(left + i, top + j) = -motion;
          }
        }
    }
  return backward;
}

}  // namespace varve
