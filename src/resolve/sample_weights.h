// Reconstruction of the present from true sample positions (math, section 5).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "resolve/choices.h"
#include "resolve/present.h"

namespace varve {

/// One-dimensional reconstruction kernel at `x` pixels from its centre; integrates to 1 over the line.
/// Tent of radius 1; Gaussian of sigma 0.47 px, cut at 1.5; Blackman-Harris 3.3 px wide; Mitchell-Netravali B = C =
/// 1/3.
double reconstruction_kernel(SampleFilter filter, double x);

/// Distance from which on the kernel is 0.
double reconstruction_radius(SampleFilter filter);

struct WeighedPresent {
  Plane<glm::vec4> color;      ///< sum w c / sum w over the samples around each pixel centre
  Plane<float> sample_weight;  ///< sum w; 1 on average over all jitters
};

/// Weighs the samples at p + 0.5 + jitter by their distance from each pixel centre. Invalid samples have no part. With
/// a kernel that has negative lobes, a pixel whose sum falls below a tenth uses the positive part only. Reads a border
/// of 2 pixels (3 where |jitter| exceeds half a pixel).
WeighedPresent weigh_samples(const Present& present, SampleFilter filter, glm::dvec2 jitter, Workers& workers);

/// The present at the pixel centers, by a bilinear fetch at minus the jitter (Pedersen 2016): softer than the samples,
/// tends to a tent over many frames. Invalid samples have no part; an invalid pixel keeps what stands in for it.
Plane<glm::vec4> unjitter_bilinear(const Present& present, glm::dvec2 jitter, Workers& workers);

}  // namespace varve
