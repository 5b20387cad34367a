// Two colors made ready for metrics that cannot take NaN or infinities.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Reference `a` and test `b` over one window, scene-linear RGBA, every value finite. `bad` is 1 where R, G or B was
/// not finite and not the same on both sides: both colors are 0 there, and each metric counts the worst it knows.
struct ColorPair {
  Plane<glm::vec4> a, b;
  Plane<std::uint8_t> bad;
  std::size_t bad_pixels = 0;

  const Window& window() const { return a.window(); }
};

/// Takes two planes over the same window. Infinities that agree become +-65504, NaN that agree (when `nan_equal`) 0.
ColorPair make_color_pair(Plane<glm::vec4> a, Plane<glm::vec4> b, bool nan_equal, Workers& workers);

/// Luminance of linear Rec. 709 primaries.
inline float luminance(const glm::vec4& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

}  // namespace varve
