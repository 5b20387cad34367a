// How much of a pixel a surface covers, from what all frames show where it should be.
#pragma once

#include <span>

#include "gather/gather_pixel.h"

namespace varve {

/// Follows a surface from pixel (x, y) into each frame of the window and looks at the samples there: those that show it
/// are hits, those that show something behind it are misses, those in front of it say nothing. Its motion into a frame
/// is that of `arrivals`, its samples from there; where a frame has none (a thin thing between two samples) it is
/// interpolated between the frames that do. Sums over the cells go into scratch.hits and scratch.misses; their ratio is
/// a coverage in [0, 1], and never 0 : 0.
void measure_coverage(const PixelContext& context, std::span<const Arrival* const> arrivals, int x, int y,
                      PixelScratch& scratch);

}  // namespace varve
