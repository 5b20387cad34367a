#include "exr/read_deep.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "exr/chunk_bytes.h"
#include "exr/container.h"
#include "exr/header_bytes.h"
#include "exr/rle_chunk.h"
#include "exr/zip_chunk.h"

namespace varve {
namespace {

constexpr std::size_t kCountBytes = 4;

/// Where a chunk lies, and what it says of itself.
struct DeepChunk {
  Window window;             ///< its pixels
  std::uint64_t offset = 0;  ///< of its packed counts
  std::uint64_t packed_counts = 0, packed = 0, unpacked = 0;
  bool plain_counts = false;

  std::uint64_t counts() const { return std::uint64_t(window.pixels()) * kCountBytes; }
  /// Memory at work: counts, packed bytes, and the samples inflated, joined, and as floats.
  std::uint64_t memory() const { return 3 * counts() + packed + 3 * unpacked; }
};

[[noreturn]] void refuse(const FileHeader& header, int part, const Window& at, const std::string& reason) {
  throw Failure(ExitCode::input, part_in_words(header, part) + " is damaged at scan line " + std::to_string(at.y0) +
                                     ": " + reason + "; render or copy it again");
}

// The chunks of the full resolution come first in the table, rows of tiles from the top.
std::vector<Window> chunk_windows(const Part& part, const Tiling& tiling) {
  const Window& all = part.data_window;
  const bool tiles = part.storage == Storage::deep_tiled;
  const int width = tiles ? int(tiling.width) : all.width();
  const int height = tiles ? int(tiling.height) : lines_per_chunk(part.compression);
  std::vector<Window> windows;
  for (int y = all.y0; y < all.y1; y += height)
    for (int x = all.x0; x < all.x1; x += width)
      windows.push_back({x, y, std::min(x + width, all.x1), std::min(y + height, all.y1)});
  return windows;
}

// Bytes of the counts of a chunk that no edge of the picture cuts.
std::uint64_t whole_counts(const Part& part, const Tiling& tiling) {
  if (part.storage == Storage::deep_tiled) return std::uint64_t(tiling.width) * tiling.height * kCountBytes;
  return std::uint64_t(part.data_window.width()) * std::uint64_t(lines_per_chunk(part.compression)) * kCountBytes;
}

DeepChunk read_chunk_head(const Container& container, int part, const Window& window, std::uint64_t offset,
                          const DeepLimits& limits) {
  const Part& p = container.header.parts[std::size_t(part)];
  const Tiling& tiling = container.raw[std::size_t(part)].tiling;
  const bool tiles = p.storage == Storage::deep_tiled;
  const std::size_t number = container.multi_part ? 4 : 0, coordinates = tiles ? 16 : 4;
  char head[4 + 16 + 24];
  const std::size_t size = number + coordinates + 24;
  container.file.read(offset, head, size, "deep chunks");
  const char* at = head + number;
  bool here = number == 0 || load<std::int32_t>(head) == part;
  if (tiles)
    here = here && load<std::int32_t>(at) == (window.x0 - p.data_window.x0) / int(tiling.width) &&
           load<std::int32_t>(at + 4) == (window.y0 - p.data_window.y0) / int(tiling.height) &&
           load<std::int32_t>(at + 8) == 0 && load<std::int32_t>(at + 12) == 0;
  else
    here = here && load<std::int32_t>(at) == window.y0;
  if (!here) refuse(container.header, part, window, "its chunks are mixed up");
  at += coordinates;
  DeepChunk chunk{window, offset + size, load<std::uint64_t>(at), load<std::uint64_t>(at + 8),
                  load<std::uint64_t>(at + 16)};
  const std::uint64_t left = container.file.size() - std::min(container.file.size(), chunk.offset);
  if (chunk.packed_counts > left || chunk.packed > left - chunk.packed_counts)
    refuse(container.header, part, window, "the chunk there is cut off");
  const auto beyond = [&](std::uint64_t unpacked, std::uint64_t packed) {
    return packed > unpacked || !(double(unpacked) <= limits.inflation * double(packed) + 64);
  };
  // Counts are stored plain where they have the size of those of a whole chunk, and packed otherwise; at the edges of
  // the picture that may be more than they need.
  chunk.plain_counts = chunk.packed_counts == whole_counts(p, tiling);
  if ((chunk.packed_counts > whole_counts(p, tiling) ||
       beyond(std::max(chunk.counts(), chunk.packed_counts), chunk.packed_counts)) ||
      beyond(chunk.unpacked, chunk.packed))
    refuse(container.header, part, window, "the chunk there claims more samples than its bytes can hold");
  if (chunk.unpacked > limits.chunk_bytes || chunk.counts() > limits.chunk_bytes)
    refuse(container.header, part, window,
           "the chunk there claims " + std::to_string(std::max(chunk.unpacked, chunk.counts())) +
               " bytes of samples, beyond the limit of " + std::to_string(limits.chunk_bytes));
  return chunk;
}

/// Decodes chunks of one part. Holds nothing between them.
struct DeepDecoder {
  const Container& container;
  int part;
  const DeepLimits& limits;

  const Part& described() const { return container.header.parts[std::size_t(part)]; }

