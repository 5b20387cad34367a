// Four histories in the quarters of a pixel (Yang, Nehab, Sander, Sitthi-amorn, Lawrence and Hoppe 2009). A frame adds
// its sample to the one of the quarter in which it lies; the others wait until theirs comes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/plane.h"
#include "resolve/choices.h"

namespace varve {

inline constexpr std::size_t kQuadrants = 4;

/// Middles of the quarters, minus the pixel center; pixels, y down. In the order of the paper's round.
inline constexpr std::array<glm::dvec2, kQuadrants> kQuadrantMiddle = {
    glm::dvec2(-0.25, -0.25), glm::dvec2(0.25, 0.25), glm::dvec2(0.25, -0.25), glm::dvec2(-0.25, 0.25)};

/// The quarter that a sample lies in, by its position minus the pixel center. What lies on a border belongs to the
/// right, or below.
constexpr std::size_t quadrant_of(const glm::dvec2& jitter) {
  const bool right = jitter.x >= 0, below = jitter.y >= 0;
  return right == below ? (right ? 1 : 0) : (right ? 2 : 3);
}

struct SubpixelParameters {
  double radius = 0.5;  ///< px, half width of the tent, [0.5, 1]; widened where it does not hold enough samples
  SubpixelWeights weights = SubpixelWeights::first_order;
  BlurBound bound = BlurBound::tracked;
  int scale = 1;  ///< 2: the quarters are written as pixels of their own
};

/// One of the four. Planes have the window of the frame that was added last; all are empty before the first.
struct SubpixelBuffer {
  Plane<glm::vec4> color;
  std::vector<Plane<glm::vec4>> companions;  ///< in the order of Present::companions
  Plane<float> total;                        ///< samples seen, in effect; 0: no valid data
  Plane<float> spread;                       ///< sum of squared normalized weights
  Plane<glm::vec3> moments;  ///< of the kernel that made the color, around the middle of the quarter: mean x and y
                             ///< (px), and second moment (px^2, mean of both axes)
  // Of the frame that was added last; each empty unless a test needs it.
  Plane<float> depth;
  Plane<std::uint32_t> id;
  Plane<glm::vec3> normal;
  /// From pixels of the present to this history: position there minus position here, px; NaN where no vector leads
  /// there; empty: it is of the present frame. Its window is that of the present.
  Plane<glm::vec2> way;
  int lag = 0;  ///< frames since the last sample was added

  bool empty() const { return color.empty(); }
};

/// What one frame leaves to the next.
struct SubpixelHistory {
  std::array<SubpixelBuffer, kQuadrants> quadrants;

  bool empty() const {
    for (const SubpixelBuffer& q : quadrants)
      if (!q.empty()) return false;
    return true;
  }
};

}  // namespace varve
