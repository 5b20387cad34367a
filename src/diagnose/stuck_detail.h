// Detail that stays where it is on the screen while the picture moves: noise from a seed that never changes, dirt.
#pragma once

#include <cstddef>

#include <glm/vec2.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

struct StuckDetail {
  double correlation = 0;  ///< -1 to 1; about 1 / sqrt(pixels) by chance
  std::size_t pixels = 0;  ///< that moved by 2 pixels or more and took part
};

/// Correlation, at the same pixel of both frames, of what is left of a pixel without the mean of its four neighbors.
/// Planes as of tone_plane(); `motion` leads from now to before, NaN: unknown. The same bits for any thread count.
StuckDetail stuck_detail(const Plane<float>& now, const Plane<float>& before, const Plane<glm::vec2>& motion,
                         Workers& workers);

}  // namespace varve
