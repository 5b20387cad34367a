// The pixels of the history that a companion is made from, and their sums.
#pragma once

#include "resolve/companion_move.h"

namespace varve {

/// Taps of the history at a pixel, by the rules of the color's fetch; none found where it has no history.
CompanionTaps find_taps(const AccumulateView& view, int x, int y);

/// The history by the wide filter, and by the four nearest pixels. `taps.found`, and for the first `taps.wide`.
glm::dvec4 wide_mean(const CompanionTaps& taps, const CompanionRows& plane);
glm::dvec4 inner_mean(const CompanionTaps& taps, const CompanionRows& plane);

/// Between the least and the greatest of the four nearest pixels of the plane itself.
glm::dvec4 held_by_nearest4(const CompanionTaps& taps, const CompanionRows& plane, const glm::dvec4& value);

/// How far the color's fetch went from the wide filter's value to the mean of the nearest four, to hold it between
/// them.
glm::dvec3 hold_of(const AccumulateView& view, const CompanionTaps& taps, const CompanionRows& color);

}  // namespace varve
