#include "resolve/principal_axes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace varve {

glm::dvec3 PrincipalAxes::to_axes(const glm::dvec3& color) const {
  const glm::dvec3 d = color - mean;
  return {glm::dot(axes[0], d), glm::dot(axes[1], d), glm::dot(axes[2], d)};
}

glm::dvec3 PrincipalAxes::from_axes(const glm::dvec3& along) const {
  return mean + (axes[0] * along.x + axes[1] * along.y + axes[2] * along.z);
}

PrincipalAxes principal_axes(const Samples& samples, const Moments& moments) {
  PrincipalAxes p;
  p.mean = {moments.mean[0], moments.mean[1], moments.mean[2]};
  p.axes = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
  double a[3][3] = {};
  for (const glm::dvec4& c : samples) {
    const glm::dvec3 d = glm::dvec3(c) - p.mean;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) a[i][j] += d[i] * d[j];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) a[j][i] = a[i][j] = a[i][j] / std::max(1.0, moments.n);

  for (int sweep = 0; sweep < 12; ++sweep) {
    bool turned = false;
    for (int i = 0; i < 2; ++i)
      for (int j = i + 1; j < 3; ++j) {
        // Beyond this the rotation is less than rounding.
        if (!(std::abs(a[i][j]) > 1e-17 * (std::abs(a[i][i]) + std::abs(a[j][j])))) continue;
        turned = true;
        const double half = (a[j][j] - a[i][i]) / (2 * a[i][j]);
        const double t = std::copysign(1.0, half) / (std::abs(half) + std::sqrt(half * half + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double u = a[k][i], v = a[k][j];
          a[k][i] = c * u - s * v;
          a[k][j] = s * u + c * v;
        }
        for (int k = 0; k < 3; ++k) {
          const double u = a[i][k], v = a[j][k];
          a[i][k] = c * u - s * v;
          a[j][k] = s * u + c * v;
        }
        const glm::dvec3 u = p.axes[std::size_t(i)], v = p.axes[std::size_t(j)];
        p.axes[std::size_t(i)] = u * c - v * s;
        p.axes[std::size_t(j)] = u * s + v * c;
      }
    if (!turned) break;
  }
  for (int k = 0; k < 3; ++k) p.variance[std::size_t(k)] = std::max(0.0, a[k][k]);
  return p;
}

}  // namespace varve
