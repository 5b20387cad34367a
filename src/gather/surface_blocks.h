// What may be found where: a summary of the surfaces in each block of pixels, so that searches skip the rest.
#pragma once

#include <cstdint>
#include <vector>

#include "resolve/present.h"

namespace varve {

/// Edge of a block in pixels.
inline constexpr int kSurfaceBlock = 16;

struct SurfaceBlock {
  std::uint64_t ids = 0;     ///< a bit for each id in it, by hash
  float near = 0, far = -1;  ///< depths in it; far below near where there are none
};

struct SurfaceBlocks {
  int columns = 0;
  std::vector<SurfaceBlock> blocks;  ///< row by row, from the window's corner
};

inline std::uint64_t id_bit(std::uint32_t id) { return std::uint64_t(1) << (id * 2654435761u >> 26); }

SurfaceBlocks summarize_surfaces(const Present& present);

}  // namespace varve
