// What is painted on a surface: functions of its own coordinates, sharp at any magnification.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace varve::synth {

enum class Pattern { plain, checker, bricks, zone_plate, stripes, grid, spots, value_noise, emitters };

struct Texture {
  Pattern pattern = Pattern::plain;
  glm::dvec3 first{0.8}, second{0.1};  ///< scene-linear colors between which the pattern switches
  double size = 10;  ///< of a cell, in units of the surface; zone plate: radius where it reaches 1 cycle
                     ///< in 2 units
  std::uint64_t seed = 1;
};

/// Color at (u, v), units of the surface.
glm::dvec3 texture_color(const Texture& texture, double u, double v);

}  // namespace varve::synth
