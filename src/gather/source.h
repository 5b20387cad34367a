// One frame as the gather sees it.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "resolve/present.h"

namespace varve {

/// A frame of the window. `backward` and `forward` are undilated; either is NaN where nothing is known. All planes have
/// the window of present->color.
struct GatherSource {
  const Present* present = nullptr;
  glm::dvec2 jitter{0};                         ///< sample position minus pixel centre, pixels
  const Plane<glm::vec2>* backward = nullptr;   ///< to the frame before; null: at rest
  const Plane<glm::vec2>* forward = nullptr;    ///< to the frame after; null: at rest
  const Plane<float>* local_light = nullptr;    ///< mean luminance around each pixel on its surface; null: no gain

  const Window& window() const { return present->color.window(); }
  /// Position of the sample of pixel (x, y).
  glm::dvec2 position(int x, int y) const { return {x + 0.5 + jitter.x, y + 0.5 + jitter.y}; }
};

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
  bool near(float a, float b) const {
    if (a == b) return true;  // both infinitely far as well
    const float nearer = a < b ? a : b;
    return std::fabs(a - b) <= tolerance * nearer;
  }
};

inline SurfaceKey surface_at(const Present& p, int x, int y) {
  return {p.id.empty() ? 0u : p.id.at(x, y), p.depth.empty() ? 0.0f : p.depth.at(x, y)};
}

}  // namespace varve
