// HDR-FLIP: the greatest FLIP over a range of exposures (Andersson et al. 2021).
#pragma once

#include "diagnose/flip.h"

namespace varve {

/// Exposures in stops, from the reference alone: from where its brightest to where its median luminance is toned to
/// 0.85, in n = max(2, ceil(range)) even steps.
struct ExposureRange {
  double first = 0, last = 0;
  int count = 2;
};

/// A median or maximum of 0 would give an endless range: luminances are held to 2^-16 .. 65504, and the count to 40.
ExposureRange exposure_range(const Plane<glm::vec4>& reference);

/// The map of two finite scene-linear planes over the same window. `bad` as for flip_map.
Plane<float> hdr_flip_map(const Plane<glm::vec4>& reference, const Plane<glm::vec4>& test,
                          const Plane<std::uint8_t>& bad, const ExposureRange& range, Workers& workers,
                          double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace varve
