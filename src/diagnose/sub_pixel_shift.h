// How far the samples of one frame lie from those of another within the pixel, from their pixels and vectors alone.
#pragma once

#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Luma as L / (L + middle), from -0 to 1: neither exposure nor highlights matter much. NaN where `valid` is 0.
/// `middle` is the same for all frames that are held against each other; 0 or below leaves everything at 0.
Plane<float> tone_plane(const Plane<glm::vec4>& color, const Plane<float>& valid, double middle, Workers& workers);

/// Median luma of the valid pixels that shine at all, of every fourth one in both directions; 0 where none does.
double middle_luma(const Plane<glm::vec4>& color, const Plane<float>& valid);

struct SubPixelShift {
  glm::dvec2 shift{0};     ///< sample offset of `now` minus that of `before`, pixels, y down
  glm::dvec2 sigma{1e9};   ///< standard errors of it, pixels, by how tiles disagree; 1e9: nothing to tell by
  std::size_t pixels = 0;  ///< that took part
  double identical = 0;    ///< share of those with any structure around whose tone is the same to the last bit
  double textured = 0;     ///< share of the pixels that have structure around
  double still = 0;        ///< share of the pixels whose vector is shorter than 1/64 px
  bool found = false;      ///< false: no solution within 1.5 px
};

/// Solves  sum over p and q of w(q) grad before(q) (now(p) - before(q)) = 0  for the shift, where q are the 4x4 pixels
/// around p + motion(p) + shift and w their weights of Catmull and Rom, in planes that were smoothed a little: the
/// gradient never meets the noise of its own pixel, and where the picture is sampled without a filter the sum is still
/// 0 at the true shift on average, as correlations of edges are straight lines below a pixel. `motion` leads from now
/// to before (pixels, jitter not in it; NaN: unknown); empty: at rest. Pixels beside a step of the motion take no part:
/// two surfaces meet there. Tiles of 16x16 pixels that contradict most of the structure weigh less: shadows and
/// mirrored things move otherwise than the vectors of the surface. What all tiles share, such as a texture as regular
/// as the pixels, is not in the standard error.
SubPixelShift measure_shift(const Plane<float>& now, const Plane<float>& before, const Plane<glm::vec2>& motion,
                            Workers& workers);

}  // namespace varve
