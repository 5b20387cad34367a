// How samples of four histories around a place are weighed.
#pragma once

#include <array>

#include <glm/vec2.hpp>

#include "resolve/choices.h"

namespace varve {

/// Two pixels along each axis of each history lie within a pixel of any place.
inline constexpr int kMostTentSamples = 16;

/// Samples around a place: where they lie, and what each weighs.
struct TentSamples {
  int count = 0;
  std::array<glm::dvec2, kMostTentSamples> place;   ///< minus the place that is asked about, px
  std::array<glm::dvec2, kMostTentSamples> center;  ///< of what the sample holds; equal to `place` where not known
  std::array<double, kMostTentSamples> tent;        ///< filled by weigh_samples_around()
  std::array<double, kMostTentSamples> weight;      ///< likewise; sums to 1
};

/// Fills tent and weight; false where no sample lies within a pixel. The tent of half width `radius` is
/// (1 - |x| / r)(1 - |y| / r). First-order weights are w (c0 + c . d), with sum w' = 1 and sum w' d = 0, d being the
/// center of a sample; where that is not well determined the tent is widened, up to a pixel, and in the end taken as it
/// is.
bool weigh_samples_around(TentSamples& samples, double radius, SubpixelWeights weights);

/// The same with one width, as in the paper; plain where first-order weights are not well determined (condition above
/// 1e6, or sum |w'| above 1.5).
bool weigh_samples_once(TentSamples& samples, double radius, SubpixelWeights weights);

}  // namespace varve
