// The slow twin of the resolve of samples: one pixel at a time, in double, from the definitions.
#pragma once

#include <vector>

#include "resolve/choices.h"
#include "resolve/present.h"

namespace varve::reference {

struct ResolvedPixel {
  glm::dvec4 color{0};
  double weight = 1;       ///< 1 on average
  std::size_t chosen = 0;  ///< sample whose vectors, depth and marks the pixel takes
};

/// Pixel (x, y) of samples that lie at jitter[s], weighed by `filter` where it is not none.
ResolvedPixel resolved_pixel(const std::vector<Present>& samples, SampleFilter filter, int x, int y);

}  // namespace varve::reference
