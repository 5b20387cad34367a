// One channel of a file, untouched: the bytes that were stored, for pass-through and for conversion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/plane.h"

namespace varve {

enum class PixelType { uint32, float16, float32 };

inline std::size_t bytes_per_pixel(PixelType type) { return type == PixelType::float16 ? 2 : 4; }

/// Pixels of one channel in the file's own type, native byte order, rows packed without gaps.
/// A channel sampled every (x_sampling, y_sampling) pixels holds only those pixels; `columns` x `rows`
/// counts what is stored.
struct RawPlane {
  PixelType type = PixelType::float16;
  Window window;  ///< data window of the part
  int x_sampling = 1, y_sampling = 1;
  int columns = 0, rows = 0;
  Plane<std::byte> storage;  ///< window (0, 0)-(columns * bytes, rows)

  bool empty() const { return storage.empty(); }
  /// Row by index 0..rows-1, not by display coordinate.
  std::byte* row(int index) { return storage.row(index); }
  const std::byte* row(int index) const { return storage.row(index); }
};

/// Storage for a channel that is sampled at every pixel.
inline RawPlane make_raw_plane(PixelType type, const Window& window) {
  RawPlane plane{type, window, 1, 1, window.width(), window.height(), {}};
  plane.storage = Plane<std::byte>(Window{0, 0, int(plane.columns * int(bytes_per_pixel(type))), plane.rows});
  return plane;
}

}  // namespace varve
