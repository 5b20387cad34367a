// Layers of one pixel, front to back: what each adds, what is left of the light behind it.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace varve {

/// Luminance of Rec. 709 primaries; of a gray exactly its value.
inline double luminance(const glm::dvec3& rgb) {
  return rgb.x == rgb.y && rgb.y == rgb.z ? rgb.x : 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

/// Premultiplied over in linear light, in double: C = sum T_{k-1} c_k, with T_k = T_{k-1} t_k. Transmittance goes by
/// products, never as 1 - A: after two thousand layers of alpha 0.02 that still is right to the last digits.
class Over {
 public:
  /// What a layer that lets `t` through changes.
  struct Change {
    double variation = 0;     ///< dT = T_{k-1} - T_k, by luminance
    double contribution = 0;  ///< luminance of T_{k-1} c_k
  };

  /// Puts a layer behind what is there. `t` in 0..1, R G B.
  Change add(const glm::dvec3& color, const glm::dvec3& t) {
    const glm::dvec3 before = transmittance_, part = before * color;
    light_ += part;
    transmittance_ = before * t;
    return {luminance(before - transmittance_), luminance(part)};
  }

  const glm::dvec3& light() const { return light_; }
  const glm::dvec3& transmittance() const { return transmittance_; }
  /// Light and opacity. The latter is what is held back by luminance.
  glm::dvec4 color() const { return {light_, 1 - luminance(transmittance_)}; }

 private:
  glm::dvec3 light_{0.0}, transmittance_{1.0};
};

}  // namespace varve
