// The slow twin of the composite: one pixel at a time, every transmittance of the stack at hand, in long double.
#pragma once

#include <span>

#include <glm/vec4.hpp>

#include "base/combine_request.h"
#include "resolve/present.h"

namespace varve::reference {

/// What a stack of layers, the nearest first, gives at (x, y).
struct StackedPixel {
  glm::dvec4 color{0.0};
  int winner = 0;  ///< 1 and up; 0: the background
  double variation = 0;
  int touched = 0;
};
StackedPixel stacked_pixel(std::span<const Present* const> layers, LayerRule rule, int x, int y);

}  // namespace varve::reference
