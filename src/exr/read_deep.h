// The samples of a deep part, line by line, with memory that does not grow with the picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "exr/file_header.h"

namespace varve {

/// One line of a deep scan line or tile.
struct DeepLine {
  int y = 0, x0 = 0;                      ///< display-window pixels
  std::span<const std::uint32_t> first;   ///< pixel x0 + i has the samples first[i] <= s < first[i + 1] of the line
  std::vector<const std::byte*> samples;  ///< one for each channel of the part: all samples of the line in its type,
                                          ///< packed, at any alignment
  std::size_t pixels() const { return first.size() - 1; }
  std::size_t count() const { return first.back(); }
};

/// What one chunk may claim, checked before anything is allocated for it.
struct DeepLimits {
  std::uint64_t chunk_bytes = std::uint64_t(1) << 30;  ///< unpacked samples of one scan line or tile
  std::uint32_t samples_per_pixel = 1u << 17;
  double inflation = 1040;                             ///< unpacked to packed bytes: deflate reaches 1032
  std::uint64_t band_bytes = std::uint64_t(64) << 20;  ///< memory for the chunks at work at one time; a single chunk
                                                       ///< may take more
};

/// Calls `take(line, worker)` for every line of the part, full resolution in tiled parts; several at a time, each
/// pixel once, in no order. Uncompressed, RLE, ZIPS and ZIP chunks, decoded here: the counts of a chunk must agree with
/// the size that it claims before its samples are unpacked. Throws Failure(input) naming the part and the chunk that is
/// cut off, corrupt, or claims more than the limits; Failure(inconsistent) if the file changed.
void read_deep(const FileHeader& header, int part, const DeepLimits& limits, Workers& workers,
               const std::function<void(const DeepLine& line, int worker)>& take);

}  // namespace varve
