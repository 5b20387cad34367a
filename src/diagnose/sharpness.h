// How much of the reference's detail is there: gradients of one picture in those of the other.
#pragma once

#include "diagnose/color_pair.h"

namespace varve {

/// Least squares share of the reference's gradients in the test: sum g_a . g_b / sum g_a . g_a, with g the differences
/// to the right and lower neighbor of the tone-mapped luminance. 1: as sharp; below: blurred; above: sharpened. Noise
/// and aliasing that the reference does not have cancel out, so that a noisy picture does not count as sharp.
struct Sharpness {
  double product = 0, squares = 0;
  Sharpness& operator+=(const Sharpness& more) {
    product += more.product;
    squares += more.squares;
    return *this;
  }
  /// NaN when the reference is flat.
  double share() const;
};

/// Differences that touch a bad pixel take no part.
Sharpness sharpness_of(const ColorPair& pair, Workers& workers);

}  // namespace varve
