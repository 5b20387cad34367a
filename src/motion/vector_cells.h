// A picture cut into blocks, and blocks cut by what they show: the pieces whose vectors are judged together.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/seen_pair.h"

namespace varve {

/// Edge of a block in pixels.
inline constexpr int kVectorBlock = 8;

/// The pixels of one surface in a block.
struct VectorCell {
  int column = 0, row = 0;     ///< of the block
  std::uint32_t label = 0;     ///< of the surface
  int pixels = 0, tested = 0;  ///< of these, pixels whose vector leads to something that can be compared
  glm::dvec2 stored{0};        ///< mean of the usable vectors, pixels
  int usable = 0;              ///< vectors that went into it
  double cost = 0;             ///< mean misfit of the stored vectors, 0 to kWorstMisfit
  double contrast = 0;         ///< standard deviation of the light
  bool suspicious = false;     ///< misfit that neither noise nor aliasing explain
};

/// Cells in reading order of their blocks.
struct VectorCells {
  Window window;
  int columns = 0, rows = 0;
  std::vector<std::size_t> first;  ///< of each block, and one past the last
  std::vector<VectorCell> cells;

  const VectorCell* find(int column, int row, std::uint32_t label) const;
  std::size_t index(const VectorCell& cell) const { return std::size_t(&cell - cells.data()); }
  Window block(int column, int row) const;
};

/// Misfit of a pixel: its miss, at most this; half of it where the surface is not met.
inline constexpr float kWorstMisfit = 0.25f;

/// Misfit of pixel (x, y) with pixel (u, v) there; below 0 where nothing can be compared: outside, hidden.
inline float misfit_at(const SeenPair& pair, int x, int y, int u, int v) {
  // One sample in 3x3 is enough to meet a surface: things thinner than a pixel slip through the rest.
  switch (pair.meet_around(x, y, u, v)) {
    case Meeting::same:
      return std::min(pair.miss(x, y, u, v), kWorstMisfit);
    case Meeting::absent:
      return kWorstMisfit / 2;
    case Meeting::hidden:
    case Meeting::outside:
      break;
  }
  return -1;
}

/// From pixel (x, y) to the nearest pixel that its vector leads to.
struct LandsOn {
  int u = 0, v = 0;
  bool known = false;  ///< false where the vector is NaN or leads out of all bounds
};
inline LandsOn land(const SeenPair& pair, int x, int y, glm::dvec2 vector) {
  const double to_x = x + 0.5 + vector.x + pair.jitter_step().x, to_y = y + 0.5 + vector.y + pair.jitter_step().y;
  if (!(to_x > -1e8 && to_x < 1e8 && to_y > -1e8 && to_y < 1e8)) return {};
  return {int(std::floor(to_x)), int(std::floor(to_y)), true};
}

inline float misfit(const SeenPair& pair, int x, int y, glm::dvec2 vector) {
  const LandsOn at = land(pair, x, y, vector);
  return at.known ? misfit_at(pair, x, y, at.u, at.v) : -1;
}

/// Which surface each pixel shows: its id; without ids pixels that hang together by depth and by their vectors.
Plane<std::uint32_t> label_surfaces(const SeenPair& pair, const Plane<glm::vec2>& vectors, Workers& workers);

/// Cuts a frame into cells and measures the misfit of its vectors. `suspicious` is set where the misfit stands out from
/// that of the frame's better half by `limit` times and from the contrast of the cell.
VectorCells measure_cells(const SeenPair& pair, const Plane<glm::vec2>& vectors, const Plane<std::uint32_t>& labels,
                          double limit, Workers& workers);

}  // namespace varve
