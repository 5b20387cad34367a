// The stored bytes of scan-line chunks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exr/container.h"

namespace varve {

struct StoredChunk {
  int y = 0;  ///< first scan line, as the chunk says itself
  std::span<const std::uint8_t> packed;
};

/// Reads chunk `index` into `buffer`, in one read when the table tells where it ends. A chunk larger than `limit` bytes
/// (its unpacked size) is refused, so `buffer` stays bounded. Throws Failure(input) naming the scan line.
StoredChunk read_scanline_chunk(const Container& container, int part, const std::vector<std::uint64_t>& table,
                                std::size_t index, std::size_t limit, std::vector<std::uint8_t>& buffer);

/// Opens the file of a header again; throws Failure(inconsistent) if it no longer is the same file.
Container reopen(const FileHeader& header);

}  // namespace varve
