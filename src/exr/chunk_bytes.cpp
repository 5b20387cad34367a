#include "exr/chunk_bytes.h"

#include <algorithm>

#include "base/error.h"
#include "exr/header_bytes.h"

namespace varve {

StoredChunk read_scanline_chunk(const Container& container, int part, const std::vector<std::uint64_t>& table,
                                std::size_t index, std::size_t limit, std::vector<std::uint8_t>& buffer) {
  const std::size_t head = container.multi_part ? 12 : 8;
  const std::uint64_t at = table[index];
  const auto refuse = [&](const char* reason) {
    const Part& p = container.header.parts[std::size_t(part)];
    const int y = p.data_window.y0 + int(index) * lines_per_chunk(p.compression);
    throw Failure(ExitCode::input, part_in_words(container.header, part) + " is " + reason + " at scan line " +
                                       std::to_string(y) + "; render or copy it again");
  };
  // Chunks mostly follow each other, so the next offset tells the size; where it does not, the head is read first.
  const std::uint64_t next = index + 1 < table.size() ? table[index + 1] : container.file.size();
  const std::size_t guess = next > at ? std::size_t(std::min<std::uint64_t>(next - at, head + limit)) : head;
  if (buffer.size() < head + limit) buffer.resize(head + limit);
  std::size_t have = container.file.read_some(at, buffer.data(), std::max(guess, head));
  if (have < head) refuse("cut off");

  const char* bytes = reinterpret_cast<const char*>(buffer.data());
  if (container.multi_part && load<std::int32_t>(bytes) != part) refuse("damaged");
  const std::int32_t size = load<std::int32_t>(bytes + head - 4);
  if (size <= 0 || std::uint64_t(size) > limit) refuse("damaged");
  const std::size_t end = head + std::size_t(size);
  if (have < end) have += container.file.read_some(at + have, buffer.data() + have, end - have);
  if (have < end) refuse("cut off");
  return {load<std::int32_t>(bytes + head - 8), {buffer.data() + head, std::size_t(size)}};
}

}  // namespace varve
