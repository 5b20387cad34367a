// Light that changes without a vector: how much brighter a surface is in the resolved frame than in another one.
#pragma once

#include <glm/vec4.hpp>

#include "gather/source.h"

namespace varve {

/// Of scene-linear Rec.709.
inline double luminance(const glm::vec4& c) {
  return 0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b);
}

/// Mean luminance of a frame around each pixel on the same surface: `edge` x `edge` pixels (odd) of its object whose
/// own 3x3 neighbors all belong to it, so that edges do not leak in. 0 where there are none. Separable: means along
/// rows, then of those along columns; cost does not grow with the window.
/// `color` may be a better picture of the frame than its samples.
Plane<float> local_light(const Plane<glm::vec4>& color, const Present& present, const SurfaceTest& test, int edge,
                         Workers& workers);

/// `light` is that of a pilot, whose neighboring frames blur light that changes at once. Where the frame's own samples
/// differ from the pilot over the window by more than 6 standard errors and a twentieth, they are right.
void follow_sudden_light(Plane<float>& light, const Plane<glm::vec4>& pilot, const Present& present,
                         const SurfaceTest& test, int edge, Workers& workers);

/// Luminance of `color` and its range over 3x3 pixels.
Plane<LightRange> local_range(const Plane<glm::vec4>& color, const Present& present, const SurfaceTest& test,
                              Workers& workers);

struct ShadingGain {
  float gain = 1;    ///< to multiply the sample with
  float weight = 1;  ///< how much it counts: the more the light has changed, the less
};

/// Of the sample of pixel (x, y) of `source`, which arrives at `at` (pixels) in `target` on surface `key`.
/// Changes below `dead_zone` count as noise and are shrunk away; at a change of `half_weight` (logarithm) the sample
/// counts half. 1 and 1 where either side has no light to compare.
/// Where the picture of the other frame, brought to this light, falls far outside of what the pixels around show here,
/// as a highlight does that slides over its surface, the sample counts less still: its light cannot be followed, so the
/// window shrinks.
ShadingGain shading_gain(const GatherSource& source, int x, int y, const GatherSource& target, glm::dvec2 at,
                         SurfaceKey key, const SurfaceTest& test, double dead_zone, double half_weight);

}  // namespace varve
