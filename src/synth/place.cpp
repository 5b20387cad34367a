// Scene to moment: every transform a frame needs, once.
#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "synth/moment.h"

namespace varve::synth {
namespace {

/// A camera at one time.
struct View {
  Pose to_camera;
  glm::dmat3 lens;
};

View view_at(const Shot& shot, double time, int width, int height) {
  const Camera camera = shot.camera(time);
  return {inverse(camera.pose), lens_of(camera, width, height)};
}

/// Local coordinates to homogeneous pixels.
struct Way {
  glm::dmat3 matrix;
  glm::dvec3 offset;
  bool operator==(const Way&) const = default;
};

// Where a point with these local coordinates lies in the picture of some frame, as the vectors have it.
Way way_to(const Surface& surface, View view, const glm::dmat3& lens_now, double now, double then) {
  if (surface.vectors == Vectors::lensless) view.lens = lens_now;
  Pose place = surface.motion(surface.vectors == Vectors::carrier ? now : then);
  if (surface.vectors == Vectors::carrier && surface.carrier && now != then)
    place = surface.carrier(then) * inverse(surface.carrier(now)) * place;
  const Pose local_to_camera = view.to_camera * place;
  return {view.lens * local_to_camera.rotation,
          surface.outline == Outline::sky ? glm::dvec3(0) : view.lens * local_to_camera.position};
}

glm::dvec4 bounds_of(const Surface& surface, const Pose& local_to_camera, const glm::dmat3& lens) {
  glm::dvec4 box{1e30, 1e30, -1e30, -1e30};
  const bool sphere = surface.outline == Outline::sphere, disc = surface.outline == Outline::disc;
  const double w = surface.half_width + surface.sway.amplitude, h = sphere || disc ? w : surface.half_height;
  for (int corner = 0; corner < 8; ++corner) {
    // The corners of a cube around a sphere hold its outline too.
    const glm::dvec3 local{corner & 1 ? w : -w, corner & 2 ? h : -h, !sphere ? 0 : corner & 4 ? w : -w};
    const glm::dvec3 pixel = lens * (local_to_camera.rotation * local + local_to_camera.position);
    if (!(pixel.z > 1e-3) || surface.outline == Outline::sky) return {-1e30, -1e30, 1e30, 1e30};
    box = {std::min(box.x, pixel.x / pixel.z), std::min(box.y, pixel.y / pixel.z), std::max(box.z, pixel.x / pixel.z),
           std::max(box.w, pixel.y / pixel.z)};
  }
  return box + glm::dvec4(-0.01, -0.01, 0.01, 0.01);
}

PlacedSurface place(const Surface& surface, const Moment& moment, const View& now, const View& before,
                    const View& after) {
  PlacedSurface placed;
  placed.surface = &surface;
  const Pose local_to_camera = now.to_camera * surface.motion(moment.time);
  placed.rotation = local_to_camera.rotation;
  placed.center = local_to_camera.position;
  const glm::dmat3& r = local_to_camera.rotation;
  if (surface.outline == Outline::sphere)
    placed.to_local = glm::transpose(r);
  else if (surface.outline == Outline::sky)
    placed.to_local = glm::transpose(r) * moment.to_ray;
  else
    placed.to_local = glm::inverse(glm::dmat3(r[0], r[1], local_to_camera.position)) * moment.to_ray;
  placed.bounds = bounds_of(surface, local_to_camera, now.lens);
  const double time = moment.time;
  const Way here = way_to(surface, now, now.lens, time, time), from = way_to(surface, before, now.lens, time, time - 1),
            to = way_to(surface, after, now.lens, time, time + 1);
  const bool sways = surface.sway.amplitude != 0 && surface.vectors != Vectors::carrier;
  placed.before = from.matrix;
  placed.before_offset = from.offset;
  placed.rests_before = !sways && from == here;
  placed.after = to.matrix;
  placed.after_offset = to.offset;
  placed.rests_after = !sways && to == here;
  placed.brightness = surface.brightness ? surface.brightness(moment.time) : 1;
  return placed;
}

}  // namespace

const Shot& shot_of(const Scene& scene, int frame) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < scene.shots.size(); ++i)
    if (scene.shots[i].first_frame <= frame) found = i;
  return scene.shots.at(found);
}

Moment moment_of(const Scene& scene, int frame, int width, int height, std::optional<Layer> layer) {
  const Shot& shot = shot_of(scene, frame);
  Moment moment;
  moment.time = frame;
  moment.camera = shot.camera(moment.time);
  const View now = view_at(shot, moment.time, width, height), before = view_at(shot, moment.time - 1, width, height),
             after = view_at(shot, moment.time + 1, width, height);
  moment.to_ray = glm::inverse(now.lens);
  moment.to_world = moment.camera.pose.rotation;
  for (const Surface& surface : shot.surfaces)
    if (!layer || surface.layer == *layer) moment.surfaces.push_back(place(surface, moment, now, before, after));
  for (const Spot& spot : shot.spots) {
    const double amount = spot.amount(moment.time);
    const glm::dvec3 center = now.to_camera.rotation * spot.center(moment.time) + now.to_camera.position;
    if (amount != 0) moment.spots.push_back({center, 1.0 / spot.radii, amount});
  }
  return moment;
}

}  // namespace varve::synth
