// Where the rows of each channel lie inside scan-line chunks.
#pragma once

#include <cstddef>
#include <vector>

#include "exr/container.h"

namespace varve {

/// One row of one channel inside the bytes of a chunk.
struct ChunkRow {
  int channel = 0;  ///< index in Part::channels
  int row = 0;      ///< row of that channel's RawPlane
  std::size_t offset = 0, bytes = 0;
};

/// Rows y0 <= y < y1 of one chunk.
struct ScanlineChunk {
  int y0 = 0, y1 = 0;
  std::size_t bytes = 0;  ///< of all channels, unpacked
};

/// Lines and unpacked size of the chunk with that index, counted from the top.
ScanlineChunk scanline_chunk(const Part& part, std::size_t index);
/// Rows of the chunk in the order they are stored.
std::vector<ChunkRow> chunk_rows(const Part& part, const ScanlineChunk& chunk);

/// Empty planes of the size and type that the channel stores.
RawPlane make_channel_plane(const Part& part, const Channel& channel);

}  // namespace varve
