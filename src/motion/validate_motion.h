// What can be said of each vector of a frame, given the frame that it leads to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "motion/seen_pair.h"

namespace varve {

/// `untestable`: the place that the vector leads to lies outside, or something stands in front of it there.
enum class VectorVerdict : std::uint8_t { trusted, doubtful, wrong, untestable };

/// Counts of pixels.
struct MotionCensus {
  std::size_t pixels = 0;
  std::size_t unusable = 0;  ///< NaN: not finite or too long when they were decoded
  std::size_t zero = 0;
  std::size_t one_way = 0;  ///< the vector there does not lead back
  std::array<std::size_t, 4> verdicts{};

  MotionCensus& operator+=(const MotionCensus& more);
};

struct MotionValidity {
  Plane<float> residual;        ///< 0 to 1: how far the light lies outside of what the 3x3 there show, 1 where the
                                ///< surface is not there at all, 0 where nothing can be compared
  Plane<std::uint8_t> verdict;  ///< VectorVerdict
};

/// Residual and verdict of each vector by itself. A vector is wrong by itself only where it is NaN, or where a pixel
/// inside of a surface leads to nothing but what lies behind that surface: light alone makes it doubtful, since light
/// changes for good reasons, and what is hidden there cannot be tested. `back`, the vectors there (may be empty), make
/// doubtful what misses the way back by more than a quarter pixel and a hundredth of both lengths. `doubt`: residual
/// from which on light makes doubtful.
MotionValidity validate_motion(const SeenPair& pair, const Plane<glm::vec2>& motion, const Plane<glm::vec2>& back,
                               double doubt, Workers& workers);

/// Counts what validate_motion() said.
MotionCensus take_census(const MotionValidity& validity, const SeenPair& pair, const Plane<glm::vec2>& motion,
                         const Plane<glm::vec2>& back);

}  // namespace varve
