#include "exr/file_print.h"

#include <libdeflate.h>
#include <sys/stat.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "base/error.h"
#include "exr/container.h"
#include "exr/header_bytes.h"

namespace varve {
namespace {

constexpr std::size_t kBlock = 1 << 20;

/// CRC-32 of a piece of the file; what lies behind its end is left out.
std::uint32_t crc_of(const InputBytes& file, std::uint64_t begin, std::uint64_t end, std::vector<char>& block) {
  std::uint32_t crc = libdeflate_crc32(0, nullptr, 0);
  block.resize(kBlock);
  while (begin < end) {
    const std::size_t count =
        file.read_some(begin, block.data(), std::size_t(std::min<std::uint64_t>(kBlock, end - begin)));
    if (count == 0) break;
    crc = libdeflate_crc32(crc, block.data(), count);
    begin += count;
  }
  return crc;
}

/// Bytes of a pixel in all channels; 0 where channels are subsampled.
std::uint64_t pixel_bytes(const Part& part) {
  std::uint64_t bytes = 0;
  for (const Channel& channel : part.channels) {
    if (channel.x_sampling != 1 || channel.y_sampling != 1) return 0;
    bytes += bytes_per_pixel(channel.type);
  }
  return bytes;
}

/// How the chunks of a part are put together, as far as their ends tell of their contents.
struct ChunkForm {
  bool by_zlib = false;
  std::uint64_t head = 0;   ///< bytes before the packed ones; the last four of them hold how many these are
  std::uint64_t pixel = 0;  ///< pixel_bytes()
};

ChunkForm form_of(const Container& container, const Part& part) {
  const Compression c = part.compression;
  ChunkForm form;
  form.pixel = pixel_bytes(part);
  form.by_zlib =
      !is_deep(part) && form.pixel > 0 && (c == Compression::zip || c == Compression::zips || c == Compression::pxr24);
  form.head = std::uint64_t(container.multi_part ? 4 : 0) + (part.storage == Storage::tiled ? 16 : 4) + 4;
  return form;
}

/// Size and Adler-32 of what zlib packed. None where a chunk was left as it is because packing made it no smaller: its
/// size then is a whole number of pixels.
std::optional<std::uint64_t> zlib_sum(const InputBytes& file, std::uint64_t at, const ChunkForm& form) {
  char bytes[4];
  if (!form.by_zlib || file.read_some(at + form.head - 4, bytes, 4) != 4) return std::nullopt;
  const std::uint64_t size = load<std::uint32_t>(bytes), end = at + form.head + size;
  if (size < 8 || size % form.pixel == 0 || end > file.size()) return std::nullopt;
  if (file.read_some(end - 4, bytes, 4) != 4) return std::nullopt;
  return size << 32 | load<std::uint32_t>(bytes);
}

/// The offsets of a part; none where its table is damaged, which shows when the part is read.
std::vector<std::uint64_t> offsets_of(const Container& container, int part) {
  try {
    return read_chunk_table(container, part);
  } catch (const Failure&) {
    return {};
  }
}

}  // namespace

FileIdentity identity_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {std::uint64_t(status.st_dev),        std::uint64_t(status.st_ino),         std::uint64_t(status.st_size),
          std::int64_t(status.st_mtim.tv_sec), std::int64_t(status.st_mtim.tv_nsec), true};
}

std::uint64_t file_print(const std::string& path) {
  const Container container = open_container(InputBytes(path), {});
  const InputBytes& file = container.file;
  std::vector<std::vector<std::uint64_t>> offsets;
  std::vector<std::uint64_t> begins = {file.size()};
  for (std::size_t part = 0; part < container.raw.size(); ++part) {
    offsets.push_back(offsets_of(container, int(part)));
    begins.insert(begins.end(), offsets.back().begin(), offsets.back().end());
  }
  std::sort(begins.begin(), begins.end());

  std::vector<char> block;
  std::uint64_t print = add_to_print(kEmptyPrint, file.size());
  print = add_to_print(print, crc_of(file, 0, container.data_offset, block));
  for (std::size_t part = 0; part < offsets.size(); ++part) {
    const ChunkForm form = form_of(container, container.header.parts[part]);
    for (const std::uint64_t at : offsets[part]) {
      const std::optional<std::uint64_t> sum = zlib_sum(file, at, form);
      // Every byte up to the next chunk, whatever it is.
      const std::uint64_t end = *std::upper_bound(begins.begin(), begins.end() - 1, at);
      print = add_to_print(print, sum ? *sum : crc_of(file, at, end, block));
    }
  }
  return print;
}

}  // namespace varve
