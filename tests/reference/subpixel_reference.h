// The slow twin of the four sub-pixel histories: every pixel of every history is looked at, in double, straight from
// the equations.
#pragma once

#include "subpixel/accumulate_subpixel.h"

namespace varve::reference {

struct QuarterPixel {
  bool known = false;
  glm::dvec4 color{0.0};
  double total = 0, spread = 0;
  glm::dvec3 moments{0.0};
  std::array<glm::dvec3, kQuadrants> by_history{};  ///< share of each history in it; total and spread times that
};

/// What the histories, whose ways lead from the present, say of the middle of a quarter of pixel (x, y).
QuarterPixel reconstructed_quarter(const SubpixelHistory& history, const Present& present,
                                   const SubpixelParameters& subpixel, const RecursiveParameters& recursive,
                                   std::size_t target, int x, int y);

/// The same with the present blended in, without bounds.
QuarterPixel blended_quarter(const QuarterPixel& before, const Present& present, const RecursiveParameters& recursive,
                             std::size_t target, int x, int y);

/// The mean of the quarters that are known; the present's color where none is.
QuarterPixel picture_pixel(const SubpixelHistory& history, const Present& present, const SubpixelParameters& subpixel,
                           const RecursiveParameters& recursive, int x, int y);

}  // namespace varve::reference
