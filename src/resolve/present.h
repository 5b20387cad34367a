// One subject at one frame, ready to be accumulated: canonical conventions, every value finite.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Border of the color planes of a present: the largest neighborhood (7x7) reads three pixels beyond.
inline constexpr int kPresentBorder = 3;

/// What is shown of how several layers or samples became one; empty where they did not, or where it is not asked for.
struct CombinePlanes {
  Plane<float> winner;     ///< 1 and up: whose motion the pixel follows, the nearest being 1; 0: the background's
  Plane<float> variation;  ///< what decided it: change of transmittance across the winner, 0..1
  Plane<float> touched;    ///< how many have a part in the pixel
};

struct Present {
  Plane<glm::vec4> color;                    ///< scene-linear premultiplied RGBA; 0 in the border
  std::vector<Plane<glm::vec4>> companions;  ///< planes that go with the color (Subject::companions); 0 in the border
  std::vector<std::uint8_t> companion_is_color;  ///< 1: its places are R G B A; 0: values that stand alone; all 1 if
                                                 ///< empty
  Plane<float> valid;                    ///< 1 where color came finite from the file, 0 elsewhere and in the border
  std::vector<std::uint8_t> rows_valid;  ///< per row: 1 when every pixel of it is valid
  std::optional<glm::dvec2> jitter;  ///< sample position minus pixel centre, pixels; none where it is not known, and
                                     ///< where color was reconstructed at the pixel centers
  Plane<float> sample_weight;        ///< from how much it was reconstructed there, 1 on average; else empty
  Plane<glm::vec4> reconstructed;    ///< what a sample filter made of several samples of known positions, whose mean
                                     ///< is color; else empty
  Plane<glm::vec2> motion;   ///< backward motion, pixels, y down; NaN where unusable; empty: at rest. As stored, or
                             ///< dilated by follow_motion()
  Plane<glm::vec2> forward;  ///< the same to the next frame; empty unless asked for and in the file
  Plane<float> depth;        ///< of the surface that lent the motion, +inf for background; may be empty
  Plane<std::uint32_t> id;   ///< of that surface, to be compared only; empty unless the plan needs it
  Plane<glm::vec3> normal;   ///< of that surface, of length 1, or 0 where unknown; empty unless the plan needs it
  Plane<float> reactive;     ///< of the pixel itself, 0..1: how much less history counts; may be empty
  Plane<float> responsive;   ///< of the pixel itself, 0 and up: factor on the weight of the present; may be empty
  Plane<glm::vec3> transmittance;  ///< of a layer by itself, R G B, 0..1; empty: one minus its alpha
  CombinePlanes combined;
  std::size_t not_finite = 0;             ///< pixels with a channel that was NaN or infinite
  std::size_t opacity_held = 0;           ///< pixels of layers whose alpha or transmittance lay beyond 0..1
  std::size_t companions_not_finite = 0;  ///< values of companions that were NaN or infinite
};

/// Replaces every pixel with a non-finite channel by the mean of its valid 3x3 neighbors (0 if it has none), marks it
/// in `valid` and counts it. Such a pixel has no say afterwards: not in neighborhoods, not in the history. `color` must
/// have kPresentBorder; the border is cleared. Reads a border of one pixel.
void sanitize(Present& present, Workers& workers);

/// The same for the companions, after sanitize(): where the color is not valid, and where a companion's value is not
/// finite, it becomes the mean of what its valid 3x3 neighbors hold. Each channel by itself; neither the color nor
/// another companion loses anything by it. Where channels sum to the color, the repaired ones do as well.
void sanitize_companions(Present& present, Workers& workers);

}  // namespace varve
