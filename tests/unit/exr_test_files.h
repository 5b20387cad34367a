// EXR files for the tests, written and read by the stock OpenEXR C++ API: the truth our own reading and writing is held
// against.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "exr/read_frame.h"

namespace varve::test {

/// A folder that goes when the test does.
struct Folder {
  std::filesystem::path path;
  Folder() {
    static int count = 0;
    path = std::filesystem::temp_directory_path() /
           ("varve-exr-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

inline std::string slurp(const std::string& path) {
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
  return bytes;
}

inline void spill(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes.data(), std::streamsize(bytes.size()));
}

struct Pixels {
  int columns = 0, rows = 0, size = 0;  // size: bytes per pixel
  int xs = 1, ys = 1;
  std::string bytes;  // rows without gaps
  bool operator==(const Pixels&) const = default;
};

/// Pixels of each channel of one part.
using PartPixels = std::map<std::string, Pixels>;

inline int samples(int low, int high, int s) {  // inclusive ends, by counting
  int n = 0;
  for (int i = low; i <= high; ++i) n += i % s == 0;
  return n;
}

inline Imf::Slice slice(Pixels& p, Imf::PixelType type, const Imath::Box2i& window) {
  const long row = long(p.columns) * p.size;
  char* base = p.bytes.data() - long(window.min.x / p.xs) * p.size - long(window.min.y / p.ys) * row;
  return Imf::Slice(type, base, std::size_t(p.size), std::size_t(row), p.xs, p.ys);
}

/// Blank pixels for every channel of a header, and the frame buffer over them.
inline Imf::FrameBuffer frame_for(const Imf::Header& header, PartPixels& pixels) {
  const Imath::Box2i window = header.dataWindow();
  Imf::FrameBuffer frame;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    Pixels& p = pixels[c.name()];
    p.size = c.channel().type == Imf::HALF ? 2 : 4;
    p.xs = c.channel().xSampling;
    p.ys = c.channel().ySampling;
    p.columns = samples(window.min.x, window.max.x, p.xs);
    p.rows = samples(window.min.y, window.max.y, p.ys);
    p.bytes.resize(std::size_t(p.columns) * std::size_t(p.rows) * std::size_t(p.size));
    frame.insert(c.name(), slice(p, c.channel().type, window));
  }
  return frame;
}

/// Arbitrary bits (NaN payloads, denormals, infinities) in `noisy` files, a ramp with some noise otherwise.
inline void fill(PartPixels& pixels, unsigned seed, bool noisy) {
  std::mt19937 random(seed);
  for (auto& [name, p] : pixels)
    for (std::size_t i = 0; i < p.bytes.size(); ++i)
      p.bytes[i] = char(noisy || i % 7 == 0 ? random() : (i / std::size_t(p.size)) / 5);
}

/// Writes one file with the stock API; a header with tiles gives a tiled part. Returns what was written.
inline std::vector<PartPixels> write_stock(const std::string& path, std::vector<Imf::Header> headers, unsigned seed = 1,
                                           bool noisy = true) {
  for (std::size_t i = 0; i < headers.size(); ++i) {
    headers[i].setType(headers[i].hasTileDescription() ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    if (headers.size() > 1 && !headers[i].hasName()) headers[i].setName("part" + std::to_string(i));
  }
  std::vector<PartPixels> written(headers.size());
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
  for (std::size_t i = 0; i < headers.size(); ++i) {
    Imf::FrameBuffer frame = frame_for(headers[i], written[i]);
    fill(written[i], seed + unsigned(i), noisy);
    if (headers[i].hasTileDescription()) {
      Imf::TiledOutputPart part(file, int(i));
      for (int ly = 0; ly < part.numYLevels(); ++ly)
        for (int lx = 0; lx < part.numXLevels(); ++lx) {
          if (!part.isValidLevel(lx, ly)) continue;
          part.setFrameBuffer(frame);  // smaller levels take the corner of the picture
          part.writeTiles(0, part.numXTiles(lx) - 1, 0, part.numYTiles(ly) - 1, lx, ly);
        }
    } else {
      Imf::OutputPart part(file, int(i));
      part.setFrameBuffer(frame);
      part.writePixels(headers[i].dataWindow().max.y - headers[i].dataWindow().min.y + 1);
    }
  }
  return written;
}

/// Reads all flat parts with the stock API; deep parts stay empty.
inline std::vector<PartPixels> read_stock(const std::string& path) {
  Imf::MultiPartInputFile file(path.c_str());
  std::vector<PartPixels> parts(std::size_t(file.parts()));
  for (int i = 0; i < file.parts(); ++i) {
    const Imf::Header& header = file.header(i);
    if (header.hasType() && Imf::isDeepData(header.type())) continue;
    Imf::InputPart part(file, i);
    part.setFrameBuffer(frame_for(header, parts[std::size_t(i)]));
    part.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
  }
  return parts;
}

inline std::vector<ChannelRef> all_flat_channels(const FileHeader& header) {
  std::vector<ChannelRef> refs;
  for (std::size_t p = 0; p < header.parts.size(); ++p)
    for (std::size_t c = 0; !is_deep(header.parts[p]) && c < header.parts[p].channels.size(); ++c)
      refs.push_back({0, int(p), int(c)});
  return refs;
}

/// Bytes of a plane, rows without gaps.
inline std::string packed(const RawPlane& plane) {
  std::string bytes;
  for (int y = 0; y < plane.rows; ++y)
    bytes.append(reinterpret_cast<const char*>(plane.row(y)), std::size_t(plane.columns) * bytes_per_pixel(plane.type));
  return bytes;
}

/// Our planes hold bit for bit what `truth` says, for every channel that was read.
inline void expect_equal(const FileHeader& header, const FramePixels& ours, const std::vector<PartPixels>& truth,
                         const std::string& what) {
  ASSERT_EQ(header.parts.size(), truth.size()) << what;
  for (std::size_t p = 0; p < truth.size(); ++p)
    for (const auto& [name, pixels] : truth[p]) {
      const auto c = header.parts[p].channel(name);
      ASSERT_TRUE(c) << what << " lacks " << name;
      const RawPlane& plane = ours.planes[p][std::size_t(*c)];
      ASSERT_FALSE(plane.empty()) << what << " " << name;
      EXPECT_EQ(plane.columns, pixels.columns);
      EXPECT_EQ(plane.rows, pixels.rows);
      EXPECT_TRUE(packed(plane) == pixels.bytes) << what << ": channel " << name << " of part " << p << " differs";
    }
}

/// The failure that `call` ends with, checked to be a sentence fit to be shown.
template <class Call>
Failure failure_of(Call call) {
  try {
    call();
  } catch (const Failure& failure) {
    EXPECT_EQ(std::string(failure.what()).find("rror"), std::string::npos) << failure.what();
    return failure;
  }
  ADD_FAILURE() << "nothing was refused";
  return Failure(ExitCode::done, "");
}

}  // namespace varve::test
