#include "reference/camera_reference.h"

#include <array>
#include <cmath>
#include <limits>

namespace varve::reference {
namespace {

using Vector = std::array<double, 3>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double element(const Camera& camera, int row, int column) { return camera.to_camera[column][row]; }

double minor_of(const Camera& c, int r0, int r1, int c0, int c1) {
  return element(c, r0, c0) * element(c, r1, c1) - element(c, r0, c1) * element(c, r1, c0);
}

/// Inverse of the 3x3 part by cofactors, times v.
Vector turned_back(const Camera& c, const Vector& v) {
  double cofactor[3][3], determinant = 0;
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) cofactor[r][k] = minor_of(c, (r + 1) % 3, (r + 2) % 3, (k + 1) % 3, (k + 2) % 3);
  for (int k = 0; k < 3; ++k) determinant += element(c, 0, k) * cofactor[0][k];
  Vector world{};
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) world[std::size_t(k)] += cofactor[r][k] * v[std::size_t(r)] / determinant;
  return world;
}

}  // namespace

SeenPoint reproject(double x, double y, double depth, const Camera& from, const Camera& to) {
  const SeenPoint nowhere{glm::dvec2(kNaN), kNaN};
  const bool flat_from = from.projection == Projection::orthographic;
  const bool flat_to = to.projection == Projection::orthographic;
  const bool infinite = std::isinf(depth);
  if (!(depth > 0) || (infinite && (flat_from || flat_to))) return nowhere;
  Vector point = {(x - from.center.x) / from.focal.x, (y - from.center.y) / from.focal.y, 1};
  if (!infinite) {
    for (int k = 0; k < 2 && !flat_from; ++k) point[std::size_t(k)] *= depth;
    point[2] = depth;
    for (int k = 0; k < 3; ++k) point[std::size_t(k)] -= element(from, k, 3);
  }
  const Vector world = turned_back(from, point);
  Vector seen{};
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) seen[std::size_t(r)] += element(to, r, k) * world[std::size_t(k)];
    if (!infinite) seen[std::size_t(r)] += element(to, r, 3);
  }
  if (!(seen[2] > 0)) return nowhere;
  const double z = flat_to ? 1 : seen[2];
  return {{to.center.x + to.focal.x * seen[0] / z, to.center.y + to.focal.y * seen[1] / z}, infinite ? depth : seen[2]};
}

}  // namespace varve::reference
