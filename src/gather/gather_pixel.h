// One pixel of the gather: surfaces sorted by depth, their coverage from all frames, cells of equal area.
#pragma once

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
  std::size_t present = 0;  ///< place of the resolved frame in the window of frames
  std::size_t samples = 1;  ///< in each pixel of a frame
  const TileArrivals* arrivals = nullptr;
  CellAxis axis;
  double sigma = 0.09;
  double change_limit = 3;
  double firefly_limit = 0;
  SurfaceTest test;
  const CellKernel* kernel = nullptr;
};

/// Brings the largest weight into [1/2, 1) by a power of two, or all to 1 where all are 0: what counts little but has
/// nothing beside it makes the pixel, and sums of products never underflow to 0.
void lift_weights(std::span<float> weights);

inline constexpr double kNoiseSigma = 0.2;  // px

/// 1 / (2 sigma^2) of the cells' Gaussian. With few samples that count, cells must look further for one: n samples a
/// pixel lie n^-1/2 pixels apart. Else the nearest would win, however little it counts.
/// `spacing` is sigma for one sample in a pixel.
/// Where only noise would tell samples apart, near ones know no more than far ones, and cells widen up to kNoiseSigma.
float gaussian_scale(const PixelContext& context, std::span<const float> weights, double spacing, double noise);

/// Where a surface is in one frame, seen from a pixel.
struct Track {
  glm::dvec2 displacement{0};  ///< from that frame to the resolved one, pixels
  float depth = 0;             ///< there
  double distance = 1e300;     ///< of the arrival it was taken from, squared; 1e300: not seen
  double weight = 1;           ///< how much its samples say
  bool known() const { return distance < 1e299; }
};

/// Working space of one worker; grows to what the fullest pixel needs.
struct PixelScratch {
  std::vector<const Arrival*> found, ordered;
  std::vector<std::uint8_t> surface;
  std::vector<float> x, y, weight, wx, wy, result, scale, work;
  std::vector<float> sums, share;
  std::vector<float> px, py, pw, cx, cy, masked, hits, misses;  // of the coverage
  std::vector<std::uint8_t> is_hit;
  std::vector<double> through;
  std::vector<Track> tracks;  ///< by frame
};

/// What becomes of a pixel. Weights are those of each arrival; they sum to 1.
struct PixelWeights {
  std::span<const Arrival* const> arrivals;  ///< null where groups are filled up
  std::span<const float> weights;
  std::span<const float> scale;  ///< of their light, below 1 for fireflies
  int surfaces = 0;
};

/// Weighs the arrivals around pixel (x, y). Empty where there is none.
PixelWeights weigh_pixel(const PixelContext& context, int x, int y, PixelScratch& scratch);

}  // namespace varve
