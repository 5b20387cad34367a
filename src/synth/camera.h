// Where things are and how they are seen, as functions of time.
// World axes: x right, y down, z away from the viewer. One unit seen from a distance of 320 is one pixel of a picture
// 320 pixels wide. Time counts frames: frame 1 is rendered at time 1.
#pragma once

#include <functional>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace varve::synth {

/// A rigid place: world = rotation * local + position.
struct Pose {
  glm::dvec3 position{0};
  glm::dmat3 rotation{1};
};
using Motion = std::function<Pose(double time)>;

/// The place `outer` of the place `inner`.
Pose operator*(const Pose& outer, const Pose& inner);
Pose inverse(const Pose& pose);

/// Rotation by `radians` about an axis of the world; positive turns x to y, y to z, z to x.
glm::dmat3 turned_x(double radians);
glm::dmat3 turned_y(double radians);
glm::dmat3 turned_z(double radians);

/// A pinhole camera; it looks along its local z.
struct Camera {
  Pose pose;
  double focal = 320;   ///< pixels, for a picture 320 pixels wide
  glm::dvec2 shift{0};  ///< of the lens: what lies ahead is seen so many pixels from the middle, likewise
};
using CameraMotion = std::function<Camera(double time)>;

/// Camera coordinates to pixels (x right, y down): pixel = lens * (camera point), divided by its z.
glm::dmat3 lens_of(const Camera& camera, int width, int height);

/// Row-major 4x4 for row vectors, as the OpenEXR standard attributes have them.
struct Matrix {
  double values[16];
};
/// Camera space of OpenEXR: left-handed, x right, y up, z along the view.
Matrix world_to_camera(const Camera& camera);
/// Display window as (0, 0) top left to (1, 1) bottom right; z runs from 0 near to 1 far away.
Matrix world_to_ndc(const Camera& camera, int width, int height);

/// OpenGL's: row-major 4x4 for column vectors; the camera looks along -z, y up; clip space from -1 to 1.
Matrix opengl_view(const Camera& camera);
Matrix opengl_projection(const Camera& camera, int width, int height);

}  // namespace varve::synth
