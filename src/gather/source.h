// One sample per pixel of one frame as the gather sees it.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "gather/surface_blocks.h"
#include "resolve/present.h"

namespace varve {

/// Luminance of a pixel, and the least and greatest of its 3x3 neighbors; own is NaN where several surfaces meet.
struct LightRange {
  float own, low, high;
};

/// A frame of the window, or one of its samples where every pixel has several: they lie side by side, those of a frame
/// together, each with vectors and light of its own. `backward` and `forward` are undilated; either is NaN where
/// nothing is known. All planes have the window of present->color; a frame that lacks a sample that others have gives a
/// present without pixels.
struct GatherSource {
  const Present* present = nullptr;
  std::size_t sample = 0;  ///< counts within the frame; every frame has as many
  bool whole = true;       ///< false: only some pixels have this sample, those that are valid, and nothing is followed
                           ///< through the others; the first sample of a frame is whole
  glm::dvec2 jitter{0};    ///< sample position minus pixel centre, pixels
  bool repeats = false;    ///< its samples are those of another frame: they count once, there
  const Plane<glm::vec2>* backward = nullptr;      ///< to the frame before; null: at rest
  const Plane<glm::vec2>* forward = nullptr;       ///< to the frame after; null: at rest
  const Plane<LightRange>* light_range = nullptr;  ///< local_range(); null: no test of it
  const Plane<float>* local_light = nullptr;       ///< mean luminance around each pixel on its surface; null: no gain

  const Window& window() const { return present->color.window(); }
  const SurfaceBlocks* blocks = nullptr;  ///< null: searches look everywhere
  /// Position of the sample of pixel (x, y).
  glm::dvec2 position(int x, int y) const { return {x + 0.5 + jitter.x, y + 0.5 + jitter.y}; }
  /// Color and companion of a pixel given as y * 65536 + x from the window's corner.
  const glm::vec4& color(std::uint32_t pixel) const { return packed(present->color, pixel); }
  const glm::vec4& companion(std::size_t k, std::uint32_t pixel) const { return packed(present->companions[k], pixel); }

 private:
  static const glm::vec4& packed(const Plane<glm::vec4>& plane, std::uint32_t pixel) {
    return plane.row(plane.window().y0 + int(pixel >> 16))[pixel & 0xFFFF];
  }
};

/// Whether the way of a pixel's sample is of use.
inline bool is_followed(const GatherSource& s, int x, int y) { return s.whole || s.present->valid.at(x, y) > 0; }

/// Samples in each pixel of a window of frames.
inline std::size_t samples_of(std::span<const GatherSource> sources) {
  return sources.empty() ? 1 : sources.back().sample + 1;
}

/// What a sample shows, as far as the files tell: an object and a distance.
struct SurfaceKey {
  std::uint32_t id = 0;  ///< 0 where the files have no ids
  float depth = 0;       ///< 0 where the files have no depth
};

/// The relative difference of depth up to which two samples may be the same surface. With ids it only has to split an
/// object from its own far side; without, it has to split everything.
struct SurfaceTest {
  bool ids = false, depths = false;
  float tolerance = 0.15f;

  bool same(SurfaceKey a, SurfaceKey b) const { return (!ids || a.id == b.id) && (!depths || near(a.depth, b.depth)); }
  /// False where a block has no sample that could be the same.
  bool may_be_in(SurfaceKey key, const SurfaceBlock& b) const {
    return (!ids || (b.ids & id_bit(key.id)) != 0) && (!depths || near(key.depth, b.near) || near(key.depth, b.far) ||
                                                       (key.depth >= b.near && key.depth <= b.far));
  }
  bool near(float a, float b) const {
    if (a == b) return true;  // both infinitely far as well
    const float nearer = a < b ? a : b;
    return std::fabs(a - b) <= tolerance * nearer;
  }
};

inline SurfaceKey surface_at(const Present& p, int x, int y) {
  return {p.id.empty() ? 0u : p.id.at(x, y), p.depth.empty() ? 0.0f : p.depth.at(x, y)};
}

/// The same along a row.
class SurfaceRow {
 public:
  SurfaceRow(const Present& p, int y)
      : id_(p.id.empty() ? nullptr : p.id.row(y) - p.id.window().x0),
        depth_(p.depth.empty() ? nullptr : p.depth.row(y) - p.depth.window().x0) {}
  SurfaceKey operator[](int x) const { return {id_ ? id_[x] : 0u, depth_ ? depth_[x] : 0.0f}; }

 private:
  const std::uint32_t* id_;
  const float* depth_;
};

}  // namespace varve
