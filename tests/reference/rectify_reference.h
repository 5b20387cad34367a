// The slow twin of the rectification: every shape as a question "is this color inside", every clip by bisection.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "reference/shape_reference.h"
#include "resolve/accumulate.h"

namespace varve::reference {

struct Rectified {
  Color color{};        ///< RGBA
  double clip = 0;      ///< relative distance, RGB
  double distance = 0;  ///< in the space of the box
  double noise = 0;     ///< variance of one sample there, three components together
};

/// History `h` (RGBA) held to the neighborhood of (x, y); nothing when no neighbor counts. `now` is the present.
std::optional<Rectified> rectify(const Present& present, const RectifyParameters& p, const Color& h, const Color& now,
                                 int x, int y, bool with_centre);

/// Weights that the moments of a pixel give to the pixels around, by the definition of each kind.
std::vector<Sample> weighed_samples(const Present& present, const RectifyParameters& p,
                                    const std::function<Color(const glm::vec4&)>& map, int x, int y, bool with_centre);

}  // namespace varve::reference