  // `size` bytes from `packed` bytes at `offset`; bytes that do not shrink are stored as they are.
  std::vector<std::uint8_t> unpack(const DeepChunk& chunk, std::uint64_t offset, std::uint64_t packed,
                                   std::uint64_t size, bool plain) const {
    std::vector<std::uint8_t> bytes(std::size_t(packed), 0);
    container.file.read(offset, bytes.data(), bytes.size(), "deep chunks");
    if (plain) return bytes;
    std::vector<std::uint8_t> joined(std::size_t(size), 0);
    const auto join = [&](std::span<const std::uint8_t> planes) {
      if (planes.size() != joined.size()) refuse(container.header, part, chunk.window, "the chunk there is corrupt");
      join_bytes(planes.data(), planes.data() + planes.size() / 2, joined.data(), planes.size() / 2);
    };
    if (described().compression == Compression::rle) {
      join(unpack_runs(bytes, joined.size()));
    } else if (described().compression == Compression::zips || described().compression == Compression::zip) {
      ZipReader zip;
      join(zip.unpack(bytes, joined.size()));
    } else {
      join({});  // what is not compressed has its full size
    }
    return joined;
  }

  // Samples up to each pixel, line by line: width + 1 entries a line, the first one 0.
  std::vector<std::uint32_t> read_counts(const DeepChunk& chunk) const {
    const std::vector<std::uint8_t> bytes =
        unpack(chunk, chunk.offset, chunk.plain_counts ? chunk.counts() : chunk.packed_counts, chunk.counts(),
               chunk.plain_counts);
    const std::size_t width = std::size_t(chunk.window.width()), lines = std::size_t(chunk.window.height());
    std::vector<std::uint32_t> first(lines * (width + 1));
    std::uint64_t samples = 0;
    for (std::size_t line = 0; line < lines; ++line) {
      std::uint32_t* to = first.data() + line * (width + 1);
      to[0] = 0;
      for (std::size_t x = 0; x < width; ++x) {
        std::int32_t up_to;
        std::memcpy(&up_to, bytes.data() + (line * width + x) * kCountBytes, kCountBytes);
        if (up_to < 0 || std::uint32_t(up_to) < to[x])
          refuse(container.header, part, chunk.window, "its sample counts are corrupt");
        to[x + 1] = std::uint32_t(up_to);
        if (to[x + 1] - to[x] > limits.samples_per_pixel)
          refuse(container.header, part, chunk.window,
                 "it claims " + std::to_string(to[x + 1] - to[x]) + " samples in one pixel, beyond the limit of " +
                     std::to_string(limits.samples_per_pixel));
      }
      samples += to[width];
    }
    if (samples * bytes_per_sample() != chunk.unpacked)
      refuse(container.header, part, chunk.window, "its sample counts do not agree with its samples");
    return first;
  }

  std::uint64_t bytes_per_sample() const {
    std::uint64_t bytes = 0;
    for (const Channel& channel : described().channels) bytes += bytes_per_pixel(channel.type);
    return bytes;
  }

  void decode(const DeepChunk& chunk, int worker, const std::function<void(const DeepLine&, int)>& take) const {
    const std::vector<std::uint32_t> first = read_counts(chunk);
    const std::vector<std::uint8_t> bytes =
        unpack(chunk, chunk.offset + chunk.packed_counts, chunk.packed, chunk.unpacked, chunk.packed == chunk.unpacked);
    const std::byte* at = reinterpret_cast<const std::byte*>(bytes.data());
    const std::size_t entries = std::size_t(chunk.window.width()) + 1;
    DeepLine line;
    line.x0 = chunk.window.x0;
    line.samples = std::vector<const std::byte*>(described().channels.size(), nullptr);
    for (line.y = chunk.window.y0; line.y < chunk.window.y1; ++line.y) {
      line.first = std::span(first).subspan(std::size_t(line.y - chunk.window.y0) * entries, entries);
      for (std::size_t c = 0; c < line.samples.size(); ++c) {
        line.samples[c] = at;
        at += line.count() * bytes_per_pixel(described().channels[c].type);
      }
      take(line, worker);
    }
  }
};

}  // namespace

void read_deep(const FileHeader& header, int part, const DeepLimits& limits, Workers& workers,
               const std::function<void(const DeepLine& line, int worker)>& take) {
  const Container container = reopen(header);
  const Part& described = header.parts[std::size_t(part)];
  if (described.compression > Compression::zip)
    throw Failure(ExitCode::input, part_in_words(header, part) + " is deep and says that it is compressed by " +
                                       name_of(described.compression) +
                                       ", which deep parts cannot be; render or copy it again");
  for (const Channel& channel : described.channels)
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      throw Failure(ExitCode::input, part_in_words(header, part) + " is deep, and its channel '" + channel.name +
                                         "' is subsampled, which deep channels cannot be");
  const std::vector<std::uint64_t> table = read_chunk_table(container, part);
  const std::vector<Window> windows = chunk_windows(described, container.raw[std::size_t(part)].tiling);
  std::vector<DeepChunk> chunks;
  chunks.reserve(windows.size());
  double claimed = 0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    chunks.push_back(read_chunk_head(container, part, windows[i], table[i], limits));
    claimed += double(chunks[i].unpacked) + double(chunks[i].counts());
  }
  // Chunks that overlap would make a small file take any time.
  if (!(claimed <= limits.inflation * double(container.file.size()) + 64 * double(chunks.size())))
    throw Failure(ExitCode::input, part_in_words(header, part) + " claims far more samples than its " +
                                       std::to_string(container.file.size()) + " bytes can hold");
  const DeepDecoder decoder{container, part, limits};
  for (std::size_t begin = 0; begin < chunks.size();) {
    std::size_t end = begin + 1;
    for (std::uint64_t memory = chunks[begin].memory();
         end < chunks.size() && memory + chunks[end].memory() <= limits.band_bytes; ++end)
      memory += chunks[end].memory();
    workers.for_each(end - begin, [&](std::size_t i, int worker) { decoder.decode(chunks[begin + i], worker, take); });
    begin = end;
  }
}

}  // namespace varve
