// From stored vectors to the backward motion that a pixel follows: decode, invert where only the future is known,
// dilate.
#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/parallel.h"
#include "base/plane.h"
#include "motion/convention.h"

namespace varve {

/// Which of the 3x3 neighbors' vectors a pixel follows: its own, that of the nearest surface (Pedersen 2016), or the
/// longest (Salvi 2016). Either keeps the antialiased rim of a moving thing moving with it.
enum class Dilation { none, nearest, longest };

/// What a depth channel counts: distance along the view axis (larger is farther), 1/distance, negative z, or distance
/// from the eye along the ray.
enum class DepthKind { distance, inverse, negative, ray };

/// What motion is taken from cameras: that of subjects without any vectors only; also that of background whose vectors
/// are zero; also zoom and lens shift where vectors lack them; or all of it.
enum class CameraUse { missing, background, zoom, all };

struct MotionParameters {
  Dilation dilation = Dilation::longest;
  double max_length = 16384;  ///< px; a longer vector is unusable
  DepthKind depth_kind = DepthKind::distance;
  CameraUse camera = CameraUse::missing;
};

/// Stored vectors to pixels, y down: `decoded = sign * ((v - bias) * scale) / shutter`, then the unit. `x` and `y`
/// cover the same window. Vectors that are not finite, or longer than max_length, become NaN in both parts. Returns how
/// many did, through `unusable`.
Plane<glm::vec2> decode_motion(const Plane<float>& x, const Plane<float>& y, const MotionEncoding& encoding,
                               const Window& display_window, double max_length, Workers& workers,
                               std::size_t& unusable);

/// Depth in the program's terms: distance, larger is farther, background +inf; planar, except that ray distances stay
/// until a camera makes them so (ray_to_planar_depth). Background is: not finite, zero
/// or below (as a distance), or from `background` on.
void canonical_depth(Plane<float>& depth, DepthKind kind, double background, Workers& workers);

/// Motion from this frame to another one, made of the vectors `there` that lead from that frame to this one: each pixel
/// there lands, with its motion turned round, on the four pixels around where it goes; the nearest surface wins, then
/// the closest landing, then the first in reading order. Works in both directions of time. `depth_there` may be empty.
/// With `depth` (of this frame), a landing counts only where the surface seen here has its depth, up to
/// `depth_tolerance` of the nearer one: it may have landed behind something. Where nothing lands, which is where the
/// surface is hidden there, `otherwise` stands. Reads the whole other frame.
Plane<glm::vec2> invert_motion(const Plane<glm::vec2>& there, const Plane<float>& depth_there,
                               const Plane<float>& depth, double depth_tolerance, Plane<glm::vec2> otherwise);

/// How far a pixel's motion to another frame and the motion from there back miss each other: where they do by more than
/// `tolerance` pixels and a hundredth of their lengths together (|a + b|^2 > tolerance^2 + .01^2 (|a|^2 + |b|^2), after
/// Sundaram, Brox and Keutzer 2010), the motion becomes NaN. `back` is read at the nearest pixel; where it is NaN or
/// lies outside, nothing is known and nothing changes.
void reject_one_way_motion(Plane<glm::vec2>& motion, const Plane<glm::vec2>& back, double tolerance, Workers& workers);

/// Backward motion from the vectors of the previous frame to this one, inverted. Where nothing lands (a surface
/// that was hidden), this frame's own forward vector turned round stands in. `previous_depth` may be empty. Size of the
/// result: `forward.window()`.
Plane<glm::vec2> invert_forward_motion(const Plane<glm::vec2>& previous_forward, const Plane<float>& previous_depth,
                                       const Plane<glm::vec2>& forward);

/// What else is known of the surface in a pixel; planes that are not there are empty.
struct SurfaceMarks {
  Plane<std::uint32_t> id;
  Plane<glm::vec3> normal;
};

/// Chosen vectors, and the depth and marks of the pixel each came from (empty where there are none).
struct DilatedMotion {
  Plane<glm::vec2> motion;
  Plane<float> depth;
  SurfaceMarks marks;
};

/// 3x3 dilation; reads a border of one pixel, neighbors outside the window do not count. Ties go to the pixel itself,
/// then in reading order. NaN vectors take no part; a pixel whose own vector is NaN takes a neighbor's if there is one.
/// `nearest` needs a depth; where all is background the pixel keeps its own vector.
DilatedMotion dilate_motion(Plane<glm::vec2> motion, const Plane<float>& depth, Dilation dilation, Workers& workers,
                            SurfaceMarks marks = {});

}  // namespace varve
