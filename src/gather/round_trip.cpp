#include "gather/round_trip.h"

#include <cmath>
#include <limits>

#include "gather/carry.h"

namespace varve {
namespace {

/// How far there and back miss; NaN where it is not known.
double miss(const GatherSource& source, int x, int y, glm::dvec2 vector, const GatherSource& neighbor,
            const Plane<glm::vec2>& back, const SurfaceTest& test) {
  const glm::dvec2 at = source.position(x, y) + vector;
  const glm::dvec2 off = vector + read_between(back, neighbor, at, surface_at(*source.present, x, y), test);
  return std::sqrt(off.x * off.x + off.y * off.y);
}

}  // namespace

void measure_round_trip(const GatherSource& source, const GatherSource& before, const SurfaceTest& test,
                        Plane<float>& out, Workers& workers) {
  if (!source.backward || !before.forward) return;
  const Window& w = source.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const double d = miss(source, x, y, glm::dvec2(source.backward->at(x, y)), before, *before.forward, test);
      out.at(x, y) = d < double(std::numeric_limits<float>::max()) ? float(d) : 0.0f;
    }
  });
}

Plane<glm::vec2> trusted_vectors(const GatherSource& source, const Plane<glm::vec2>& vectors,
                                 const GatherSource& neighbor, const Plane<glm::vec2>& back, const SurfaceTest& test,
                                 double tolerance, Workers& workers) {
  const Window& w = source.window();
  Plane<glm::vec2> trusted = vectors.clone();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      if (!is_followed(source, x, y)) continue;
      glm::vec2& v = trusted.at(x, y);
      const double length = std::sqrt(double(v.x) * double(v.x) + double(v.y) * double(v.y));
      if (miss(source, x, y, glm::dvec2(v), neighbor, back, test) > tolerance + 0.01 * length)
        v = glm::vec2(std::numeric_limits<float>::quiet_NaN());
    }
  });
  return trusted;
}

}  // namespace varve
