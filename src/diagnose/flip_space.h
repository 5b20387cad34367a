// The color spaces FLIP works in: linear RGB, YCxCz for the filters, CIELAB with Hunt's effect for differences.
#pragma once

#include <glm/vec3.hpp>

namespace varve {

/// Linear Rec. 709 to YCxCz: Y = 116 y - 16, Cx = 500 (x - y), Cz = 200 (y - z) of XYZ over the white of D65.
glm::vec3 ycxcz_of(const glm::vec3& rgb);
/// Back to linear RGB, not clamped.
glm::vec3 rgb_of_ycxcz(const glm::vec3& ycxcz);
/// CIELAB whose a and b are weighted by 0.01 L.
glm::vec3 hunt_lab(const glm::vec3& rgb);
/// (|dL| + length of (da, db)) ^ 0.7.
float hyab_power(const glm::vec3& p, const glm::vec3& q);
/// The luminance y of linear RGB, in FLIP's primaries.
float flip_luminance(const glm::vec3& rgb);

}  // namespace varve
