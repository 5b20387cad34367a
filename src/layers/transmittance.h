// What a layer lets through: from its alpha, or from channels of its own.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "resolve/present.h"

namespace varve {

/// Holds alpha and transmittance in 0..1 and counts the pixels where that changed something (Present::opacity_held).
/// Transmittance that is not a number is taken from alpha.
void hold_opacity(Present& present, Workers& workers);

/// Where the channels of a layer hold what it and all in front of it let through: divides, so that each says what it
/// lets through by itself. `cumulative`: which of the layers, front to back, hold that; the others multiply. Where
/// nothing arrives any more, nothing is held back. To be called before hold_opacity().
void separate_transmittance(std::span<Present> layers, const std::vector<bool>& cumulative, Workers& workers);

/// A gray transmittance as alpha, which every accumulator takes along. Does nothing where the plane is empty.
void fold_into_alpha(Present& present, Workers& workers);

/// What came of a layer: alpha in 0..1, and no color where nothing is covered, unless the layer shines there: `present`
/// has light without coverage in the 3x3 around.
void hold_resolved(Plane<glm::vec4>& color, const Present& present, Workers& workers);

/// Held in 0..1; 1, and so no coverage, for what is not a number.
inline double held(double t) { return t < 1 ? (t > 0 ? t : 0.0) : 1.0; }

/// R G B of a pixel inside the layer's window.
inline glm::dvec3 transmittance_at(const Present& layer, int x, int y) {
  if (layer.transmittance.empty()) return glm::dvec3(held(1 - double(layer.color.at(x, y).w)));
  const glm::vec3& t = layer.transmittance.at(x, y);
  return {held(double(t.x)), held(double(t.y)), held(double(t.z))};
}

}  // namespace varve
