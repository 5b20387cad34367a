// Samples far brighter than all others of their pixel and surface. Off by default: holding them back takes energy away.
#pragma once

#include <span>
#include <vector>

#include "gather/arrivals.h"

namespace varve {

/// scale[i] in (0, 1] brings the luminance of arrivals[i] down to the median plus `limit` deviations, the deviation
/// being 1.4826 times the median distance from the median (winsorizing; a normal distribution has that deviation).
/// Nothing is held back where a tenth of the samples or more lie beyond: that is light, not a firefly. 0: no test,
/// all 1. `work` is scratch space.
void hold_fireflies(std::span<const Arrival* const> arrivals, double limit, float* scale, std::vector<float>& work);

}  // namespace varve
