// Area-weighted reconstruction: a pixel's filter area is cut into cells, and each cell takes the Gaussian-weighted mean
// of the samples near it, so that samples that crowd together share one say. Plain arrays and numbers: the functions
// are compiled once per processor and give the same bits on each.
#pragma once

#include <cstddef>

namespace varve {

/// Samples come in groups of this many; the rest of the last group has weight 0.
inline constexpr int kCellLanes = 8;
/// Most cells on an axis.
inline constexpr int kMaxCells = 32;

struct CellKernel {
  /// weights[c * stride + i] = exp(-(position[i] - center[c])^2 * scale), never below a floor that keeps products of
  /// two normal numbers. `count` is a multiple of kCellLanes.
  void (*axis_weights)(const float* position, int count, const float* centers, int cells, float scale, float* weights,
                       std::ptrdiff_t stride);
  /// sums[j * cells + i] = sum over samples of wx[i] * wy[j].
  void (*cell_sums)(const float* wx, const float* wy, std::ptrdiff_t stride, int count, int cells, float* sums);
  /// weight[k] = sum over cells of share[j * cells + i] * wx[i][k] * wy[j][k].
  void (*sample_weights)(const float* wx, const float* wy, std::ptrdiff_t stride, int count, int cells,
                         const float* share, float* weight);
};

namespace baseline {
extern const CellKernel cell_kernel;
}
namespace avx2 {
extern const CellKernel cell_kernel;
}

}  // namespace varve
