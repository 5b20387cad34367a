#include "exr/camera_matrices.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace varve {
namespace {

// Matrices come as floats or as text of seven digits, and are multiplied and inverted.
constexpr double kShear = 1e-3, kOffAxis = 1e-4;

MadeCamera none(const std::string& problem) { return {std::nullopt, problem}; }

bool all_finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
}

bool all_finite(const glm::dmat4& m) { return all_finite({&m[0][0], 16}); }

// For row vectors and by rows, which is how glm stores the transposed one.
glm::dmat4 from_row_vectors(std::span<const double> numbers) {
  glm::dmat4 m(0);
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[std::size_t(i)];
  return m;
}

glm::dmat4 from_column_vectors(std::span<const double> numbers) { return glm::transpose(from_row_vectors(numbers)); }

glm::dmat4 scaling(double x, double y, double z) {
  glm::dmat4 m(1);
  m[0][0] = x, m[1][1] = y, m[2][2] = z;
  return m;
}

// -1..1 with y up to 0..1 with y down.
glm::dmat4 clip_to_picture() {
  glm::dmat4 m(1);
  m[0][0] = 0.5, m[1][1] = -0.5;
  m[3][0] = 0.5, m[3][1] = 0.5;
  return m;
}

glm::dvec4 row(const glm::dmat4& m, int r) { return {m[0][r], m[1][r], m[2][r], m[3][r]}; }

bool is_affine(const glm::dmat4& m) {
  const glm::dvec4 last = row(m, 3);
  return glm::length(glm::dvec3(last)) <= 1e-6 && std::abs(last.w - 1) <= 1e-5;
}

// RenderMan's older files, and those of writers that take NDC for OpenGL's, have the middle at 0.
bool spans_two(glm::dvec2 center) { return std::abs(center.x) < 0.25 && std::abs(center.y) < 0.25; }
constexpr const char* kSpansTwo = "worldToNDC is taken to span -1 to 1 with y up, since its middle is 0";

/// Scale of the rotation in `m`; 0 where it is singular, sheared or scaled differently along its axes.
double uniform_scale(const glm::dmat4& m) {
  const glm::dmat3 r(m), gram = glm::transpose(r) * r;
  const double square = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(gram[i][k] - (i == k ? square : 0)) <= kShear * square)) return 0;
  return square > 1e-24 && square < 1e24 ? std::sqrt(square) : 0;
}

/// Where the view axis meets the picture, and what a unit beside it at distance 1 makes there.
struct Lens {
  Projection projection = Projection::perspective;
  glm::dvec2 focal{0}, center{0};
  bool backwards = false;  ///< what lies ahead has negative z
  bool straight = false;   ///< nothing else is in the matrix
};

Lens lens_of(const glm::dmat4& to_picture, double far) {
  const glm::dvec4 w = row(to_picture, 3);
  Lens lens;
  const double across = std::abs(w.x) + std::abs(w.y);
  const bool flat = across + std::abs(w.z) <= 1e-9 * std::abs(w.w);
  lens.projection = flat ? Projection::orthographic : Projection::perspective;
  lens.backwards = !flat && w.z < 0;
  const double unit = flat ? w.w : w.z;
  lens.straight = flat || (across <= kOffAxis * std::abs(w.z) && std::abs(w.w) <= kOffAxis * far * std::abs(w.z));
  for (int k = 0; k < 2; ++k) {
    const glm::dvec4 r = row(to_picture, k) / unit;
    lens.focal[k] = lens.backwards ? -r[k] : r[k];
    lens.center[k] = flat ? r.w : r.z;
    const double rest = flat ? std::abs(r.z) : std::abs(r.w) / far;
    lens.straight = lens.straight && std::abs(r[1 - k]) + rest <= kOffAxis * std::abs(r[k]);
  }
  return lens;
}

/// A perspective camera from worldToNDC alone: the axis along which w grows is the view.
MadeCamera camera_of_picture(const glm::dmat4& to_picture, const Window& display) {
  const glm::dvec4 w = row(to_picture, 3);
  const double length = glm::length(glm::dvec3(w));
  if (!(length > 1e-9 * std::abs(w.w)))
    return none("worldToNDC is orthographic, which tells no depth without worldToCamera");
  glm::dmat4 to_camera(1);
  const glm::dvec4 view = w / length;
  const auto set_row = [&](int r, const glm::dvec4& value) {
    for (int c = 0; c < 4; ++c) to_camera[c][r] = value[c];
  };
  set_row(2, view);
  glm::dmat4 picture(1);
  picture[3][3] = 0;
  picture[2][3] = 1;
  for (int k = 0; k < 2; ++k) {
    const glm::dvec4 r = row(to_picture, k) / length;
    const double center = glm::dot(glm::dvec3(r), glm::dvec3(view));
    const glm::dvec4 aside = r - center * view;
    const double focal = glm::length(glm::dvec3(aside));
    if (!(focal > 0)) return none("worldToNDC is singular");
    set_row(k, aside / focal);
    picture[k][k] = focal;
    picture[2][k] = center;
  }
  return make_camera(to_camera, picture, display);
}

}  // namespace

