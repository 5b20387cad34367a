// Where each sample of a frame lies in the frame that is resolved: vectors chained along its own surface.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "gather/source.h"

namespace varve {

/// Per sample of a frame: displacement to the resolved frame in pixels (x, y), and the depth there (z). x is NaN where
/// the sample cannot be followed.
using Carried = Plane<glm::vec3>;

/// The resolved frame itself: nothing moves.
Carried carry_present(const GatherSource& present, Workers& workers);

/// Samples of `source`, one frame further away than `nearer`, whose field is known. The own vector of a sample leads to
/// `nearer`; from there its displacement is read between the samples of the same surface: bilinearly over their true
/// positions where all four agree, else by a weighted affine fit in a growing window, which keeps the motion of thin
/// things exact. Where the surface is hidden in `nearer`, `beyond` (may be null; the next frame on the way) is tried
/// with the vector doubled. Computed in double; interpolating the whole displacement instead of one vector a frame
/// makes the cost of a frame independent of its distance.
/// Reads: 16x16 samples around where a vector leads.
struct Followed {
  const GatherSource* source = nullptr;
  const Carried* field = nullptr;
};
Carried carry(const GatherSource& source, bool to_future, const SurfaceTest& test, Followed nearer, Followed beyond,
              Workers& workers);

/// The value of a plane of vectors at `at`, read between the samples of one surface as carry() does. x is NaN where no
/// sample of that surface is near.
glm::dvec2 read_between(const Plane<glm::vec2>& field, const GatherSource& source, glm::dvec2 at, SurfaceKey key,
                        const SurfaceTest& test);

}  // namespace varve
