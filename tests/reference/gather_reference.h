// The slow twin of the gather: one pixel at a time, every sample of every frame looked at, in double.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "gather/gather.h"

namespace varve::reference {

/// Where each sample of a frame goes, row by row: x and y the displacement, z the depth there. x is NaN where it cannot
/// be followed.
using CarriedSamples = std::vector<glm::dvec3>;

/// Of all frames, outwards from sources[present].
std::vector<CarriedSamples> carry_samples(std::span<const GatherSource> sources, std::size_t present,
                                          const SurfaceTest& test);

/// What gather() without a gain and without the test of changes must give at (x, y).
glm::dvec4 gathered_pixel(std::span<const GatherSource> sources, std::size_t present,
                          const std::vector<CarriedSamples>& carried, const GatherParameters& parameters,
                          const SurfaceTest& test, int x, int y);

}  // namespace varve::reference
