// The chunks of one output part, appended to the file in order.
#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "exr/container.h"
#include "exr/output_bytes.h"

namespace varve {

/// Where chunks go: `number` is the part number in a multi-part file and -1 in a single-part one.
struct ChunkTarget {
  OutputBytes* file = nullptr;
  int number = -1;
};

/// Copies every chunk of a part as it is and returns their new offsets, in table order. The chunks keep the order they
/// have in the source. Throws Failure(input) where the source is damaged.
std::vector<std::uint64_t> copy_chunks(const Container& source, int part, const ChunkTarget& target);

/// Encodes uncompressed, ZIP or ZIPS scan lines; `planes` in the order of part.channels. Chunks are compressed in
/// parallel.
std::vector<std::uint64_t> encode_chunks(const Part& part, const std::vector<const RawPlane*>& planes, int zip_level,
                                         const ChunkTarget& target, Workers& workers);

}  // namespace varve
