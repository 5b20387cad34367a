// The samples around a pixel, in the space of the box.
#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "resolve/accumulate_row.h"
#include "resolve/moments.h"

namespace varve {

using Samples = std::vector<glm::dvec4>;

inline glm::dvec4 color_at(const PixelRows<const float>& colors, int x, int y) {
  const float* c = colors.origin + y * colors.stride + 4 * x;
  return {double(c[0]), double(c[1]), double(c[2]), double(c[3])};
}

/// The valid samples of the window around (x, y), row by row; without the pixel itself where the view leaves it out.
void gather_samples(const AccumulateView& view, int radius, int x, int y, Samples& samples);

/// True when the pixel's own sample is among them.
bool counts_itself(const AccumulateView& view, int x, int y);

/// Of the samples; two passes, since they are at hand.
Moments moments_of(const Samples& samples);
Extremes extremes_of(const Samples& samples);

}  // namespace varve
