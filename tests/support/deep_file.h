// Deep EXR files for the tests, written by the stock OpenEXR C++ API.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>

#include <Imath/half.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace varve::test {

/// A channel of a deep picture: values[pixel][sample], pixels in reading order of the data window.
struct DeepTestChannel {
  std::string name;
  Imf::PixelType type = Imf::HALF;
  std::vector<std::vector<double>> values;
};

/// All channels must hold the same number of samples in a pixel.
struct DeepTestPart {
  std::string name;
  Imath::Box2i display, data;
  Imf::Compression compression = Imf::ZIPS_COMPRESSION;
  int tile = 0;       ///< edge of its tiles; 0: scan lines
  bool flat = false;  ///< a flat part of scan lines: every pixel has one sample
  std::vector<DeepTestChannel> channels;

  int width() const { return data.max.x - data.min.x + 1; }
  std::size_t pixels() const { return std::size_t(width()) * std::size_t(data.max.y - data.min.y + 1); }
};

/// A part of one size for both windows, with no samples yet.
inline DeepTestPart deep_part(int width, int height,
                              const std::vector<std::pair<std::string, Imf::PixelType>>& channels) {
  DeepTestPart part;
  part.display = part.data = Imath::Box2i({0, 0}, {width - 1, height - 1});
  for (const auto& [name, type] : channels)
    part.channels.push_back({name, type, std::vector<std::vector<double>>(part.pixels())});
  return part;
}

/// One more sample of a pixel, values in the order of the channels.
inline void add_sample(DeepTestPart& part, std::size_t pixel, const std::vector<double>& values) {
  for (std::size_t c = 0; c < part.channels.size(); ++c) part.channels[c].values[pixel].push_back(values[c]);
}

/// Bytes of all samples of a channel, and where each pixel's begin.
struct PackedChannel {
  std::vector<char> bytes;
  std::vector<char*> pointers;
};

inline PackedChannel pack(const DeepTestChannel& channel) {
  const std::size_t size = channel.type == Imf::HALF ? 2 : 4;
  PackedChannel packed;
  std::size_t samples = 0;
  for (const auto& pixel : channel.values) samples += pixel.size();
  packed.bytes.resize(samples * size + 1);
  char* at = packed.bytes.data();
  for (const auto& pixel : channel.values) {
    packed.pointers.push_back(at);
    for (const double value : pixel) {
      const half h = half(float(value));
      const float f = float(value);
      const unsigned u = channel.type == Imf::UINT ? unsigned(value) : 0;
      std::memcpy(at,
                  channel.type == Imf::HALF    ? static_cast<const void*>(&h)
                  : channel.type == Imf::FLOAT ? static_cast<const void*>(&f)
                                               : &u,
                  size);
      at += size;
    }
  }
  return packed;
}

/// One sample of each pixel, as a flat part.
inline void write_flat(Imf::MultiPartOutputFile& file, int number, const DeepTestPart& part) {
  const std::ptrdiff_t origin = part.data.min.x + std::ptrdiff_t(part.data.min.y) * part.width();
  std::vector<PackedChannel> packed;
  for (const DeepTestChannel& channel : part.channels) packed.push_back(pack(channel));
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < packed.size(); ++c) {
    const std::ptrdiff_t size = part.channels[c].type == Imf::HALF ? 2 : 4;
    frame.insert(part.channels[c].name, Imf::Slice(part.channels[c].type, packed[c].bytes.data() - origin * size,
                                                   std::size_t(size), std::size_t(size * part.width())));
  }
  Imf::OutputPart out(file, number);
  out.setFrameBuffer(frame);
  out.writePixels(part.data.max.y - part.data.min.y + 1);
}

/// Writes the parts into one file.
inline void write_deep(const std::string& path, const std::vector<DeepTestPart>& parts) {
  std::vector<Imf::Header> headers;
  for (const DeepTestPart& part : parts) {
    Imf::Header header(part.display, part.data);
    header.compression() = part.compression;
    header.setType(part.flat ? Imf::SCANLINEIMAGE : part.tile > 0 ? Imf::DEEPTILE : Imf::DEEPSCANLINE);
    header.setName(part.name.empty() ? "deep" : part.name);
    if (part.tile > 0)
      header.setTileDescription(Imf::TileDescription(unsigned(part.tile), unsigned(part.tile), Imf::ONE_LEVEL));
    for (const DeepTestChannel& channel : part.channels)
      header.channels().insert(channel.name, Imf::Channel(channel.type));
    headers.push_back(header);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const DeepTestPart& part = parts[p];
    if (part.flat) {
      write_flat(file, int(p), part);
      continue;
    }
    std::vector<unsigned> counts;
    for (const auto& pixel : part.channels.front().values) counts.push_back(unsigned(pixel.size()));
    const std::ptrdiff_t origin = part.data.min.x + std::ptrdiff_t(part.data.min.y) * part.width();
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data() - origin),
                                            sizeof(unsigned), sizeof(unsigned) * std::size_t(part.width())));
    std::vector<PackedChannel> packed;
    for (const DeepTestChannel& channel : part.channels) packed.push_back(pack(channel));
    for (std::size_t c = 0; c < packed.size(); ++c)
      frame.insert(part.channels[c].name,
                   Imf::DeepSlice(part.channels[c].type, reinterpret_cast<char*>(packed[c].pointers.data() - origin),
                                  sizeof(char*), sizeof(char*) * std::size_t(part.width()),
                                  part.channels[c].type == Imf::HALF ? 2 : 4));
    if (part.tile > 0) {
      Imf::DeepTiledOutputPart out(file, int(p));
      out.setFrameBuffer(frame);
      out.writeTiles(0, out.numXTiles(0) - 1, 0, out.numYTiles(0) - 1, 0, 0);
    } else {
      Imf::DeepScanLineOutputPart out(file, int(p));
      out.setFrameBuffer(frame);
      out.writePixels(part.data.max.y - part.data.min.y + 1);
    }
  }
}

}  // namespace varve::test
