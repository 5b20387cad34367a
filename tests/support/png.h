// Reads back the 8-bit RGB PNG files that varve writes, with nothing of OpenImageIO.
#pragma once

#include <libdeflate.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace varve::test {

struct Png {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<std::string> chunks;  ///< names, in file order
  const std::uint8_t* pixel(int x, int y) const {
    return &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
  }
};

inline std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::uint8_t(bytes.at(at + i));
  return value;
}

inline int paeth(int a, int b, int c) {
  const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

inline void unfilter(const std::vector<std::uint8_t>& lines, Png& png) {
  const std::size_t row = 3 * std::size_t(png.width);
  png.rgb.assign(row * std::size_t(png.height), 0);
  for (std::size_t y = 0; y < std::size_t(png.height); ++y)
    for (std::size_t i = 0; i < row; ++i) {
      const int left = i >= 3 ? png.rgb[y * row + i - 3] : 0, up = y ? png.rgb[(y - 1) * row + i] : 0;
      const int corner = y && i >= 3 ? png.rgb[(y - 1) * row + i - 3] : 0;
      const int predicted[] = {0, left, up, (left + up) / 2, paeth(left, up, corner)};
      png.rgb[y * row + i] = std::uint8_t(lines[y * (row + 1) + 1 + i] + predicted[lines[y * (row + 1)]]);
    }
}

inline Png read_png(const std::string& path) {
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
  if (bytes.substr(1, 3) != "PNG") throw std::runtime_error(path + " is no PNG");
  Png png;
  std::string packed;
  for (std::size_t at = 8; at + 12 <= bytes.size(); at += 12 + big_endian(bytes, at)) {
    png.chunks.push_back(bytes.substr(at + 4, 4));
    if (png.chunks.back() == "IHDR") {
      png.width = int(big_endian(bytes, at + 8));
      png.height = int(big_endian(bytes, at + 12));
      if (bytes.at(at + 16) != 8 || bytes.at(at + 17) != 2) throw std::runtime_error(path + " is not 8-bit RGB");
    }
    if (png.chunks.back() == "IDAT") packed += bytes.substr(at + 8, big_endian(bytes, at));
  }
  std::vector<std::uint8_t> lines((3 * std::size_t(png.width) + 1) * std::size_t(png.height));
  libdeflate_decompressor* inflater = libdeflate_alloc_decompressor();
  const auto result =
      libdeflate_zlib_decompress(inflater, packed.data(), packed.size(), lines.data(), lines.size(), nullptr);
  libdeflate_free_decompressor(inflater);
  if (result != LIBDEFLATE_SUCCESS) throw std::runtime_error(path + " does not inflate");
  unfilter(lines, png);
  return png;
}

}  // namespace varve::test
