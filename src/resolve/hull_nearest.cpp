// The point of a hull nearest to another: Wolfe 1976, Gilbert, Johnson and Keerthi 1988.
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "resolve/hull.h"

namespace varve {
namespace {

/// At most four samples whose combination is the nearest point so far.
struct Simplex {
  std::array<glm::dvec3, 4> corners{};
  std::array<std::size_t, 4> samples{};
  int count = 0;
};

/// Solves the n by n system by elimination with pivots; false when it is singular to rounding.
bool solve(double (&m)[3][4], int n, double (&out)[3]) {
  for (int i = 0; i < n; ++i) {
    int pivot = i;
    for (int j = i + 1; j < n; ++j)
      if (std::abs(m[j][i]) > std::abs(m[pivot][i])) pivot = j;
    if (!(std::abs(m[pivot][i]) > 0)) return false;
    for (int k = 0; k < 4; ++k) std::swap(m[i][k], m[pivot][k]);
    for (int j = i + 1; j < n; ++j) {
      const double f = m[j][i] / m[i][i];
      for (int k = i; k < 4; ++k) m[j][k] -= f * m[i][k];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    double value = m[i][3];
    for (int j = i + 1; j < n; ++j) value -= m[i][j] * out[j];
    out[i] = value / m[i][i];
  }
  return true;
}

/// The combination of the chosen corners nearest to d when all of them have a part in it.
bool nearest_within(const Simplex& simplex, const std::array<int, 4>& chosen, int count, const glm::dvec3& d,
                    glm::dvec3& point) {
  const glm::dvec3 base = simplex.corners[std::size_t(chosen[0])];
  if (count == 1) {
    point = base;
    return true;
  }
  const int n = count - 1;
  std::array<glm::dvec3, 3> edge{};
  double m[3][4] = {}, part[3] = {};
  for (int i = 0; i < n; ++i) edge[std::size_t(i)] = simplex.corners[std::size_t(chosen[std::size_t(i + 1)])] - base;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) m[i][j] = glm::dot(edge[std::size_t(i)], edge[std::size_t(j)]);
    m[i][3] = glm::dot(edge[std::size_t(i)], d - base);
  }
  if (!solve(m, n, part)) return false;
  double first = 1;
  point = base;
  for (int i = 0; i < n; ++i) {
    if (!(part[i] > 0)) return false;
    first -= part[i];
    point += edge[std::size_t(i)] * part[i];
  }
  return first > 0;
}

/// Looks at all faces of the simplex (15 at most) and keeps the one that holds its nearest point.
glm::dvec3 reduce(Simplex& simplex, const glm::dvec3& d) {
  glm::dvec3 best(0);
  double best_distance = INFINITY;
  int best_set = 0;
  for (int set = 1; set < 1 << simplex.count; ++set) {
    std::array<int, 4> chosen{};
    int count = 0;
    for (int i = 0; i < simplex.count; ++i)
      if (set & (1 << i)) chosen[std::size_t(count++)] = i;
    glm::dvec3 point;
    if (!nearest_within(simplex, chosen, count, d, point)) continue;
    const double distance = glm::dot(point - d, point - d);
    if (distance < best_distance) best_distance = distance, best = point, best_set = set;
  }
  Simplex kept;
  for (int i = 0; i < simplex.count; ++i)
    if (best_set & (1 << i)) {
      kept.corners[std::size_t(kept.count)] = simplex.corners[std::size_t(i)];
      kept.samples[std::size_t(kept.count++)] = simplex.samples[std::size_t(i)];
    }
  simplex = kept;
  return best;
}

}  // namespace

glm::dvec3 Hull::nearest(const glm::dvec3& h) const {
  const glm::dvec3 d = h - origin;
  const double far = glm::length(d);
  if (!(far > floor)) return h;
  Simplex simplex;  // starts at the origin, which is a sample
  simplex.count = 1;
  simplex.samples[0] = x.size();
  glm::dvec3 point(0);
  double distance = far * far;
  for (int pass = 0; pass < 128; ++pass) {
    const glm::dvec3 towards = d - point;
    if (!(distance > floor * floor)) return h;
    std::size_t best = 0;
    double gap = -1;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double gain = towards.x * (x[i] - point.x) + towards.y * (y[i] - point.y) + towards.z * (z[i] - point.z);
      if (gain > gap) gap = gain, best = i;
    }
    // The distance to the nearest point, squared, is at most the gap; a corner already in use can only be rounding.
    if (!(gap > 1e-14 * size * far)) break;
    bool used = simplex.count == 4;
    for (int i = 0; i < simplex.count; ++i) used = used || simplex.samples[std::size_t(i)] == best;
    if (used) break;
    Simplex larger = simplex;
    larger.corners[std::size_t(larger.count)] = {x[best], y[best], z[best]};
    larger.samples[std::size_t(larger.count++)] = best;
    const glm::dvec3 closer = reduce(larger, d);
    const double less = glm::dot(closer - d, closer - d);
    if (!(less < distance)) break;
    simplex = larger;
    point = closer;
    distance = less;
  }
  return origin + point;
}

}  // namespace varve
