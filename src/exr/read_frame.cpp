#include "exr/read_frame.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "exr/chunk_bytes.h"
#include "exr/container.h"
#include "exr/library_part.h"
#include "exr/scanline_chunks.h"
#include "exr/zip_chunk.h"

namespace varve {
namespace {

bool is_plain_scanline(const Part& part) {
  const Compression c = part.compression;
  return part.storage == Storage::scanline &&
         (c == Compression::none || c == Compression::zip || c == Compression::zips);
}

// Scratch of one worker: nothing is allocated per chunk.
struct Scratch {
  std::vector<std::uint8_t> bytes;
  ZipReader zip;
};

std::string where(const FileHeader& header, int part, const ScanlineChunk& chunk) {
  return part_in_words(header, part) + " is damaged at scan line " + std::to_string(chunk.y0);
}

// Bytes as stored: raw chunks hold rows one after the other.
void copy_rows(const std::vector<ChunkRow>& rows, const std::uint8_t* bytes, std::vector<RawPlane>& planes) {
  for (const ChunkRow& row : rows) {
    RawPlane& plane = planes[std::size_t(row.channel)];
    if (!plane.empty()) std::memcpy(plane.row(row.row), bytes + row.offset, row.bytes);
  }
}

// ZIP chunks hold the even bytes of all rows first, then the odd ones. Rows begin and end on even offsets.
void join_rows(const std::vector<ChunkRow>& rows, std::span<const std::uint8_t> bytes, std::vector<RawPlane>& planes) {
  const std::uint8_t* even = bytes.data();
  const std::uint8_t* odd = even + bytes.size() / 2;
  for (const ChunkRow& row : rows) {
    RawPlane& plane = planes[std::size_t(row.channel)];
    if (!plane.empty())
      join_bytes(even + row.offset / 2, odd + row.offset / 2, reinterpret_cast<std::uint8_t*>(plane.row(row.row)),
                 row.bytes / 2);
  }
}

void read_plain_scanlines(const Container& container, int part, const std::vector<std::uint64_t>& table,
                          std::vector<RawPlane>& planes, Workers& workers) {
  const Part& wanted = container.header.parts[std::size_t(part)];
  std::vector<Scratch> scratch(std::size_t(workers.count()));
  workers.for_each(table.size(), [&](std::size_t i, int worker) {
    Scratch& mine = scratch[std::size_t(worker)];
    const ScanlineChunk chunk = scanline_chunk(wanted, i);
    if (chunk.bytes == 0) return;  // a line that every channel skips
    const StoredChunk stored = read_scanline_chunk(container, part, table, i, chunk.bytes, mine.bytes);
    if (stored.y != chunk.y0)
      throw Failure(ExitCode::input, where(container.header, part, chunk) + ": its chunks are mixed up");
    const std::vector<ChunkRow> rows = chunk_rows(wanted, chunk);
    if (stored.packed.size() == chunk.bytes) return copy_rows(rows, stored.packed.data(), planes);
    std::span<const std::uint8_t> bytes;
    if (wanted.compression != Compression::none) bytes = mine.zip.unpack(stored.packed, chunk.bytes);
    if (bytes.empty())
      throw Failure(ExitCode::input,
                    where(container.header, part, chunk) + ": the chunk there is corrupt; render or copy it again");
    join_rows(rows, bytes, planes);
  });
}

bool same_layout(const Part& a, const Part& b) {
  const auto same_channel = [](const Channel& x, const Channel& y) {
    return x.name == y.name && x.type == y.type && x.x_sampling == y.x_sampling && x.y_sampling == y.y_sampling;
  };
  return a.storage == b.storage && a.compression == b.compression && a.data_window == b.data_window &&
         std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(), same_channel);
}

}  // namespace

Container reopen(const FileHeader& header) {
  Container container = open_container(InputBytes(header.path));
  const auto& now = container.header.parts;
  if (!std::equal(now.begin(), now.end(), header.parts.begin(), header.parts.end(), same_layout))
    throw Failure(ExitCode::inconsistent,
                  "'" + header.path + "' changed while it was being used; start again when it is complete");
  return container;
}

FramePixels read_channels(const FileHeader& header, std::span<const ChannelRef> channels, Workers& workers) {
  const Container container = reopen(header);
  FramePixels frame;
  frame.planes.resize(header.parts.size());
  for (std::size_t p = 0; p < header.parts.size(); ++p) frame.planes[p].resize(header.parts[p].channels.size());
  std::vector<char> touched(header.parts.size(), 0);
  for (const ChannelRef& ref : channels) {
    const Part& part = header.parts.at(std::size_t(ref.part));
    const Channel& channel = part.channels.at(std::size_t(ref.channel));
    if (is_deep(part))
      throw Failure(ExitCode::inconsistent, "channel '" + channel.name + "' of " + part_in_words(header, ref.part) +
                                                " is deep and has no flat pixels; choose a flat part");
    RawPlane& plane = frame.planes[std::size_t(ref.part)][std::size_t(ref.channel)];
    if (plane.empty()) plane = make_channel_plane(part, channel);
    touched[std::size_t(ref.part)] = 1;
  }
  for (std::size_t p = 0; p < header.parts.size(); ++p) {
    if (!touched[p]) continue;
    // The table comes first on both ways: it tells an incomplete file, which the library would take time to search.
    const std::vector<std::uint64_t> table = read_chunk_table(container, int(p));
    if (is_plain_scanline(header.parts[p]))
      read_plain_scanlines(container, int(p), table, frame.planes[p], workers);
    else
      read_part_by_library(header, int(p), frame.planes[p], workers.count());
  }
  return frame;
}

}  // namespace varve
