// One pixel of the gather: surfaces sorted by depth, their coverage from all frames, cells of equal area.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "gather/arrivals.h"
#include "gather/cells.h"

namespace varve {

/// Cells over the area of the output's filter, on one axis; the filter is the product over both.
struct CellAxis {
  int count = 0;
  float centers[kMaxCells] = {};  ///< pixels from the pixel's middle
  double share[kMaxCells] = {};   ///< of the filter; they sum to 1
  double radius = 0.5;            ///< of the filter, pixels
};

/// What the pixels of a tile have in common.
struct PixelContext {
  std::span<const GatherSource> sources;
  std::size_t present = 0;
  const TileArrivals* arrivals = nullptr;
  CellAxis axis;
  double sigma = 0.09;
  SurfaceTest test;
  const CellKernel* kernel = nullptr;
};

/// Working space of one worker; grows to what the fullest pixel needs.
struct PixelScratch {
  std::vector<const Arrival*> found, ordered;
  std::vector<std::uint8_t> surface;
  std::vector<float> x, y, weight, wx, wy, result;
  std::vector<float> sums, share;
  std::vector<float> px, py, cx, cy, masked, hits, misses;  // of the coverage
  std::vector<std::uint8_t> is_hit;
  std::vector<double> through;
};

/// What becomes of a pixel. Weights are those of each arrival; they sum to 1.
struct PixelWeights {
  std::span<const Arrival* const> arrivals;  ///< null where groups are filled up
  std::span<const float> weights;
  int surfaces = 0;
};

/// Weighs the arrivals around pixel (x, y). Empty where there is none.
PixelWeights weigh_pixel(const PixelContext& context, int x, int y, PixelScratch& scratch);

}  // namespace varve
