#include "reference/hull_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace varve::reference {
namespace {

using Real = long double;

/// Least squares of min |sum l_i y_i - t d| with sum l_i = 1, by elimination of the normal equations in the unknowns
/// l_2.., t; false when they are singular.
bool meet(const std::vector<std::array<Real, 3>>& y, const std::array<Real, 3>& d, std::vector<Real>& out) {
  const std::size_t n = y.size();  // unknowns: n - 1 shares and t
  std::vector<std::array<Real, 3>> column;
  for (std::size_t i = 1; i < n; ++i) column.push_back({y[i][0] - y[0][0], y[i][1] - y[0][1], y[i][2] - y[0][2]});
  column.push_back({-d[0], -d[1], -d[2]});
  Real m[3][4] = {};
  const auto dot = [](const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) m[i][j] = dot(column[i], column[j]);
    m[i][3] = -dot(column[i], y[0]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Real scale = dot(column[i], column[i]);
    if (!(m[i][i] > 1e-13L * scale) || scale == 0) return false;
    for (std::size_t j = 0; j < n; ++j)
      if (j != i) {
        const Real f = m[j][i] / m[i][i];
        for (std::size_t k = i; k < 4; ++k) m[j][k] -= f * m[i][k];
      }
  }
  out.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) out[i] = m[i][3] / m[i][i];
  return true;
}

}  // namespace

double exit_by_faces(const std::vector<glm::dvec3>& points, const glm::dvec3& g, const glm::dvec3& d, double slack) {
  std::vector<std::array<Real, 3>> y;
  for (const glm::dvec3& p : points)
    y.push_back({static_cast<Real>(p.x) - g.x, static_cast<Real>(p.y) - g.y, static_cast<Real>(p.z) - g.z});
  const std::array<Real, 3> way = {d.x, d.y, d.z};
  Real best = 0;  // g is inside
  const auto consider = [&](const std::vector<std::array<Real, 3>>& corners) {
    std::vector<Real> x;
    if (!meet(corners, way, x)) return;
    Real first = 1, miss = 0;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      if (x[i] < -1e-12L) return;
      first -= x[i];
    }
    if (first < -1e-12L) return;
    for (std::size_t k = 0; k < 3; ++k) {
      Real at = first * corners[0][k] - x.back() * way[k];
      for (std::size_t i = 0; i + 1 < x.size(); ++i) at += x[i] * corners[i + 1][k];
      miss += at * at;
    }
    if (std::sqrt(miss) <= slack) best = std::max(best, x.back());
  };
  for (std::size_t i = 0; i < y.size(); ++i) {
    consider({y[i]});
    for (std::size_t j = i + 1; j < y.size(); ++j) {
      consider({y[i], y[j]});
      for (std::size_t k = j + 1; k < y.size(); ++k) consider({y[i], y[j], y[k]});
    }
  }
  return double(best);
}

double exit_by_planes(const std::vector<glm::dvec3>& points, const glm::dvec3& g, const glm::dvec3& d, double eta) {
  const double length = glm::length(d);
  const glm::dvec3 along = d / length;
  const glm::dvec3 other = std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(along, other)), b = glm::cross(along, a);
  struct Point {
    Real q, r, p;
  };
  std::vector<Point> corners;
  for (const glm::dvec3& point : points)
    for (int j = 0; j < 3; ++j) {
      const double angle = 0.3 + j * 2.0943951023931953;
      corners.push_back({static_cast<Real>(glm::dot(a, point - g)) + eta * std::cos(angle),
                         static_cast<Real>(glm::dot(b, point - g)) + eta * std::sin(angle),
                         glm::dot(along, point - g)});
    }
  // Planes p = z + A q + B r above all corners; the lowest z is that of one through three of them.
  Real best = std::numeric_limits<Real>::infinity(), size = 0;
  for (const Point& c : corners) size = std::max({size, std::abs(c.q), std::abs(c.r), std::abs(c.p)});
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      for (std::size_t k = j + 1; k < corners.size(); ++k) {
        const Point &o = corners[i], &u = corners[j], &v = corners[k];
        const Real q1 = u.q - o.q, r1 = u.r - o.r, p1 = u.p - o.p, q2 = v.q - o.q, r2 = v.r - o.r, p2 = v.p - o.p;
        const Real area = q1 * r2 - q2 * r1;
        if (std::abs(area) <= 1e-16L * size * size * 1e-3L) continue;
        const Real slope_q = (p1 * r2 - p2 * r1) / area, slope_r = (q1 * p2 - q2 * p1) / area;
        const Real z = o.p - slope_q * o.q - slope_r * o.r;
        if (!(z < best)) continue;
        bool above = true;
        for (const Point& c : corners)
          above = above && c.p - slope_q * c.q - slope_r * c.r <=
                               z + 1e-14L * size * (1 + std::abs(slope_q) + std::abs(slope_r));
        if (above) best = z;
      }
  return double(best / length);
}

glm::dvec3 nearest_by_faces(const std::vector<glm::dvec3>& points, const glm::dvec3& h) {
  glm::dvec3 mean(0);
  for (const glm::dvec3& p : points) mean += p / double(points.size());
  const double away = glm::length(h - mean);
  if (away <= 1e-12 * glm::length(mean)) return h;
  if (exit_by_faces(points, mean, h - mean, 1e-12 * away) >= 1) return h;
  glm::dvec3 best = points.front();
  const auto consider = [&](const glm::dvec3& p) {
    if (glm::length(p - h) < glm::length(best - h)) best = p;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    consider(points[i]);
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const glm::dvec3 u = points[j] - points[i], d = h - points[i];
      const double uu = glm::dot(u, u), ud = glm::dot(u, d);
      if (uu > 0) consider(points[i] + u * std::clamp(ud / uu, 0.0, 1.0));
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        const glm::dvec3 v = points[k] - points[i];
        const double vv = glm::dot(v, v), uv = glm::dot(u, v), vd = glm::dot(v, d), area = uu * vv - uv * uv;
        if (!(area > 1e-12 * uu * vv)) continue;  // a line: its ends have been looked at
        const double a = (ud * vv - vd * uv) / area, b = (vd * uu - ud * uv) / area;
        if (a >= 0 && b >= 0 && a + b <= 1) consider(points[i] + u * a + v * b);
      }
    }
  }
  return best;
}

}  // namespace varve::reference
