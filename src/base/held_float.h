// Doubles on their way to float: beyond its range there is no color, only an infinity that spreads.
#pragma once

#include <algorithm>

#include <glm/vec4.hpp>

namespace varve {

/// Held at the ends of the floats. NaN stays NaN.
inline float held_float(double value) {
  constexpr double most = 3.4028234663852886e38;
  return float(std::clamp(value, -most, most));
}

inline glm::vec4 held_color(const glm::dvec4& color) {
  return {held_float(color.r), held_float(color.g), held_float(color.b), held_float(color.a)};
}

}  // namespace varve
