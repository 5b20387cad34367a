// A small valid sequence as Cycles writes it, made with the OpenEXR C++ API only.
#pragma once

#include <filesystem>
#include <string>

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

/// One pixel of one channel of a file.
float pixel_of(const std::filesystem::path& path, const std::string& channel, int x, int y);

/// Whether the OpenEXR library reads the whole file.
bool is_complete(const std::filesystem::path& path);

}  // namespace varve::test
