// The exact convex hull of the samples of a neighborhood (Salvi 2016 shows it as the ideal that boxes approximate).
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "resolve/neighborhood.h"

namespace varve {

/// The samples as seen from one of them, in double; nothing is built, both questions look at the samples themselves.
struct Hull {
  glm::dvec3 origin{0};         ///< a sample
  std::vector<double> x, y, z;  ///< samples minus the origin
  double size = 0;              ///< largest distance of a sample from the origin
  double floor = 0;             ///< by which every sample is widened: what float can tell, a millionth of the size
  mutable std::vector<double> work;

  /// Where a segment from g (inside) to h leaves the hull, as share of the way: at least `low` of it lies inside the
  /// widened hull, no more than `high` inside the exact one plus the floor. high - low <= 1e-8 unless passes ran out.
  struct Crossing {
    double low = 0, high = 1;
    int passes = 0;
  };
  Crossing crossing(const glm::dvec3& g, const glm::dvec3& h, int most_passes) const;

  /// The point of the hull nearest to h; h itself when it is not farther than the floor.
  glm::dvec3 nearest(const glm::dvec3& h) const;
};

/// Fills `hull`, keeping its memory. There is at least one sample.
void make_hull(const Samples& samples, Hull& hull);

}  // namespace varve
