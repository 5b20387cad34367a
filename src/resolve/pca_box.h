// A box along the principal axes of the samples.
#pragma once

#include "resolve/principal_axes.h"

namespace varve {

/// Least and greatest of the samples along their own axes: long and thin where the colors lie along a line.
struct PcaBox {
  PrincipalAxes frame;
  glm::dvec3 low{0}, high{0};  // along the axes

  double crossing(const glm::dvec3& g, const glm::dvec3& h) const;
  glm::dvec3 nearest(const glm::dvec3& h) const;
  glm::dvec3 center() const { return frame.from_axes((low + high) * 0.5); }
};

/// `floor` widens every side, in units of the color.
PcaBox make_pca_box(const Samples& samples, const Moments& moments, double floor);

}  // namespace varve
