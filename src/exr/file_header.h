// What an EXR file says of itself: parts, windows, channels, attributes. No pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/raw_plane.h"
#include "base/window.h"

namespace varve {

enum class Compression { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab };
enum class Storage { scanline, tiled, deep_scanline, deep_tiled };

struct Channel {
  std::string name;  ///< full name as stored, spaces included
  PixelType type = PixelType::float16;
  int x_sampling = 1, y_sampling = 1;
  bool perceptually_linear = false;
};

struct Attribute {
  std::string name, type;
  std::string text;             ///< the value as text; empty for types that have none
  std::vector<double> numbers;  ///< int, float, double, v2*, v3*, box2* (ends inclusive, as stored), m33*, m44*,
                                ///< rational, chromaticities, floatvector, keycode, timecode; matrices row major
};

struct Part {
  std::string name;  ///< empty in a single-part file without a name
  std::string view;  ///< `view` attribute; empty when there is none
  Storage storage = Storage::scanline;
  Compression compression = Compression::zip;
  Window data_window, display_window;
  std::vector<Channel> channels;
  std::vector<Attribute> attributes;

  const Attribute* attribute(std::string_view attribute_name) const;
  std::optional<int> channel(std::string_view channel_name) const;  ///< index by full name
};

struct FileHeader {
  std::string path;
  std::vector<Part> parts;
  std::vector<std::string> multi_view;  ///< `multiView` of the first part that has one, default view first
  std::uint64_t file_bytes = 0;
};

/// One channel of one part, by index. `file` counts the files of a frame: 0 holds the color, role files follow.
struct ChannelRef {
  int file = 0, part = 0, channel = 0;
  bool operator==(const ChannelRef&) const = default;
};

/// Limits checked before anything is allocated: a header that claims more is refused (decompression bombs).
struct ReadLimits {
  std::uint64_t pixels_per_part = std::uint64_t(1) << 29;  ///< 536 M pixels
  int edge = 1 << 20;                                      ///< longest side of a window, and largest coordinate
  std::uint64_t tile_pixels = std::uint64_t(1) << 26;
  int parts = 4096, channels = 16384;
  double inflation = 2048;  ///< claimed pixel bytes of the channels to the file's size
};

/// Reads the headers of one file. Throws Failure(input) with the path and the reason: missing, not EXR, truncated
/// header, or beyond the limits.
FileHeader read_header(const std::string& path, const ReadLimits& limits = {});

/// True for a readable file whose chunk tables are complete and point into the file: nothing was cut off.
bool has_every_chunk(const std::string& path);

const char* name_of(Compression compression);
const char* name_of(Storage storage);
const char* name_of(PixelType type);
bool is_lossy(Compression compression);
bool is_deep(const Part& part);

}  // namespace varve
