#include "exr/scanline_chunks.h"

#include <algorithm>

namespace varve {

ScanlineChunk scanline_chunk(const Part& part, std::size_t index) {
  const int lines = lines_per_chunk(part.compression);
  ScanlineChunk chunk;
  chunk.y0 = part.data_window.y0 + int(index) * lines;
  chunk.y1 = std::min(chunk.y0 + lines, part.data_window.y1);
  for (const Channel& channel : part.channels)
    chunk.bytes += std::size_t(samples_in(chunk.y0, chunk.y1, channel.y_sampling)) *
                   row_bytes(channel, part.data_window, part.data_window.y0);
  return chunk;
}

std::vector<ChunkRow> chunk_rows(const Part& part, const ScanlineChunk& chunk) {
  std::vector<ChunkRow> rows;
  rows.reserve(part.channels.size() * std::size_t(chunk.y1 - chunk.y0));
  std::size_t offset = 0;
  for (int y = chunk.y0; y < chunk.y1; ++y)
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
      const std::size_t bytes = row_bytes(part.channels[c], part.data_window, y);
      if (bytes == 0) continue;
      rows.push_back({int(c), (y - part.data_window.y0) / part.channels[c].y_sampling, offset, bytes});
      offset += bytes;
    }
  return rows;
}

RawPlane make_channel_plane(const Part& part, const Channel& channel) {
  const Window& window = part.data_window;
  if (channel.x_sampling == 1 && channel.y_sampling == 1) return make_raw_plane(channel.type, window);
  RawPlane plane{channel.type, window, channel.x_sampling, channel.y_sampling, 0, 0, {}};
  plane.columns = samples_in(window.x0, window.x1, channel.x_sampling);
  plane.rows = samples_in(window.y0, window.y1, channel.y_sampling);
  plane.storage = Plane<std::byte>(Window{0, 0, plane.columns * int(bytes_per_pixel(channel.type)), plane.rows});
  return plane;
}

}  // namespace varve
