// FLIP: what a viewer notices when two pictures take turns on a screen (Andersson et al. 2020). 0 same, 1 worst.
#pragma once

#include <cstdint>

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Pixels per degree of a 0.7 m wide monitor of 3840 pixels seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.0206;

/// The map of two linear RGB planes over the same window, finite values; held to 0..1 first. `bad` (may be empty) marks
/// pixels that count 1.
Plane<float> flip_map(const Plane<glm::vec4>& reference, const Plane<glm::vec4>& test, const Plane<std::uint8_t>& bad,
                      Workers& workers, double pixels_per_degree = kFlipPixelsPerDegree);

/// Mean of a plane; NaN when it is empty.
double mean_of(const Plane<float>& map, Workers& workers);

}  // namespace varve
