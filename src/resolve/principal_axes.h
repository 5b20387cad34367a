// The directions in which a set of colors spreads.
#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "resolve/neighborhood.h"

namespace varve {

/// Mean, orthonormal axes and the variance along each.
struct PrincipalAxes {
  glm::dvec3 mean{0};
  std::array<glm::dvec3, 3> axes{};
  std::array<double, 3> variance{};

  glm::dvec3 to_axes(const glm::dvec3& color) const;
  glm::dvec3 from_axes(const glm::dvec3& along) const;
};

/// Eigenvectors of the covariance by Jacobi's rotations; for a flat or line-like set any completion is right.
PrincipalAxes principal_axes(const Samples& samples, const Moments& moments);

}  // namespace varve
