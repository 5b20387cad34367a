#include "exr/rle_chunk.h"

#include "exr/zip_chunk.h"

namespace varve {

std::vector<std::uint8_t> unpack_runs(std::span<const std::uint8_t> packed, std::size_t size) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(size);
  for (std::size_t at = 0; at < packed.size();) {
    // A negative count: so many bytes as they are; else one byte, count + 1 times.
    const int count = static_cast<signed char>(packed[at++]);
    const std::size_t length = std::size_t(count < 0 ? -count : count + 1), taken = count < 0 ? length : 1;
    if (packed.size() - at < taken || size - bytes.size() < length) return {};
    if (count < 0)
      bytes.insert(bytes.end(), packed.begin() + std::ptrdiff_t(at), packed.begin() + std::ptrdiff_t(at + taken));
    else
      bytes.insert(bytes.end(), length, packed[at]);
    at += taken;
  }
  if (bytes.size() != size) return {};
  undo_differences(bytes.data(), size);
  return bytes;
}

}  // namespace varve
