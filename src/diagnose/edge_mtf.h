// Sharpness of a slanted edge: what is left of each spatial frequency (after ISO 12233).
#pragma once

#include <optional>
#include <vector>

#include "base/plane.h"

namespace varve {

struct EdgeSharpness {
  double mtf50 = 0;         ///< cycles per pixel at which half the contrast is left; at most 2
  double width = 0;         ///< pixels from 10 % to 90 % of the step
  double variance = 0;      ///< px^2 of the line spread; misleading where a filter has negative lobes
  std::vector<double> mtf;  ///< at i / 64 cycles per pixel, i = 0..64
};

/// The one edge in the window of `luminance`, within 45 degrees of a row or column, at least 8 pixels across and 8
/// along; about 5 degrees of slant are best. None where there is no edge, or where a value is not finite.
std::optional<EdgeSharpness> edge_sharpness(const Plane<float>& luminance);

}  // namespace varve
