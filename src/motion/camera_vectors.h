// Stored vectors completed by what the camera did: background that lacks its motion, zoom that all lack.
#pragma once

#include <cstddef>
#include <optional>

#include "motion/camera.h"

namespace varve {

/// How many of the pixels looked at move as what rests in the world does, by vectors that hold the change of the lens
/// and by vectors that do not. Moving things agree with neither.
struct CameraEvidence {
  std::size_t looked_at = 0;     ///< have depth and a vector, and the camera moves them by half a pixel or more
  std::size_t agree = 0;         ///< with either
  std::size_t zero = 0;          ///< whose vector is exactly 0
  std::size_t with_lens = 0;     ///< tell the two apart and hold the change of the lens
  std::size_t without_lens = 0;  ///< tell the two apart and lack it
  std::size_t lens_tested = 0;   ///< the two differ by a fiftieth of a pixel or more
};

/// Looks at some two thousand pixels, evenly spread, always the same. `motion` and `depth` share their window.
CameraEvidence compare_with_camera(const Plane<glm::vec2>& motion, const Plane<float>& depth, glm::dvec2 jitter,
                                   const CameraChange& change);

/// What evidence allows. Where it is contradictory or too thin, nothing is done.
bool contradicts(const CameraEvidence& evidence);  ///< next to nothing moves as the camera says
bool all_zero(const CameraEvidence& evidence);     ///< the vectors are no vectors
bool lacks_lens(const CameraEvidence& evidence);   ///< zoom and lens shift are not in the vectors
bool lens_is_unclear(const CameraEvidence& evidence);

/// What is to be completed.
struct CameraFill {
  bool background = false, lens = false;
};
struct CameraFilled {
  std::size_t background = 0, lens = 0;  ///< pixels
};

/// Background (depth +inf) whose vector is 0 or unusable gets the motion of the camera. Every other vector gets the
/// change of the lens added: where it ends through the lens of this frame, seen through that of the other, which is
/// right for moving things too and at any depth; those that become longer than `max_length` become NaN.
CameraFilled complete_vectors(Plane<glm::vec2>& motion, const Plane<float>& depth, glm::dvec2 jitter,
                              const CameraChange& change, const CameraFill& fill, double max_length, Workers& workers);

/// Takes jitter for what it is: where the lens shift of two frames differs as their jitter does, the matrices hold the
/// jitter and it is taken out of both; where the jitter is not known, a difference below a pixel is taken for jitter
/// too. Vectors here are jitter-free.
void take_out_jitter(Camera& from, Camera& to, const std::optional<glm::dvec2>& jitter_from,
                     const std::optional<glm::dvec2>& jitter_to);

}  // namespace varve
