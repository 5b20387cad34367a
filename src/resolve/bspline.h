// Coefficients of the B-spline that passes through every pixel (Unser, Aldroubi, Eden 1993).
#pragma once

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Coefficients whose B-spline of `degree` 3 or 5 equals `color` at every pixel; the picture goes on mirrored about its
/// outermost pixels. Recursive filters in double along rows, then columns, exactly constant where `color` is. Held at
/// the ends of the float range, which only colors above 6e36 reach.
Plane<glm::vec4> bspline_coefficients(const Plane<glm::vec4>& color, int degree, Workers& workers);

}  // namespace varve
