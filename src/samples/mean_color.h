// The plain mean of the samples of a pixel.
#pragma once

#include <span>

#include "base/parallel.h"
#include "resolve/present.h"

namespace varve {

/// The samples of the pixels of one frame: presents of one window with the same planes.
using Samples = std::span<const Present* const>;

/// Color and companions of `out`: in each pixel the mean of its valid samples, where none is, of what stands in for
/// them. Sums are double, so that equal samples give that color exactly. Borders are 0.
void mean_colors(Samples samples, Present& out, Workers& workers);

}  // namespace varve
