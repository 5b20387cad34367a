#include "exr/write_chunks.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

#include "base/error.h"
#include "exr/header_bytes.h"
#include "exr/scanline_chunks.h"
#include "exr/zip_chunk.h"

namespace varve {
namespace {

// What a chunk says of itself before its pixels: coordinates (kept as they are) and how many bytes follow.
struct ChunkHead {
  std::string coordinates_and_sizes;
  std::uint64_t payload = 0;
};

ChunkHead read_head(const Container& source, int part, std::uint64_t offset) {
  const Part& p = source.header.parts[std::size_t(part)];
  const std::size_t number = source.multi_part ? 4 : 0;
  const bool tiles = p.storage == Storage::tiled || p.storage == Storage::deep_tiled;
  const std::size_t coordinates = tiles ? 16 : 4, sizes = is_deep(p) ? 24 : 4;
  std::string head(number + coordinates + sizes, '\0');
  source.file.read(offset, head.data(), head.size(), "chunks");
  const char* size = head.data() + number + coordinates;
  const std::uint64_t end = source.file.size() - offset - head.size();
  // Deep chunks: packed sample counts, packed samples, unpacked samples. Only the first two follow.
  const std::uint64_t first = is_deep(p) ? load<std::uint64_t>(size) : load<std::uint32_t>(size);
  const std::uint64_t second = is_deep(p) ? load<std::uint64_t>(size + 8) : 0;
  const bool stranger = source.multi_part && load<std::int32_t>(head.data()) != part;
  if (stranger || first > end || second > end - first)
    throw Failure(ExitCode::input,
                  part_in_words(source.header, part) + " is cut off or damaged; render or copy it again");
  return {head.substr(number), first + second};
}

void append_number(std::string& to, const ChunkTarget& target) {
  if (target.number >= 0) append(to, std::int32_t(target.number));
}

// Chunks handed to one worker at a time and written at once.
struct Batch {
  std::string bytes;
  std::vector<std::uint64_t> starts;  // of its chunks, in `bytes`
};

struct Encoder {
  const Part& part;
  const std::vector<const RawPlane*>& planes;
  const ChunkTarget& target;

  // A row's bytes in its plane, which may be larger than the part's window.
  const std::uint8_t* source(const ChunkRow& row) const {
    const Channel& channel = part.channels[std::size_t(row.channel)];
    const RawPlane& plane = *planes[std::size_t(row.channel)];
    const int down = (part.data_window.y0 - plane.window.y0) / channel.y_sampling;
    const int right = (part.data_window.x0 - plane.window.x0) / channel.x_sampling;
    const std::byte* pixels = plane.row(row.row + down) + std::size_t(right) * bytes_per_pixel(channel.type);
    return reinterpret_cast<const std::uint8_t*>(pixels);
  }

  void encode(std::size_t index, ZipWriter* zip, std::vector<std::uint8_t>& packed, Batch& batch) const {
    const ScanlineChunk chunk = scanline_chunk(part, index);
    const std::vector<ChunkRow> rows = chunk_rows(part, chunk);
    bool smaller = false;
    if (zip && chunk.bytes > 0) {
      std::uint8_t* even = zip->planes(chunk.bytes);
      std::uint8_t* odd = even + chunk.bytes / 2;
      for (const ChunkRow& row : rows)
        split_bytes(source(row), even + row.offset / 2, odd + row.offset / 2, row.bytes / 2);
      smaller = zip->pack(chunk.bytes, packed);
    }
    batch.starts.push_back(batch.bytes.size());
    append_number(batch.bytes, target);
    append(batch.bytes, std::int32_t(chunk.y0));
    append(batch.bytes, std::uint32_t(smaller ? packed.size() : chunk.bytes));
    if (smaller)
      batch.bytes.append(reinterpret_cast<const char*>(packed.data()), packed.size());
    else
      for (const ChunkRow& row : rows) batch.bytes.append(reinterpret_cast<const char*>(source(row)), row.bytes);
  }
};

}  // namespace

std::vector<std::uint64_t> copy_chunks(const Container& source, int part, const ChunkTarget& target) {
  const std::vector<std::uint64_t> table = read_chunk_table(source, part);
  std::vector<std::size_t> order(table.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return table[a] < table[b]; });

  std::vector<std::uint64_t> offsets(table.size());
  std::string buffer;
  std::uint64_t end = 0;
  for (std::size_t index : order) {
    // Chunks that overlap would make a small file grow without bound.
    if (table[index] < end)
      throw Failure(ExitCode::input,
                    part_in_words(source.header, part) + " has overlapping chunks; render or copy it again");
    const ChunkHead head = read_head(source, part, table[index]);
    offsets[index] = target.file->size();
    buffer.clear();
    append_number(buffer, target);
    buffer += head.coordinates_and_sizes;
    std::uint64_t from = table[index] + (source.multi_part ? 4 : 0) + head.coordinates_and_sizes.size();
    end = from + head.payload;
    while (from < end) {
      const std::size_t old = buffer.size(), piece = std::size_t(std::min<std::uint64_t>(end - from, 1 << 20));
      buffer.resize(old + piece);
      source.file.read(from, buffer.data() + old, piece, "chunks");
      from += piece;
      target.file->append(buffer.data(), buffer.size());
      buffer.clear();
    }
    target.file->append(buffer.data(), buffer.size());
  }
  return offsets;
}

std::vector<std::uint64_t> encode_chunks(const Part& part, const std::vector<const RawPlane*>& planes, int zip_level,
                                         const ChunkTarget& target, Workers& workers) {
  const std::size_t chunks = std::size_t(chunk_count(part, {}));
  // Single lines are gathered into batches that are worth a system call.
  const std::size_t per_batch =
      std::clamp<std::size_t>((1 << 17) / std::max<std::size_t>(1, scanline_chunk(part, 0).bytes), 1, 64);
  const std::size_t batches = (chunks + per_batch - 1) / per_batch, ahead = 4 * std::size_t(workers.count());
  std::vector<Batch> slots(ahead);
  std::vector<std::vector<std::uint8_t>> packed(std::size_t(workers.count()));
  std::vector<ZipWriter> zips;
  if (part.compression != Compression::none)
    for (int i = 0; i < workers.count(); ++i) zips.emplace_back(zip_level);

  const Encoder encoder{part, planes, target};
  std::vector<std::uint64_t> offsets;
  offsets.reserve(chunks);
  workers.in_order(
      batches, ahead,
      [&](std::size_t i, int worker) {
        Batch& batch = slots[i % ahead];
        batch.bytes.clear();
        batch.starts.clear();
        for (std::size_t c = i * per_batch; c < std::min(chunks, (i + 1) * per_batch); ++c)
          encoder.encode(c, zips.empty() ? nullptr : &zips[std::size_t(worker)], packed[std::size_t(worker)], batch);
      },
      [&](std::size_t i) {
        const Batch& batch = slots[i % ahead];
        for (std::uint64_t start : batch.starts) offsets.push_back(target.file->size() + start);
        target.file->append(batch.bytes.data(), batch.bytes.size());
      });
  return offsets;
}

}  // namespace varve
