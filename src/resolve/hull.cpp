#include "resolve/hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "resolve/axis_box.h"

namespace varve {
namespace {

constexpr double kFloatRounding = 1.0 / (1 << 24);
constexpr double kFloatQuantum = std::numeric_limits<float>::denorm_min();  // no rounding is finer
constexpr double kTolerance = 1e-8;

/// A sample in the frame of the segment: (q, r) across it, p along it.
struct Corner {
  double q, r, p;
};

double cross(const Corner& a, const Corner& b) { return a.q * b.r - a.r * b.q; }

/// Two directions across d, starting from the axis that is least along it.
void frame_of(const glm::dvec3& d, glm::dvec3& a, glm::dvec3& b) {
  const glm::dvec3 size = glm::abs(d);
  const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                          : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                               : glm::dvec3(0, 0, 1);
  a = glm::normalize(glm::cross(d, axis));
  b = glm::cross(d, a);
}

/// Height at the origin of the plane through three corners, and its slopes.
struct Plane3 {
  double height, slope_q, slope_r;
};

Plane3 plane_through(const std::array<Corner, 3>& c) {
  const double w0 = cross(c[1], c[2]), w1 = cross(c[2], c[0]), w2 = cross(c[0], c[1]), area = w0 + w1 + w2;
  const double q1 = c[1].q - c[0].q, r1 = c[1].r - c[0].r, p1 = c[1].p - c[0].p;
  const double q2 = c[2].q - c[0].q, r2 = c[2].r - c[0].r, p2 = c[2].p - c[0].p;
  return {(w0 * c[0].p + w1 * c[1].p + w2 * c[2].p) / area, (p1 * r2 - p2 * r1) / area, (q1 * p2 - q2 * p1) / area};
}

}  // namespace

void make_hull(const Samples& samples, Hull& hull) {
  const std::size_t n = samples.size();
  hull.x.resize(n);
  hull.y.resize(n);
  hull.z.resize(n);
  hull.work.resize(3 * n);
  hull.origin = glm::dvec3(samples[n / 2]);
  hull.size = 0;
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec3 y = glm::dvec3(samples[i]) - hull.origin;
    hull.x[i] = y.x, hull.y[i] = y.y, hull.z[i] = y.z;
    hull.size = std::max(hull.size, glm::length(y));
    largest = std::max(largest, color_size(glm::dvec3(samples[i])));
  }
  hull.floor = std::max({1e-6 * hull.size, 4 * kFloatRounding * largest, 2 * kFloatQuantum});
}

namespace {

/// The segment's view of the samples, lengths in units of `scale`: p along it, q and r across.
struct Across {
  const double *p, *q, *r;
  std::size_t count;
  double top;  // largest p, at least 0
};

Across look_along(const Hull& hull, const glm::dvec3& at, const glm::dvec3& d, double scale) {
  glm::dvec3 a, b;
  frame_of(d, a, b);
  const std::size_t n = hull.x.size();
  double *p = hull.work.data(), *q = p + n, *r = q + n, top = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = (hull.x[i] - at.x) / scale, y = (hull.y[i] - at.y) / scale, z = (hull.z[i] - at.z) / scale;
    p[i] = d.x * x + d.y * y + d.z * z;
    q[i] = a.x * x + a.y * y + a.z * z;
    r[i] = b.x * x + b.y * y + b.z * z;
    top = std::max(top, p[i]);
  }
  return {p, q, r, n, top};
}

/// The widened sample farthest above a plane, and the height over the origin of the parallel plane through it.
Corner farthest_above(const Plane3& plane, const Across& samples, const std::array<Corner, 3>& small, double& height) {
  std::size_t best = 0, corner = 0;
  double support = -1e300, lift = -1e300;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const double above = samples.p[i] - plane.slope_q * samples.q[i] - plane.slope_r * samples.r[i];
    if (above > support) support = above, best = i;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    const double l = -plane.slope_q * small[j].q - plane.slope_r * small[j].r;
    if (l > lift) lift = l, corner = j;
  }
  height = support + lift;
  return {samples.q[best] + small[corner].q, samples.r[best] + small[corner].r, samples.p[best]};
}

/// Puts the new corner in place of the one that leaves the origin between the other two and it.
void refine(std::array<Corner, 3>& portal, const Corner& next) {
  const double s[3] = {cross(next, portal[0]), cross(next, portal[1]), cross(next, portal[2])};
  std::size_t keep = 0;
  double fit = -1e300;
  for (std::size_t j = 0; j < 3; ++j) {
    const double inside = std::min(s[j], -s[(j + 1) % 3]);
    if (inside > fit) fit = inside, keep = j;
  }
  portal[(keep + 2) % 3] = next;
}

}  // namespace

// The height of the hull's upper side over the origin of the (q, r) plane: a linear program in three variables, solved
// by refining a triangle ("portal") around that origin with the sample farthest above it. (Simplex with the steepest
// support; Snethen's portal refinement, XenoCollide 2008, is its kin.) The triangle of the first pass stands for a
// sample widened by the floor, and so does every other: flat, line-like and repeated samples need no case of their own.
Hull::Crossing Hull::crossing(const glm::dvec3& g, const glm::dvec3& h, int most_passes) const {
  const glm::dvec3 way = h - g, at = g - origin;
  const double distance = glm::length(way);
  if (!(distance > floor)) return {1, 1, 0};
  const double scale = std::max({size, glm::length(at), floor}), goal = distance / scale, eta = floor / scale;
  const Across samples = look_along(*this, at, way / distance, scale);
  // An equilateral triangle, turned a little so that its sides lie along no lattice.
  const std::array<Corner, 3> small = {Corner{0.98768834 * eta, 0.15643447 * eta, 0},
                                       Corner{-0.62932039 * eta, 0.77714596 * eta, 0},
                                       Corner{-0.35836795 * eta, -0.93358043 * eta, 0}};
  std::array<Corner, 3> portal = small;
  double low = 0, high = samples.top;
  int pass = 0;
  while (pass < most_passes) {
    ++pass;
    const Plane3 plane = plane_through(portal);
    low = std::max(low, plane.height);
    if (low >= goal) return {1, 1, pass};
    double height;
    const Corner next = farthest_above(plane, samples, small, height);
    high = std::min(high, height);
    if (!(high - low > kTolerance * std::min(1.0, goal))) break;
    refine(portal, next);
  }
  high = std::max(low, high);
  return {std::min(1.0, low / goal), std::min(1.0, high / goal), pass};
}

}  // namespace varve
