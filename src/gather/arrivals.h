// Which samples arrive where: the carried samples of all frames, sorted into tiles of the resolved frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gather/affine_fit.h"
#include "gather/carry.h"

namespace varve {

/// Edge of a tile in pixels, and of the bins in it.
inline constexpr int kTile = 16;
inline constexpr int kBinsPerPixel = 4;

/// One carried sample.
struct Arrival {
  float x, y;            ///< where, pixels from the tile's corner
  float depth;           ///< in the resolved frame
  float gain, weight;    ///< what its light is multiplied with, and how much it counts, in (0, 1]
  float light;           ///< its luminance after the gain
  std::uint32_t id;      ///< of its object
  std::uint32_t pixel;   ///< in its own frame: y * 65536 + x, from the window's corner
  std::uint32_t source;  ///< place among the sources: frame by frame, of each its samples
};

/// Place in the window of frames of `samples` samples each.
inline std::size_t frame_of(const Arrival& a, std::size_t samples) {
  return samples == 1 ? a.source : a.source / samples;  // hot, and a division is slow
}

/// For each tile the blocks of a source's pixels from which something arrives there.
struct BlockLists {
  std::vector<std::uint32_t> begin;   ///< per tile, one more at the end
  std::vector<std::uint32_t> blocks;  ///< block row * 65536 + block column
};

/// Tiles of a window and how far around them samples still count, in pixels.
struct TileGrid {
  Window window;
  double margin = 0.75;
  int columns() const { return (window.width() + kTile - 1) / kTile; }
  int rows() const { return (window.height() + kTile - 1) / kTile; }
};

BlockLists list_blocks(const GatherSource& source, const Carried& field, const TileGrid& grid);

/// A surface in and around a tile, and how it moved there from each frame.
struct TileSurface {
  std::uint32_t id = 0;
  float near = 0, far = 0;
  /// Per frame: x and y as Carried, z the depth in that frame; offsets from the tile's middle.
  std::vector<AffineFit<glm::dvec3>> motion;
};

/// What arrives in and around one tile, sorted by bins of a quarter pixel: row by row, within a bin by source and
/// pixel.
struct TileArrivals {
  Window tile;
  int around = 0;  ///< bins beyond the tile's edge on each side
  int bins = 0;    ///< on an edge
  std::vector<Arrival> sorted;
  std::vector<std::uint32_t> begin;  ///< per bin, one more at the end

  std::vector<TileSurface> surfaces;  ///< empty where all is one surface

  std::vector<Arrival> unsorted;  // working space
  std::vector<std::uint32_t> bin_of;
  std::vector<std::uint8_t> surface_of;
};

/// How much the light of a sample is trusted and what it is multiplied with, where it arrives.
struct LightRule {
  bool gain = false;
  double dead_zone = 0.1, weight = 0.05;
};

/// True if an arrival may be of the surface that has this id and these depths.
inline bool belongs(std::uint32_t id, float near, float far, const Arrival& a, const SurfaceTest& test) {
  return (!test.ids || id == a.id) &&
         (test.near(near, a.depth) || test.near(far, a.depth) || (a.depth >= near && a.depth <= far));
}

/// Fills `out` with what arrives in tile (column, row) of the grid. `present` counts frames.
void collect_arrivals(const TileGrid& grid, int column, int row, std::span<const GatherSource> sources,
                      std::size_t present, std::span<const Carried> fields, std::span<const BlockLists> lists,
                      const LightRule& light, const SurfaceTest& test, TileArrivals& out);

}  // namespace varve
