// Whether channels that go with a color add up to it, before and after the resolve.
#pragma once

#include <cstddef>

#include "base/parallel.h"
#include "resolve/accumulate.h"

namespace varve {

/// How well the companions that are colors add up to a color: the largest |sum - color| of a channel, relative to the
/// light of the pixel (the greatest of |color| + sum of |companions| among its red, green and blue).
struct LightSum {
  std::size_t pixels = 0, adding_up = 0;  ///< valid pixels, and those of them that add up in the input
  double input = 0, resolved = 0;         ///< largest residual among the latter, before and after the resolve
};

/// A pixel adds up in the input when its residual is no greater: what rounding to half leaves of a sum.
inline constexpr double kLightSumTolerance = 1e-3;

/// Both together.
LightSum operator+(const LightSum& a, const LightSum& b);

LightSum measure_light_sum(const Present& present, const History& resolved, Workers& workers);

}  // namespace varve
