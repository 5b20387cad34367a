// Where in the pixel further samples are to lie: where those that are there are not.
#pragma once

#include <map>
#include <vector>

#include <glm/vec2.hpp>

namespace varve {

/// Sample positions minus pixel center, pixels, y down, by frame.
using FramePositions = std::map<int, std::vector<glm::dvec2>>;

/// For each frame of `counts` that many positions. Each is the point, of 1024 that fill the pixel evenly, that lies
/// farthest from those of `known` in frames up to four away and from those found before it; distances are those between
/// neighboring pixels as well, and grow with that in time. Depends on nothing else.
FramePositions fill_positions(const std::map<int, int>& counts, const FramePositions& known);

}  // namespace varve
