#include "diagnose/flip_space.h"

#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace varve {
namespace {

// Rec. 709 primaries with white D65 as exact fractions. Rows X, Y, Z.
constexpr double kX[3] = {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794};
constexpr double kY[3] = {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897};
constexpr double kZ[3] = {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382};

/// RGB to XYZ divided by the white, so that (1, 1, 1) is (1, 1, 1).
glm::mat3 make_to_xyz() {
  glm::dmat3 m(0.0);
  const double* rows[3] = {kX, kY, kZ};
  for (int r = 0; r < 3; ++r) {
    const double white = rows[r][0] + rows[r][1] + rows[r][2];
    for (int c = 0; c < 3; ++c) m[c][r] = rows[r][c] / white;
  }
  return glm::mat3(m);
}

const glm::mat3 kToXyz = make_to_xyz();
const glm::mat3 kFromXyz = glm::mat3(glm::inverse(glm::dmat3(make_to_xyz())));

/// The curve of CIELAB.
float lab_curve(float t) {
  constexpr float d = 6.f / 29;
  return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.f / 29;
}

}  // namespace

glm::vec3 ycxcz_of(const glm::vec3& rgb) {
  const glm::vec3 xyz = kToXyz * rgb;
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

glm::vec3 rgb_of_ycxcz(const glm::vec3& p) {
  const float y = (p.x + 16) / 116;
  return kFromXyz * glm::vec3(y + p.y / 500, y, y - p.z / 200);
}

glm::vec3 hunt_lab(const glm::vec3& rgb) {
  const glm::vec3 xyz = kToXyz * rgb;
  const float fx = lab_curve(xyz.x), fy = lab_curve(xyz.y), fz = lab_curve(xyz.z);
  const float l = 116 * fy - 16;
  return {l, 0.01f * l * 500 * (fx - fy), 0.01f * l * 200 * (fy - fz)};
}

float hyab_power(const glm::vec3& p, const glm::vec3& q) {
  const glm::vec3 d = p - q;
  return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), 0.7f);
}

float flip_luminance(const glm::vec3& rgb) { return (kToXyz * rgb).y; }

}  // namespace varve
