// Anti-aliasing within one frame, by the shape of its edges: for pixels that time does not help.
#pragma once

#include "base/parallel.h"
#include "base/plane.h"

#include <glm/vec4.hpp>

namespace varve {

/// Farthest that an edge is followed to each side, pixels.
inline constexpr int kEdgeReach = 32;

/// Where two pixels differ by more than a tenth of the greater, in luminance or alpha, and by at least half of what
/// their neighbors differ, the boundary between them is part of an edge. A run of such boundaries that turns by a pixel
/// at an end stands for a slanted contour, from the middle of that step to the middle of the run; each pixel along it
/// takes over the area that the contour cuts off (Reshetov 2009, Morphological Antialiasing; Jimenez 2012, SMAA). Each
/// result is a mean of the pixel and the two beside it in one direction; flat areas keep their bits. Does not depend on
/// exposure. Reads kEdgeReach + 2 pixels around each pixel, within the window only.
Plane<glm::vec4> smooth_edges(const Plane<glm::vec4>& color, Workers& workers);

}  // namespace varve
