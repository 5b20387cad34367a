// How much of what differs between the samples of a pixel is noise, and how much is detail.
#pragma once

#include <span>

#include "gather/arrivals.h"

namespace varve {

/// Variance of luminance between samples that arrive in the same quarter pixel, over the variance of all: near 0 where
/// the pixel has an edge or a texture that the samples resolve, 1 where it does not matter where they lie. 0 where
/// there are too few to tell. Arrivals stand in the order of TileArrivals::sorted.
double noise_share(std::span<const Arrival* const> arrivals);

}  // namespace varve
