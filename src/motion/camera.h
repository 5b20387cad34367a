// A camera at one frame, and where what one frame sees lies in the picture of another: motion without vectors.
// Everything in pixels of the display window, y down, without the jitter.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

enum class Projection { perspective, orthographic };

/// Camera space: x right, y down, z along the view, in units of the world. Perspective: pixel = center + focal * (x, y)
/// / z; orthographic: pixel = center + focal * (x, y).
struct Camera {
  Projection projection = Projection::perspective;
  glm::dmat4 to_camera{1};  ///< world to camera, for column vectors; a rotation (or mirror) and a shift
  glm::dvec2 focal{1};      ///< focal length in pixels; orthographic: pixels of one unit; not 0
  glm::dvec2 center{0};     ///< where the view axis meets the picture; a lens shift moves it
  bool operator==(const Camera&) const = default;
};

/// A point as a camera sees it.
struct SeenPoint {
  glm::dvec2 pixel{0};
  double depth = 0;  ///< along the view axis, units of the world; +inf at infinity
};

/// The way from one camera's picture to another's, for any number of points.
struct CameraChange {
  Camera from, to;
  glm::dmat3 turn{1};      ///< camera space of `from` to that of `to`, for column vectors
  glm::dvec3 shift{0};     ///< likewise
  bool rests = true;       ///< the same camera: nothing moves
  bool sky_rests = true;   ///< neither rotation nor lens differ: what is infinitely far away does not move
  bool lens_rests = true;  ///< focal length and center are the same
};
CameraChange change_between(const Camera& from, const Camera& to);

/// Where a point that rests in the world, seen by `change.from` at `pixel` in the planar distance `depth`, lies in the
/// picture of `change.to`; off the picture too. Depth +inf: a direction, infinitely far away. NaN where the depth is
/// not above 0, where the point lies behind the other camera, and for a direction where a camera is orthographic (it
/// sees one direction in every pixel).
SeenPoint reproject(glm::dvec2 pixel, double depth, const CameraChange& change);
SeenPoint reproject(glm::dvec2 pixel, double depth, const Camera& from, const Camera& to);

/// Where a point seen at `pixel` through the lens of `from` is seen through the lens of `to`, the camera being where it
/// is: what zoom and lens shift alone do, whatever the depth. Both must have the same projection.
glm::dvec2 through_lens(glm::dvec2 pixel, const Camera& from, const Camera& to);

/// Motion of what rests in the world: for each pixel of `depth` (planar, +inf: background), its place in the picture of
/// `change.to` minus its place in that of `change.from`. The sample of pixel p lies at p + 0.5 + `jitter`. NaN where
/// reproject() gives NaN, and beyond `max_length` pixels. Exactly 0 where the camera rests.
Plane<glm::vec2> camera_motion(const Plane<float>& depth, glm::dvec2 jitter, const CameraChange& change,
                               double max_length, Workers& workers);

/// Distances along the ray from the eye to distances along the view axis; orthographic: they are the same. Infinity
/// stays.
void ray_to_planar_depth(Plane<float>& depth, glm::dvec2 jitter, const Camera& camera, Workers& workers);

}  // namespace varve
