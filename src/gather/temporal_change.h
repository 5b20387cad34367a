// Light of a pixel that other frames do not share: highlights that slide over a surface, switched lamps, pulses.
#pragma once

#include <span>

#include "gather/arrivals.h"

namespace varve {

/// Compares the samples of the frames next to the resolved one with those of frames further off, ring by ring (2-3,
/// 4-7, 8-15, ... frames away) and side by side: where the means of their luminance differ by more than `limit`
/// standard errors (Welch's test with the larger of the two variances, since a few samples may agree by chance), the
/// samples of that ring count less. Detail within the pixel makes both variances large and passes. `weights` are those
/// of `arrivals`; frames have `samples` samples each. 0 or less: no test.
void turn_down_changed(std::span<const Arrival* const> arrivals, std::size_t present, std::size_t samples, double limit,
                       float* weights);

}  // namespace varve
