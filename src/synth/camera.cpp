#include "synth/camera.h"

#include <cmath>

#include <glm/matrix.hpp>

namespace varve::synth {
namespace {

constexpr double kNear = 1;  // of the depth in world_to_ndc

Matrix row_major(const glm::dmat4& column_vectors) {
  Matrix m;
  // Transposed for row vectors and stored by rows, which is how glm stores the untransposed one by columns.
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m.values[4 * c + r] = column_vectors[c][r];
  return m;
}

glm::dmat4 to_camera(const Camera& camera) {
  const Pose view = inverse(camera.pose);
  glm::dmat4 m(view.rotation);
  m[3] = glm::dvec4(view.position, 1);
  return m;
}

}  // namespace

Pose operator*(const Pose& outer, const Pose& inner) {
  return {outer.rotation * inner.position + outer.position, outer.rotation * inner.rotation};
}

Pose inverse(const Pose& pose) {
  const glm::dmat3 back = glm::transpose(pose.rotation);
  return {-(back * pose.position), back};
}

glm::dmat3 turned_x(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {{1, 0, 0}, {0, c, s}, {0, -s, c}};
}

glm::dmat3 turned_y(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}

glm::dmat3 turned_z(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

glm::dmat3 lens_of(const Camera& camera, int width, int height) {
  const double scale = width / 320.0, f = camera.focal * scale;
  return {{f, 0, 0}, {0, f, 0}, {0.5 * width + camera.shift.x * scale, 0.5 * height + camera.shift.y * scale, 1}};
}

Matrix world_to_camera(const Camera& camera) {
  glm::dmat4 up(1);
  up[1][1] = -1;
  return row_major(up * to_camera(camera));
}

Matrix world_to_ndc(const Camera& camera, int width, int height) {
  const glm::dmat3 lens = lens_of(camera, width, height);
  glm::dmat4 m(0);
  m[0][0] = lens[0][0] / width;
  m[1][1] = lens[1][1] / height;
  m[2] = {lens[2][0] / width, lens[2][1] / height, 1, 1};
  m[3][2] = -kNear;
  return row_major(m * to_camera(camera));
}

Matrix opengl_view(const Camera& camera) {
  glm::dmat4 flip(1);
  flip[1][1] = flip[2][2] = -1;
  return row_major(glm::transpose(flip * to_camera(camera)));
}

Matrix opengl_projection(const Camera& camera, int width, int height) {
  const glm::dmat3 lens = lens_of(camera, width, height);
  glm::dmat4 m(0);
  m[0][0] = 2 * lens[0][0] / width;
  m[1][1] = 2 * lens[1][1] / height;
  m[2] = {1 - 2 * lens[2][0] / width, 2 * lens[2][1] / height - 1, -1, -1};
  m[3][2] = -2 * kNear;
  return row_major(glm::transpose(m));
}

}  // namespace varve::synth
