// Flicker that moves with the picture: the change of the error along the motion.
#pragma once

#include <glm/vec2.hpp>

#include "diagnose/color_pair.h"

namespace varve {

/// Mean square over time and pixels of e_t(p) - e_{t-1}(p + B), e = test minus reference: what the test changes from
/// one frame to the next along the motion beyond what the reference changes. Both are warped by the same bilinear
/// fetch, so true change, and what the fetch itself does, cancel. Pixels whose vector is not finite, or leads out of
/// the window or onto a bad pixel, take no part.
struct WarpedResidual {
  double squares = 0;
  std::size_t values = 0;
  WarpedResidual& operator+=(const WarpedResidual& more) {
    squares += more.squares;
    values += more.values;
    return *this;
  }
  /// NaN when no pixel took part.
  double mean() const;
};

/// `motion`: backward vectors of the present frame in pixels, y down; empty stands for no motion.
WarpedResidual warped_residual(const ColorPair& now, const ColorPair& before, const Plane<glm::vec2>& motion,
                               Workers& workers);

}  // namespace varve
