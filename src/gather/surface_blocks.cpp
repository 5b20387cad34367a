#include "gather/surface_blocks.h"

#include <algorithm>

namespace varve {

SurfaceBlocks summarize_surfaces(const Present& present) {
  const Window& w = present.color.window();
  SurfaceBlocks s;
  s.columns = (w.width() + kSurfaceBlock - 1) / kSurfaceBlock;
  s.blocks.resize(std::size_t(s.columns) * std::size_t((w.height() + kSurfaceBlock - 1) / kSurfaceBlock));
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      SurfaceBlock& b = s.blocks[std::size_t((y - w.y0) / kSurfaceBlock * s.columns + (x - w.x0) / kSurfaceBlock)];
      if (!present.id.empty()) b.ids |= id_bit(present.id.at(x, y));
      const float depth = present.depth.empty() ? 0.0f : present.depth.at(x, y);
      if (b.far < b.near)
        b.near = b.far = depth;
      else
        b.near = std::min(b.near, depth), b.far = std::max(b.far, depth);
    }
  return s;
}

}  // namespace varve
