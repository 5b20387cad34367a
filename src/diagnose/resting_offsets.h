// Where in its pixel each of several frames was sampled, from pixels at rest: how much samples differ depends on how
// far apart they lie, and on nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Fewer frames leave the function that is to be found unknown.
inline constexpr std::size_t kFewestAtRest = 4;

struct RestingOffsets {
  std::vector<glm::dvec2> offsets;  ///< pixels, of mean 0
  std::vector<glm::dvec2> sigma;    ///< standard errors, pixels, as far as the misfit tells
  double misfit = 0;                ///< rms of the relative differences that the offsets leave unexplained
  bool found = false;
};

/// For each pair of frames and each of 3x3 whole lags k, the mean square difference of samples k pixels apart is a
/// value of one even function (the variogram of the picture) at k + offset now - offset before. The function and the
/// offsets are fitted together, so neither aliasing nor noise, which is the same for all pairs, bends the scale.
/// `tones` as of tone_plane(), over one window; `resting` is 1 where all frames show the same thing in the same place.
/// `start`: offsets to begin with, in the right pixel quarter or so.
RestingOffsets resting_offsets(std::span<const Plane<float>* const> tones, const Plane<std::uint8_t>& resting,
                               std::span<const glm::dvec2> start, Workers& workers);

}  // namespace varve
