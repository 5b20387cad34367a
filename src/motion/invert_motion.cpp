#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "motion/motion.h"

namespace varve {
namespace {

/// What has landed on a pixel so far.
struct Landing {
  float depth = std::numeric_limits<float>::infinity();
  float distance = std::numeric_limits<float>::infinity();  // of the landing point from the pixel's centre, squared
};

/// A landing is believed where the surface that lands is the one seen; both background included.
bool is_seen(float landing, float seen, double tolerance) {
  return landing == seen || std::abs(double(landing) - double(seen)) <= tolerance * double(std::min(landing, seen));
}

}  // namespace

Plane<glm::vec2> invert_motion(const Plane<glm::vec2>& there, const Plane<float>& depth_there,
                               const Plane<float>& depth, double depth_tolerance, Plane<glm::vec2> otherwise) {
  const Window window = otherwise.window();
  Plane<glm::vec2> inverted = std::move(otherwise);
  Plane<Landing> landed(window, 0, Landing{});
  const bool test_depth = !depth.empty() && !depth_there.empty();

  // Serial on purpose: the order in which pixels land decides ties.
  const Window& from = there.window();
  for (int y = from.y0; y < from.y1; ++y)
    for (int x = from.x0; x < from.x1; ++x) {
      const glm::vec2 motion = there.at(x, y);
      if (!(std::abs(motion.x) < 1e6f && std::abs(motion.y) < 1e6f)) continue;  // NaN as well
      const double to_x = x + double(motion.x), to_y = y + double(motion.y);
      const int left = int(std::floor(to_x)), top = int(std::floor(to_y));
      const float landing = depth_there.empty() ? 0.0f : depth_there.at(x, y);
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          if (!window.contains(left + i, top + j)) continue;
          const float dx = float(to_x - (left + i)), dy = float(to_y - (top + j));
          const float distance = dx * dx + dy * dy;
          if (distance >= 1.0f) continue;  // a pixel away or more: no part of this pixel came from there
          if (test_depth && !is_seen(landing, depth.at(left + i, top + j), depth_tolerance)) continue;
          Landing& best = landed.at(left + i, top + j);
          if (landing < best.depth || (landing == best.depth && distance < best.distance)) {
            best = {landing, distance};
            inverted.at(left + i, top + j) = -motion;
          }
        }
    }
  return inverted;
}

Plane<glm::vec2> invert_forward_motion(const Plane<glm::vec2>& previous_forward, const Plane<float>& previous_depth,
                                       const Plane<glm::vec2>& forward) {
  const Window& window = forward.window();
  Plane<glm::vec2> own(window);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) own.at(x, y) = -forward.at(x, y);
  return invert_motion(previous_forward, previous_depth, {}, 0, std::move(own));
}

void reject_one_way_motion(Plane<glm::vec2>& motion, const Plane<glm::vec2>& back, double tolerance, Workers& workers) {
  const Window &w = motion.window(), &other = back.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::vec2& here = motion.at(x, y);
      const double to_x = x + double(here.x) + 0.5, to_y = y + double(here.y) + 0.5;
      if (!(std::abs(to_x) < 1e9 && std::abs(to_y) < 1e9)) continue;
      const int nearest_x = int(std::floor(to_x)), nearest_y = int(std::floor(to_y));
      if (!other.contains(nearest_x, nearest_y)) continue;
      const glm::vec2 there = back.at(nearest_x, nearest_y);
      const auto square = [](double a, double b) { return a * a + b * b; };
      const double miss = square(double(here.x) + double(there.x), double(here.y) + double(there.y));
      const double lengths = square(double(here.x), double(here.y)) + square(double(there.x), double(there.y));
      if (miss > tolerance * tolerance + 1e-4 * lengths) here = glm::vec2(std::numeric_limits<float>::quiet_NaN());
    }
  });
}

}  // namespace varve
