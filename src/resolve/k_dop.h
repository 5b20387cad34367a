// Discrete oriented polytopes: the extremes of the samples along fixed directions. Each direction more cuts a corner.
#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "resolve/neighborhood.h"

namespace varve {

/// What the samples allow along 7 directions (the axes, the diagonals of the cube) or 13 (those of its faces too).
/// Directions have components 0 and +-1: bounds scale with the light exactly.
struct KDop {
  int directions = 7;
  std::array<double, 13> low{}, high{};

  double crossing(const glm::dvec3& g, const glm::dvec3& h) const;
  /// By the dual active set method (Goldfarb and Idnani 1983, with the identity as matrix); at most three faces are
  /// active at a time.
  glm::dvec3 nearest(const glm::dvec3& h) const;
};

/// `floor` widens every bound, in units of the color.
KDop make_k_dop(const Samples& samples, int directions, double floor);

}  // namespace varve
