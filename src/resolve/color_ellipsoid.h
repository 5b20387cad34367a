// The variance box without its corners: colors within gamma deviations of the mean in every direction.
#pragma once

#include "resolve/principal_axes.h"

namespace varve {

struct ColorEllipsoid {
  PrincipalAxes frame;
  glm::dvec3 radii{0};  // along the axes

  double crossing(const glm::dvec3& g, const glm::dvec3& h) const;
  /// Along the normal of the surface, found by Newton's method on the reciprocal of the distance function: concave, so
  /// the steps never pass the root.
  glm::dvec3 nearest(const glm::dvec3& h) const;
  glm::dvec3 center() const { return frame.mean; }
};

/// `floor` widens every radius, in units of the color.
ColorEllipsoid make_ellipsoid(const Samples& samples, const Moments& moments, double gamma, double floor);

}  // namespace varve
