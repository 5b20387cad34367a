#include "gather/opposite_vectors.h"

#include <limits>

#include "gather/carry.h"

namespace varve {
namespace {

/// The neighbor's sample that landed closest to a pixel's sample, by its pixel; distance in pixels, squared.
struct Closest {
  int x = 0, y = 0;
  float distance = std::numeric_limits<float>::infinity();
};

Plane<Closest> land(const GatherSource& source, const GatherSource& neighbor, const Plane<glm::vec2>& back,
                    const SurfaceTest& test) {
  const Window &w = source.window(), &n = neighbor.window();
  Plane<Closest> closest(w, 0, Closest{});
  for (int y = n.y0; y < n.y1; ++y)  // serial: the order decides ties
    for (int x = n.x0; x < n.x1; ++x) {
      const glm::vec2 v = back.at(x, y);
      if (!(v.x == v.x)) continue;
      const glm::dvec2 at = neighbor.position(x, y) + glm::dvec2(v) - glm::dvec2(0.5) - source.jitter;
      if (!(at.x > w.x0 - 2.0 && at.y > w.y0 - 2.0 && at.x < w.x1 + 1.0 && at.y < w.y1 + 1.0)) continue;
      const SurfaceKey key = surface_at(*neighbor.present, x, y);
      const int bx = int(std::floor(at.x)), by = int(std::floor(at.y));
      for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i) {
          if (!w.contains(bx + i, by + j)) continue;
          const float dx = float(at.x - (bx + i)), dy = float(at.y - (by + j)), distance = dx * dx + dy * dy;
          Closest& best = closest.at(bx + i, by + j);
          if (distance < best.distance && test.same(surface_at(*source.present, bx + i, by + j), key))
            best = {x, y, distance};
        }
    }
  return closest;
}

}  // namespace

Plane<glm::vec2> opposite_vectors(const GatherSource& source, const GatherSource& neighbor,
                                  const Plane<glm::vec2>& back, const SurfaceTest& test, double tolerance,
                                  Workers& workers) {
  constexpr int kSteps = 6;
  const Window& w = source.window();
  const Plane<Closest> closest = land(source, neighbor, back, test);
  Plane<glm::vec2> vectors(w, 0, glm::vec2(std::numeric_limits<float>::quiet_NaN()));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const Closest& start = closest.at(x, y);
      if (!(start.distance < 1e9f) || !is_followed(source, x, y)) continue;
      const SurfaceKey key = surface_at(*source.present, x, y);
      const glm::dvec2 target = source.position(x, y);
      glm::dvec2 at = target - glm::dvec2(back.at(start.x, start.y));
      double miss = std::numeric_limits<double>::infinity();
      for (int step = 0; step < kSteps && miss > 1e-4; ++step) {
        const glm::dvec2 v = read_between(back, neighbor, at, key, test);
        const glm::dvec2 off = at + v - target;
        miss = off.x == off.x ? std::max(std::fabs(off.x), std::fabs(off.y)) : std::numeric_limits<double>::quiet_NaN();
        if (!(miss == miss)) break;
        if (miss > 1e-4) at -= off;
      }
      if (miss <= tolerance) vectors.at(x, y) = glm::vec2(at - target);
    }
  });
  return vectors;
}

}  // namespace varve
