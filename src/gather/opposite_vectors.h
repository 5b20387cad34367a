// Vectors in the direction that the files do not have, from those of the neighboring frame.
#pragma once

#include "gather/source.h"

namespace varve {

/// Vectors of `source` to `neighbor`, given those of `neighbor` back to `source`: the point of the neighbor is looked
/// for whose vector leads exactly to the sample. The search starts where a sample of the same surface landed closest,
/// so that things that turn round are found, and its result is kept only if it leads back within `tolerance` pixels.
/// NaN where the surface is hidden in the neighbor.
Plane<glm::vec2> opposite_vectors(const GatherSource& source, const GatherSource& neighbor,
                                  const Plane<glm::vec2>& back, const SurfaceTest& test, double tolerance,
                                  Workers& workers);

}  // namespace varve
