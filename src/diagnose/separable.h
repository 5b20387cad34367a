// Separable convolution with clamped borders, for the metrics that look at neighborhoods.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Odd number of weights, the middle one at the pixel itself: out(x) = sum k[i] in(x + i - radius).
using Kernel = std::vector<float>;

/// Along rows; beyond the window the nearest pixel counts.
Plane<float> convolve_rows(const Plane<float>& in, const Kernel& kernel, Workers& workers);
/// Along columns, likewise.
Plane<float> convolve_columns(const Plane<float>& in, const Kernel& kernel, Workers& workers);

/// exp(-x^2 / (2 sigma^2)) at whole distances, summing to 1. `sigma` in pixels.
Kernel gaussian_kernel(double sigma, int radius);

}  // namespace varve
