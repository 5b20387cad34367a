// How history outside a shape is brought onto it, for any shape that knows its crossing and its nearest point.
#pragma once

#include <algorithm>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "resolve/choices.h"

namespace varve {

/// What alpha may be; it goes along with its color.
struct Interval {
  double low = 0, high = 0;

  double crossing(double g, double h) const {
    if (h > high) return std::max(0.0, (high - g) / (h - g));
    return h < low ? std::max(0.0, (low - g) / (h - g)) : 1;
  }
  double nearest(double h) const { return std::clamp(h, low, high); }
};

/// `h` brought onto the shape; `h` itself, bit for bit, when it is inside. `held` says that the target is known to lie
/// inside the shape; otherwise the segment leads to the point of the shape nearest to the target.
template <class Shape>
glm::dvec4 bring_onto(const Shape& shape, const Interval& alpha, BoxRule rule, const glm::dvec4& h,
                      const glm::dvec4& target, bool held) {
  if (rule != BoxRule::clip) return glm::dvec4(shape.nearest(glm::dvec3(h)), alpha.nearest(h.a));
  const glm::dvec4 g(held ? glm::dvec3(target) : shape.nearest(glm::dvec3(target)), alpha.nearest(target.a));
  const double t = std::min(shape.crossing(glm::dvec3(g), glm::dvec3(h)), alpha.crossing(g.a, h.a));
  return t < 1 ? g + (h - g) * t : h;
}

}  // namespace varve
