// Boxes with faces along the axes of their space: extremes, rounded, four taps, variance.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "resolve/neighborhood.h"

namespace varve {

/// Bounds per component, alpha included; `mean` is that of the samples behind them.
struct AxisBox {
  glm::dvec4 low{0}, high{0}, mean{0};

  /// Share of the way from g (inside) to h that lies inside, up to 1.
  double crossing(const glm::dvec3& g, const glm::dvec3& h) const;
  glm::dvec3 nearest(const glm::dvec3& h) const;
  glm::dvec3 center() const { return glm::dvec3(low) * 0.5 + glm::dvec3(high) * 0.5; }
};

/// Least and greatest (Karis 2014).
AxisBox minmax_box(const Extremes& extremes);

/// The mean of the boxes of 3x3 and of the plus of five pixels: rounder than the 3x3 (Karis 2014, Pedersen 2016).
/// `samples` is room to work in.
AxisBox rounded_box(const AccumulateView& view, int x, int y, Samples& samples);

/// Four bilinear taps on the diagonals, 2/3 pixel away at rest and down to 1/2 pixel as the speed grows beyond half a
/// pixel a frame: what moves fast may vary little (Pedersen 2016). False when none of them has a valid pixel.
bool dynamic_box(const AccumulateView& view, int x, int y, AxisBox& box);

/// Mean plus and minus gamma deviations (Salvi 2016); cut by `extremes` when not null.
AxisBox variance_box(const Moments& moments, double gamma, const Extremes* extremes);

/// Wider by a millionth of the mean's size, so that a flat patch does not clip history by its rounding noise; the
/// scale is common to the color channels, because chroma of a grey is 0.
void widen(AxisBox& box);

/// Size of a color as rounding sees it: its largest component.
double color_size(const glm::dvec3& color);

}  // namespace varve
