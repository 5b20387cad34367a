// Vectors there and back: the cheapest test of whether they can be trusted.
#pragma once

#include "gather/source.h"

namespace varve {

/// Distance in pixels between where each sample of `source` is and where its vector to `before` and from there the
/// vector of the same surface back lead; 0 where one of them is not known. `out` has the window of `source`.
void measure_round_trip(const GatherSource& source, const GatherSource& before, const SurfaceTest& test,
                        Plane<float>& out, Workers& workers);

/// `vectors` of `source` to `neighbor`, without those that `back` contradicts: NaN where the round trip misses by more
/// than `tolerance` pixels and a hundredth of the way. Where the surface is not seen in the neighbor nothing is said.
Plane<glm::vec2> trusted_vectors(const GatherSource& source, const Plane<glm::vec2>& vectors,
                                 const GatherSource& neighbor, const Plane<glm::vec2>& back, const SurfaceTest& test,
                                 double tolerance, Workers& workers);

}  // namespace varve
