// RLE chunks: byte planes split, differences, runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varve {

/// The chunk's bytes with differences undone: first all even bytes, then all odd ones. Empty when `packed` is corrupt
/// or does not give exactly `size` bytes.
std::vector<std::uint8_t> unpack_runs(std::span<const std::uint8_t> packed, std::size_t size);

}  // namespace varve
