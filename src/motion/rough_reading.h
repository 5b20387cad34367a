// Vectors that follow the motion but for a factor that changes from frame to frame: an open shutter on curved motion.
#pragma once

#include <vector>

#include "motion/hypotheses.h"

namespace varve {

/// The factor that brings the vectors of one pair of frames onto the motion, along each axis; 0 where nothing moves.
struct PairScale {
  int pair = 0;
  double along_x = 0, along_y = 0;
};

/// A direction with signs, and how well it does with factors of its own for each pair and axis.
struct RoughReading {
  VectorHypothesis hypothesis;  ///< the scale is the median of the factors
  double agreement = 0;         ///< share of the places that move that are met within half a pixel and 15 % of the way
  std::size_t places = 0;
  std::vector<PairScale> scales;
};

/// Every direction and pair of signs, best first. Channels are taken in their order; only positive factors count.
std::vector<RoughReading> rough_readings(const std::vector<FollowedPlace>& places, int x, int y, const Window& display);

}  // namespace varve
