// Frames of a shot that is known in closed form, as files, and what came of them read back; by the OpenEXR library
// only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <glm/vec2.hpp>

#include "base/plane.h"
#include "support/gather_scenes.h"

namespace varve::test {

/// One frame as it is stored: one part, uncompressed, every plane over `data`.
struct FrameFile {
  Window data, display;
  std::map<std::string, Plane<float>> channels;
  std::set<std::string> half;  ///< names of those that are stored as half
  std::map<std::string, Plane<std::uint32_t>> ids;
  std::optional<glm::dvec2> jitter;  ///< attribute `jitter`
};

void write_frame_file(const std::filesystem::path& path, const FrameFile& frame);

/// Every channel as float. Throws what the library throws when the file is not whole.
struct ReadFile {
  Window data;
  std::map<std::string, Plane<float>> channels;
  const Plane<float>& operator[](const std::string& name) const { return channels.at(name); }
};
ReadFile read_frame_file(const std::filesystem::path& path);

/// What of a world is stored, and how.
struct FileOptions {
  Window data{0, 0, 33, 21};
  std::optional<Window> display = {};  ///< the data window where it is not given
  bool half = false;                   ///< color and alpha; the rest is float and uint
  bool jitter = true, depth = true, ids = true, vectors = true, forward = true;
  int jitter_period = 16;
};

/// R G B A, Z, velocity, forward and id of a frame, sampled at its jitter (Halton 2, 3), by this program's convention.
FrameFile frame_of(const World& world, int frame, const FileOptions& options);

/// in.####.exr in `folder` for first..last.
void write_shot(const std::filesystem::path& folder, const World& world, int first, int last,
                const FileOptions& options);

/// "0007".
std::string frame_number(int frame);

/// 0..1 from three numbers, the same everywhere.
double chance(std::uint32_t x, std::uint32_t y, std::uint32_t frame, std::uint32_t salt = 0);

}  // namespace varve::test
