#include "subpixel/carry_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace varve {
namespace {

constexpr double kEdge = 0.5;     // px: a larger step from pixel to pixel is an edge between surfaces
constexpr double kLongest = 1e9;  // px: positions stay inside an int
const glm::vec2 kNone(std::numeric_limits<float>::quiet_NaN());

bool is_way(const glm::dvec2& v) { return v.x * v.x + v.y * v.y <= kLongest * kLongest; }

/// The way as seen from a position between pixels.
glm::dvec2 way_at(const Plane<glm::vec2>& way, double x, double y) {
  const Window& w = way.window();
  const double bx = std::floor(x), by = std::floor(y), fx = x - bx, fy = y - by;
  const int x0 = int(bx), y0 = int(by);
  const int nx = std::clamp(x0 + (fx >= 0.5), w.x0, w.x1 - 1), ny = std::clamp(y0 + (fy >= 0.5), w.y0, w.y1 - 1);
  const glm::dvec2 nearest(way.at(nx, ny));
  if (!is_way(nearest)) return nearest;
  glm::dvec2 sum(0.0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
      const int tx = std::clamp(x0 + i, w.x0, w.x1 - 1), ty = std::clamp(y0 + j, w.y0, w.y1 - 1);
      const glm::dvec2 step = glm::dvec2(way.at(tx, ty)) - nearest;
      if (!(weight > 0)) continue;
      if (!(std::abs(step.x) <= kEdge && std::abs(step.y) <= kEdge)) return nearest;
      sum += step * weight;
    }
  return nearest + sum;
}

}  // namespace

Plane<glm::vec2> carry_way(const Plane<glm::vec2>& way, const Plane<glm::vec2>& motion, const Window& window,
                           Workers& workers) {
  if (way.empty() && motion.empty()) return Plane<glm::vec2>(window, 0, glm::vec2(0.0f));
  if (way.empty()) return motion.clone();
  Plane<glm::vec2> out(window);
  const Window& before = way.window();
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const glm::dvec2 m = motion.empty() ? glm::dvec2(0.0) : glm::dvec2(motion.at(x, y));
      glm::vec2& to = out.at(x, y) = kNone;
      if (!is_way(m)) continue;
      const double px = x + m.x, py = y + m.y;
      // Pixel centers are whole numbers here; half a pixel beyond the outer ones is the window's edge.
      if (!(px >= before.x0 - 0.5 && py >= before.y0 - 0.5 && px <= before.x1 - 0.5 && py <= before.y1 - 0.5)) continue;
      const glm::dvec2 far = way_at(way, px, py);
      if (is_way(far)) to = glm::vec2(m + far);
    }
  });
  return out;
}

}  // namespace varve
