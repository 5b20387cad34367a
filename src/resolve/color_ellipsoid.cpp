#include "resolve/color_ellipsoid.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace varve {
namespace {

// A radius of 0 would divide by it; this is below what a float can hold.
constexpr double kLeastRadius = 1e-60;

}  // namespace

ColorEllipsoid make_ellipsoid(const Samples& samples, const Moments& moments, double gamma, double floor) {
  ColorEllipsoid e{principal_axes(samples, moments), glm::dvec3(0)};
  for (int k = 0; k < 3; ++k)
    e.radii[k] = std::max(gamma * std::sqrt(e.frame.variance[std::size_t(k)]) + floor, kLeastRadius);
  return e;
}

double ColorEllipsoid::crossing(const glm::dvec3& g, const glm::dvec3& h) const {
  const glm::dvec3 to = frame.to_axes(h) / radii;
  if (glm::dot(to, to) <= 1) return 1;
  const glm::dvec3 from = frame.to_axes(g) / radii, way = to - from;
  const double a = glm::dot(way, way), b = glm::dot(from, way), c = std::min(0.0, glm::dot(from, from) - 1);
  const double root = std::sqrt(b * b - a * c);
  const double t = b > 0 ? -c / (b + root) : (root - b) / a;  // of the two forms the one that does not cancel
  return std::clamp(t, 0.0, 1.0);
}

glm::dvec3 ColorEllipsoid::nearest(const glm::dvec3& h) const {
  const glm::dvec3 y = frame.to_axes(h), unit = y / radii;
  if (glm::dot(unit, unit) <= 1) return h;
  const glm::dvec3 r2 = radii * radii;
  double t = 0;
  for (int step = 0; step < 60; ++step) {
    const glm::dvec3 u = radii * y / (r2 + t);
    const double f = glm::dot(u, u), slope = glm::dot(u * u, 1.0 / (r2 + t));  // -df/dt / 2
    const double next = t + (std::sqrt(f) - 1) * f / slope;
    if (!(next > t * (1 + 1e-15))) break;
    t = next;
  }
  return frame.from_axes(r2 * y / (r2 + t));
}

}  // namespace varve
