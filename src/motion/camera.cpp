#include "motion/camera.h"

#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

namespace varve {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Through a pixel: the camera point is this ray times the depth (perspective), or this with the depth as its z.
glm::dvec2 on_film(glm::dvec2 pixel, const Camera& camera) { return (pixel - camera.center) / camera.focal; }

bool same_lens(const Camera& a, const Camera& b) {
  return a.projection == b.projection && a.focal == b.focal && a.center == b.center;
}

}  // namespace

CameraChange change_between(const Camera& from, const Camera& to) {
  CameraChange change{from, to};
  const glm::dmat3 turn_from(from.to_camera), turn_to(to.to_camera);
  change.lens_rests = same_lens(from, to);
  change.rests = from == to;
  change.sky_rests = change.lens_rests && turn_from == turn_to;
  // Where nothing turns, no rounding of an inverse may turn it.
  if (turn_from != turn_to) change.turn = turn_to * glm::inverse(turn_from);
  change.shift = glm::dvec3(to.to_camera[3]) - change.turn * glm::dvec3(from.to_camera[3]);
  return change;
}

SeenPoint reproject(glm::dvec2 pixel, double depth, const CameraChange& change) {
  const SeenPoint nowhere{glm::dvec2(kNaN), kNaN};
  if (!(depth > 0)) return nowhere;
  const bool perspective = change.from.projection == Projection::perspective;
  const bool to_perspective = change.to.projection == Projection::perspective;
  if (std::isinf(depth) && !(perspective && to_perspective)) return nowhere;
  if (change.rests || (change.sky_rests && std::isinf(depth))) return {pixel, depth};
  const glm::dvec2 film = on_film(pixel, change.from);
  SeenPoint seen;
  glm::dvec2 landed;
  if (perspective) {
    // Divided by the depth, so that infinity needs no rule of its own: there the shift counts nothing.
    const glm::dvec3 q = change.turn * glm::dvec3(film, 1) + change.shift / depth;
    if (!(q.z > 0)) return nowhere;
    seen.depth = q.z * depth;
    landed = to_perspective ? glm::dvec2(q) / q.z : glm::dvec2(q) * depth;
  } else {
    const glm::dvec3 q = change.turn * glm::dvec3(film, depth) + change.shift;
    if (!(q.z > 0)) return nowhere;
    seen.depth = q.z;
    landed = to_perspective ? glm::dvec2(q) / q.z : glm::dvec2(q);
  }
  seen.pixel = change.to.center + change.to.focal * landed;
  if (!std::isfinite(seen.pixel.x) || !std::isfinite(seen.pixel.y)) return nowhere;
  return seen;
}

SeenPoint reproject(glm::dvec2 pixel, double depth, const Camera& from, const Camera& to) {
  return reproject(pixel, depth, change_between(from, to));
}

glm::dvec2 through_lens(glm::dvec2 pixel, const Camera& from, const Camera& to) {
  if (same_lens(from, to)) return pixel;
  return to.center + to.focal * on_film(pixel, from);
}

Plane<glm::vec2> camera_motion(const Plane<float>& depth, glm::dvec2 jitter, const CameraChange& change,
                               double max_length, Workers& workers) {
  const Window& window = depth.window();
  Plane<glm::vec2> motion(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    const float* z = depth.row(y);
    glm::vec2* row = motion.row(y);
    for (int i = 0; i < window.width(); ++i) {
      const glm::dvec2 pixel = glm::dvec2(window.x0 + i, y) + 0.5 + jitter;
      const glm::dvec2 way = reproject(pixel, double(z[i]), change).pixel - pixel;
      const bool usable = way.x * way.x + way.y * way.y <= max_length * max_length;
      row[i] = usable ? glm::vec2(way) : glm::vec2(std::numeric_limits<float>::quiet_NaN());
    }
  });
  return motion;
}

void ray_to_planar_depth(Plane<float>& depth, glm::dvec2 jitter, const Camera& camera, Workers& workers) {
  if (camera.projection == Projection::orthographic) return;
  const Window& window = depth.window();
  workers.for_rows(window.y0, window.y1, [&](int y) {
    float* z = depth.row(y);
    for (int i = 0; i < window.width(); ++i) {
      const glm::dvec2 film = on_film(glm::dvec2(window.x0 + i, y) + 0.5 + jitter, camera);
      z[i] = float(double(z[i]) / std::sqrt(1 + film.x * film.x + film.y * film.y));
    }
  });
}

}  // namespace varve
