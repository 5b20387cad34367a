// How much reading history between pixels blurs: every pass through a kernel adds its variance (Yang et al. 2009,
// slide 12), pixel by pixel for any motion.
#pragma once

#include <glm/vec2.hpp>

#include "resolve/row_passes.h"

namespace varve {

/// Of a box of one pixel, px^2: samples lie anywhere in their pixel.
inline constexpr double kPixelVariance = 1.0 / 12;

/// Second moment around the position itself of the kernel that reads history at a fraction of a pixel, px^2, of one
/// axis. bilinear: v (1 - v); Catmull-Rom and the B-splines through every pixel: 0, since they keep parabolas (5-tap
/// Catmull-Rom nearly so); cubic: by its weights, not below 0.
double kernel_variance(const RecursiveParameters& parameters, double fraction);

/// Variance of the kernel that made what a pixel's history holds, as fetched: that of the pixels it is read from and of
/// the reading, mean of both axes. Where some of the four pixels do not count, of a bilinear fetch from the others.
/// Histories without the plane count as samples of one pixel.
double history_variance(const RowPassView& pass, int x, int y);

}  // namespace varve
