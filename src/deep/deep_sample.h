// One sample of a deep pixel, as it enters the arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec4.hpp>

namespace varve {

/// A point (front == back), or a volume of constant density from `front` to `back`.
struct DeepSample {
  double front = 0, back = 0;  ///< distance from the camera, not NaN
  glm::dvec4 opacity{0.0};     ///< of R, G, B and A, 0..1
  glm::dvec4 color{0.0};       ///< premultiplied R, G, B, and A
  std::uint32_t index = 0;     ///< place in the pixel as stored
};

/// What was wrong with samples; added up over pixels.
struct DeepDefects {
  std::size_t dropped = 0;  ///< no depth: left out
  std::size_t turned = 0;   ///< ends before it begins, or nowhere: taken for a point
  std::size_t opacity = 0;  ///< opacity below 0 or above 1 held there; NaN makes the pixel unusable
  DeepDefects& operator+=(const DeepDefects& other);
  std::size_t total() const { return dropped + turned + opacity; }
};

/// Makes a sample fit for sorting and compositing, and counts what had to be done. False: it has no depth and is to be
/// left out.
bool repair(DeepSample& sample, DeepDefects& defects);

/// Front to back: by front, then back. Points in one place lie in the order in which they are stored, which is all that
/// tells it (OpenEXR's own compositing does the same); volumes that coincide are told apart by what they hold, so that
/// sums do not depend on that order.
bool is_before(const DeepSample& a, const DeepSample& b);

}  // namespace varve
