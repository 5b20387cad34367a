// The OpenEXR file layout: headers, chunk tables, chunks, as bytes.
// Read here and not through the library for three reasons: every claim is checked before anything is allocated for
// it; attributes of any type, known or not, can be written again as the very bytes they were; and chunks of any
// part (deep and tiled included) can be copied without being decoded. Layout after the OpenEXR file layout document.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exr/file_header.h"
#include "exr/input_bytes.h"

namespace varve {

/// One attribute as stored.
struct RawAttribute {
  std::string name, type, value;
};

/// Tiles of a tiled part, as in the attribute `tiles`.
struct Tiling {
  enum class Levels { one, mipmap, ripmap };
  std::uint32_t width = 0, height = 0;
  Levels levels = Levels::one;
  bool round_up = false;
};

/// What the header of one part says, and where its chunk table lies.
struct RawPart {
  std::vector<RawAttribute> attributes;  ///< in file order, names unique
  Tiling tiling;                         ///< tiled parts only
  std::uint64_t chunks = 0;
  std::uint64_t table_offset = 0;  ///< of `chunks` 64-bit file offsets

  const RawAttribute* find(std::string_view name) const;
  /// Replaces the attribute of that name in its place, or appends it.
  void set(const std::string& name, const std::string& type, std::string value);
  void remove(std::string_view name);
};

/// An open file whose headers have been read and checked.
struct Container {
  InputBytes file;
  bool multi_part = false;
  FileHeader header;
  std::vector<RawPart> raw;       ///< beside header.parts
  std::uint64_t data_offset = 0;  ///< first byte behind the chunk tables
};

/// Reads and checks the headers. Throws Failure(input) like read_header.
Container open_container(InputBytes file, const ReadLimits& limits);
/// For a file whose header has been accepted before: whatever it claims is taken, nothing is allocated for it.
Container open_container(InputBytes file);

/// File offsets of the chunks of a part. Throws Failure(input) when one lies outside the file or was never written.
std::vector<std::uint64_t> read_chunk_table(const Container& container, int part);

/// Rows of a chunk: 1, 16, 32 or 256 by compression.
int lines_per_chunk(Compression compression);
/// Chunks a part must have; saturates far above any file's size.
std::uint64_t chunk_count(const Part& part, const Tiling& tiling);
/// Samples that a subsampled axis stores in `low` <= i < `high`.
int samples_in(int low, int high, int sampling);
/// Bytes of row y of a channel in the file; 0 when the channel skips that row.
std::size_t row_bytes(const Channel& channel, const Window& window, int y);

/// "'path'" or "part 'fg' of 'path'", for sentences.
std::string part_in_words(const FileHeader& header, int part);

}  // namespace varve
