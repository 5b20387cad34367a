// The slow twin of measure_shift(): one pixel and one neighbor at a time, in double, with numeric derivatives.
#pragma once

#include <glm/vec2.hpp>

#include "base/plane.h"

namespace varve::reference {

struct Shift {
  glm::dvec2 shift{0}, sigma{0};
};

/// For planes that have a solution; `motion` over the window of `now`.
Shift sub_pixel_shift(const Plane<float>& now, const Plane<float>& before, const Plane<glm::vec2>& motion);

}  // namespace varve::reference
