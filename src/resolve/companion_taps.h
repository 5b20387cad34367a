// The pixels of the history that a companion is made from, and their sums.
#pragma once

#include "resolve/companion_move.h"

namespace varve {

/// Taps of the history at a pixel, by the rules of the color's fetch and `standing` as from standing_taps(); none
/// found where it has no history.
CompanionTaps find_taps(const AccumulateView& view, int x, int y, unsigned standing);

/// The history by the wide filter, and by the four nearest pixels. `taps.found`, and for the first `taps.wide`.
glm::dvec4 wide_mean(const CompanionTaps& taps, const CompanionRows& plane);
glm::dvec4 inner_mean(const CompanionTaps& taps, const CompanionRows& plane);

/// Between the least and the greatest of the four nearest pixels of the plane itself.
glm::dvec4 held_by_nearest4(const CompanionTaps& taps, const CompanionRows& plane, const glm::dvec4& value);

/// The color's history by the wide filter, held between its nearest pixels if asked. Notes how far towards their mean
/// each channel went for that.
glm::dvec4 held_as_color(const AccumulateView& view, CompanionTaps& taps, const CompanionRows& color);

}  // namespace varve
