// The way from the present back to a history that was written some frames ago.
#pragma once

#include <glm/vec2.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// One frame on: the vectors of the present, `motion`, and from where they lead the way as it was seen there. Between
/// pixels it is interpolated where the four around agree within half a pixel; where they do not, as between two
/// surfaces, the nearest counts. NaN where there is no vector, or where it leads out of the window. `way` empty: the
/// history is that of the frame before. `motion` empty: all rests. Windows may differ.
Plane<glm::vec2> carry_way(const Plane<glm::vec2>& way, const Plane<glm::vec2>& motion, const Window& window,
                           Workers& workers);

}  // namespace varve
