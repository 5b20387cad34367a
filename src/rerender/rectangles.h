// Tiles that get samples, as rectangles to render: fewer, larger ones where that costs less than starting renders.
#pragma once

#include <vector>

#include "rerender/tiles.h"

namespace varve {

struct RenderRectangle {
  Window window;
  int samples = 0;
  double gain = 0, lacking = 0, variance = 0;  ///< sums over the tiles in it
  std::size_t failed = 0, noisy = 0;           ///< pixels
};

/// Rectangles that cover every tile at least with its samples and do not overlap; from the top, then from the left.
/// Two become one, with what lies between, where the samples that are rendered in addition cost no more than `overhead`
/// for each render that is saved (a render is one sample of one rectangle).
std::vector<RenderRectangle> merge_tiles(const TileFrame& frame, int overhead);

/// Samples in all of them.
double cost_of(const std::vector<RenderRectangle>& rectangles);

}  // namespace varve
