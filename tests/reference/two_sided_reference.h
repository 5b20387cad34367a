// The slow twin of the two-sided accumulator: one pixel at a time, in double, straight from the equations.
#pragma once

#include "reference/accumulate_reference.h"
#include "resolve/two_sided.h"

namespace varve::reference {

/// What accumulate_side() must give at (x, y).
struct SidePixel {
  Pixel strict;  ///< total is the discounted weight; 0: the side says nothing
  Color state{};
  double state_total = 0, state_spread = 0;
};
SidePixel side_pixel(const Present& present, const History& beyond, const RecursiveParameters& recursive,
                     const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, unsigned restart_bit, int x,
                     int y);

/// What accumulate_both() must give there, from the two strict sides.
Pixel merged_pixel(const Present& present, const Pixel& past, const Pixel& future, const RecursiveParameters& recursive,
                   std::optional<glm::dvec2> jitter, int x, int y);

}  // namespace varve::reference
