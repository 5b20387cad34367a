// Two frames side by side, as the tests of the vectors between them see them.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// What a frame shows, for a test of vectors. `depth` and `id` are null where the files have none; `depth` is
/// canonical (canonical_depth()). All planes of a frame have one window.
struct SeenFrame {
  const Plane<float>* light = nullptr;  ///< light_of() its color
  const Plane<float>* depth = nullptr;
  const Plane<std::uint32_t>* id = nullptr;
  glm::dvec2 jitter{0};  ///< sample position minus pixel centre, pixels; 0 where it is not known
};

/// Rec. 709 luminance; negative light and what is not finite count as 0.
Plane<float> light_of(const Plane<glm::vec4>& color, Workers& workers);

/// What the place shows that a vector leads to.
enum class Meeting : std::uint8_t {
  same,     ///< as far as ids and depths tell, the surface itself
  hidden,   ///< something in front of it
  absent,   ///< only what is behind it, or, without depth, another object
  outside,  ///< nothing: the place lies outside the window
};

/// Two frames made comparable. Light x becomes x / (x + m), with m a power of two near the middle of what both frames
/// show, so that every test is relative and scaling both frames by a power of two changes no bit.
class SeenPair {
 public:
  /// `depth_tolerance`: relative difference up to which two depths may be one surface.
  SeenPair(const SeenFrame& here, const SeenFrame& there, double depth_tolerance, Workers& workers);

  const Window& here() const { return light_.window(); }
  const Window& there() const { return other_.window(); }
  bool has_ids() const { return here_.id && there_.id; }
  bool has_depths() const { return here_.depth && there_.depth; }
  /// What is added to a vector to get from the pixel of a sample to that of the sample at the same place of the
  /// surface.
  glm::dvec2 jitter_step() const { return here_.jitter - there_.jitter; }

  float light(int x, int y) const { return light_.at(x, y); }
  const Plane<float>& light_here() const { return light_; }
  const Plane<float>& light_there() const { return other_; }
  const Plane<std::uint32_t>& ids_here() const { return *here_.id; }
  const Plane<float>& depths_here() const { return *here_.depth; }
  const Plane<std::uint32_t>& ids_there() const { return *there_.id; }
  std::uint32_t id(int x, int y) const { return here_.id->at(x, y); }
  float depth(int x, int y) const { return here_.depth->at(x, y); }

  /// What pixel (u, v) there is to pixel (x, y) here.
  Meeting meet(int x, int y, int u, int v) const {
    if (!there().contains(u, v)) return Meeting::outside;
    const bool ids = has_ids(), depths = has_depths();
    if (ids && here_.id->at(x, y) == there_.id->at(u, v)) return Meeting::same;
    if (!depths) return ids ? Meeting::absent : Meeting::same;
    const float own = here_.depth->at(x, y), other = there_.depth->at(u, v);
    if (!ids && near(own, other)) return Meeting::same;
    return other < own ? Meeting::hidden : Meeting::absent;
  }
  /// The same for the 3x3 around (u, v): one sample of the surface is enough, then one in front of it.
  Meeting meet_around(int x, int y, int u, int v) const;

  /// How far the light of (x, y) lies outside what the 3x3 around (u, v) there shows, 0 to 1: what aliasing and noise
  /// of single samples cannot explain. (u, v) lies in the window there.
  float miss(int x, int y, int u, int v) const {
    const float t = light_.at(x, y), low = low_.at(u, v), high = high_.at(u, v);
    return t > high ? t - high : t < low ? low - t : 0.0f;
  }

 private:
  bool near(float a, float b) const {
    if (a == b) return true;  // both infinitely far as well
    return a < b ? b - a <= tolerance_ * a : a - b <= tolerance_ * b;
  }
  SeenFrame here_, there_;
  float tolerance_;
  Plane<float> light_, other_, low_, high_;  // low and high: of the 3x3 there
};

}  // namespace varve
