#include "resolve/surface_test.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/reject.h"

namespace varve {
namespace {

/// How much the depth of the present changes over a pixel, x and y together. The lesser of both sides, so that an edge
/// beside the pixel is no slope; none where both sides lead steeply the same way, as on a wire.
double depth_slope(const Plane<float>& depth, int x, int y) {
  const Window& w = depth.window();
  const double z = double(depth.at(x, y));
  const auto change = [&](int dx, int dy) {
    const bool before = w.contains(x - dx, y - dy), after = w.contains(x + dx, y + dy);
    double a = before ? z - double(depth.at(x - dx, y - dy)) : 0.0;
    double b = after ? double(depth.at(x + dx, y + dy)) - z : 0.0;
    if (!before) a = b;
    if (!after) b = a;
    const double least = std::min(std::abs(a), std::abs(b)), most = std::max(std::abs(a), std::abs(b));
    const bool ridge = a * b < 0 && least > 0.5 * most;
    return std::isfinite(least) && !ridge ? least : 0.0;  // two backgrounds differ by NaN
  };
  return change(1, 0) + change(0, 1);
}

}  // namespace

TestedSurface surface_at(const Present& p, const SurfaceTests& tests, const RejectParameters& reject, int x, int y) {
  TestedSurface s{};
  s.depth = tests.depth;
  s.normal = tests.normal;
  s.id = tests.id;
  if (s.depth) {
    s.z = double(p.depth.at(x, y));
    s.z_tolerance = tests.depth_tolerance;
    s.slope_tolerance = reject.depth_slope > 0 ? reject.depth_slope * depth_slope(p.depth, x, y) : 0;
  }
  if (s.normal) {
    s.n = p.normal.at(x, y);
    s.least_cosine = std::cos(reject.normal_angle * glm::pi<double>() / 180);
  }
  if (s.id) s.name = p.id.at(x, y);
  return s;
}

unsigned failed_tests(const TestedSurface& s, const Plane<float>& depth, const Plane<glm::vec3>& normal,
                      const Plane<std::uint32_t>& id, int x, int y) {
  unsigned failed = 0;
  if (s.depth) {
    const double z = double(depth.at(x, y));
    const bool same = z == s.z || std::abs(z - s.z) <= s.z_tolerance * std::min(z, s.z) + s.slope_tolerance;
    if (!same) failed |= kRejectDepth;
  }
  if (s.normal) {
    const glm::vec3 n = normal.at(x, y);
    const bool known = s.n != glm::vec3(0.0f) && n != glm::vec3(0.0f);
    const double cosine = double(n.x) * double(s.n.x) + double(n.y) * double(s.n.y) + double(n.z) * double(s.n.z);
    // Rounded normals of the same surface may have a product just below 1.
    if (known && !(cosine >= s.least_cosine - 1e-6)) failed |= kRejectNormal;
  }
  if (s.id && id.at(x, y) != s.name) failed |= kRejectId;
  return failed;
}

}  // namespace varve
