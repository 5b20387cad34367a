// The color space in which history is held against its neighborhood.
#pragma once

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"
#include "resolve/choices.h"
#include "resolve/present.h"

namespace varve {

/// A color space with what it needs to know of the frame.
struct BoxSpaceMap {
  BoxSpace space = BoxSpace::rgb;
  /// Log only: sign(x) ln(1 + |x| / knee), linear around 0 and odd, so zero and negative values have their place.
  double knee = 1;
};

/// The log's knee lies six stops below the median of what is not black, a power of two: light that is a power of two
/// brighter gives the same logarithms, and fireflies do not move it. It is the one number here that far pixels share.
/// The logarithm is the C library's: its last bit may differ between systems.
BoxSpaceMap box_space_map(BoxSpace space, const Present& present, Workers& workers);

/// RGBA to the space and back; alpha stays as it is.
glm::dvec4 to_box_space(const BoxSpaceMap& map, const glm::dvec4& rgba);
glm::dvec4 from_box_space(const BoxSpaceMap& map, const glm::dvec4& color);

/// A whole plane, border and all; empty for RGB, where the color itself serves.
Plane<glm::vec4> plane_in_box_space(const BoxSpaceMap& map, const Plane<glm::vec4>& color, Workers& workers);

}  // namespace varve
