// Smoothing of edges by their shape, one pixel at a time, straight from its definition.
#pragma once

#include <glm/vec4.hpp>

#include "base/plane.h"

namespace varve::reference {

/// What smooth_edges() makes of pixel (x, y). The area that a contour cuts off is summed up in thin slices.
glm::dvec4 smoothed_pixel(const Plane<glm::vec4>& color, int x, int y);

}  // namespace varve::reference
