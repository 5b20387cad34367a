// A small valid sequence as Cycles writes it, made with the OpenEXR C++ API only.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace varve::test {

struct SmallSequence {
  int frames = 8, width = 64, height = 48;  ///< frames 1..n
  bool with_vectors = true, with_depth = true, with_ids = true;
};

/// Writes `folder`/in.0001.exr and so on: ViewLayer.Combined RGBA (half), ViewLayer.Depth.Z and ViewLayer.Vector.XYZW
/// (float), `id.X` (uint), and Cycles' Note with the jitter. A bright square moves one pixel to the right with each
/// frame.
void write_small_sequence(const std::filesystem::path& folder, const SmallSequence& sequence = {});

/// One frame of it, under any name.
void write_small_frame(const std::filesystem::path& path, int frame, const SmallSequence& sequence = {});

/// One channel of a file without parts, row after row, as float.
struct ChannelValues {
  int x0 = 0, y0 = 0, width = 0, height = 0;  ///< data window
  std::vector<float> values;
  float at(int x, int y) const { return values[std::size_t(y - y0) * std::size_t(width) + std::size_t(x - x0)]; }
};
ChannelValues channel_of(const std::filesystem::path& path, const std::string& channel);

/// One pixel of one channel of a file.
float pixel_of(const std::filesystem::path& path, const std::string& channel, int x, int y);

/// Whether the OpenEXR library reads the whole file.
bool is_complete(const std::filesystem::path& path);

}  // namespace varve::test