MadeCamera make_camera(glm::dmat4 to_camera, glm::dmat4 to_picture, const Window& display) {
  if (!all_finite(to_camera) || !all_finite(to_picture)) return none("the matrices hold numbers that are not finite");
  if (!is_affine(to_camera)) {
    const bool turned = is_affine(glm::transpose(to_camera));
    return none(std::string("the world-to-camera matrix is not affine") + (turned ? "; it looks transposed" : ""));
  }
  const double scale = uniform_scale(to_camera);
  if (!(scale > 0)) return none("the world-to-camera matrix is singular or sheared");
  MadeCamera made;
  if (std::abs(scale - 1) > kShear) made.problem = "the scale of the world-to-camera matrix is taken out";
  to_camera = scaling(1 / scale, 1 / scale, 1 / scale) * to_camera;
  for (int c = 0; c < 4; ++c) to_camera[c][3] = c == 3;
  to_picture = to_picture * scaling(scale, scale, scale);

  const double far = 1 + glm::length(glm::dvec3(to_camera[3]));
  const Lens lens = lens_of(to_picture, far);
  if (!lens.straight) return none("the projection does not belong to the world-to-camera matrix, or is sheared");
  Camera camera;
  camera.projection = lens.projection;
  camera.to_camera = lens.backwards ? scaling(1, 1, -1) * to_camera : to_camera;
  const glm::dvec2 size(display.width(), display.height());
  camera.focal = lens.focal * size;
  camera.center = glm::dvec2(display.x0, display.y0) + lens.center * size;
  const auto sane = [](double focal, double center) {
    return std::abs(focal) > 1e-6 && std::abs(focal) < 1e12 && std::abs(center) < 1e9;
  };
  if (!sane(camera.focal.x, camera.center.x) || !sane(camera.focal.y, camera.center.y))
    return none("the projection is singular or out of all bounds");
  made.camera = camera;
  return made;
}

MadeCamera camera_from_attributes(std::span<const double> world_to_camera, std::span<const double> world_to_ndc,
                                  const Window& display) {
  if (!all_finite(world_to_camera) || !all_finite(world_to_ndc))
    return none("the matrices hold numbers that are not finite");
  if (world_to_ndc.empty()) return none("worldToCamera alone tells no focal length; worldToNDC is missing");
  const glm::dmat4 to_picture = from_row_vectors(world_to_ndc);
  if (world_to_camera.empty()) {
    const glm::dvec4 w = row(to_picture, 3);
    const glm::dvec3 axis(w);
    const double square = glm::dot(axis, axis);
    const glm::dvec2 middle(glm::dot(glm::dvec3(row(to_picture, 0)), axis) / square,
                            glm::dot(glm::dvec3(row(to_picture, 1)), axis) / square);
    const bool twice = spans_two(middle);
    MadeCamera made = camera_of_picture(twice ? clip_to_picture() * to_picture : to_picture, display);
    if (twice && made.camera) made.problem = kSpansTwo;
    return made;
  }

  const glm::dmat4 view = from_row_vectors(world_to_camera);
  if (!is_affine(view) || !(uniform_scale(view) > 0)) return make_camera(view, glm::dmat4(1), display);
  const glm::dmat4 to_camera = scaling(1, -1, 1) * view;
  const glm::dmat4 camera_to_picture = to_picture * glm::inverse(to_camera);
  const Lens lens = lens_of(camera_to_picture, 1 + glm::length(glm::dvec3(to_camera[3])));
  const bool twice = spans_two(lens.center);
  MadeCamera made = make_camera(to_camera, twice ? clip_to_picture() * camera_to_picture : camera_to_picture, display);
  if (!made.camera) return made;
  if (!(made.camera->focal.x > 0 && made.camera->focal.y > 0))
    return none("worldToCamera and worldToNDC contradict each other: one of them mirrors the picture");
  if (twice) made.problem = kSpansTwo;
  return made;
}

MadeCamera camera_from_opengl(std::span<const double> view, std::span<const double> projection, const Window& display) {
  if (!all_finite(view) || !all_finite(projection)) return none("the matrices hold numbers that are not finite");
  const glm::dmat4 flip = scaling(1, -1, -1);
  return make_camera(flip * from_column_vectors(view), clip_to_picture() * from_column_vectors(projection) * flip,
                     display);
}

MadeCamera camera_from_film(std::span<const double> view, double focal, double aperture, double pixel_aspect,
                            const Window& display) {
  const double wide = focal / aperture;
  if (!all_finite(view) || !(wide > 0) || !std::isfinite(wide))
    return none("focal and aperture must be above 0, and the matrix finite");
  glm::dmat4 to_picture(0);
  to_picture[0][0] = wide;
  to_picture[1][1] = wide * pixel_aspect * display.width() / display.height();
  to_picture[2] = {0.5, 0.5, 0, 1};
  return make_camera(scaling(1, -1, -1) * from_column_vectors(view), to_picture, display);
}

}  // namespace varve
