#include "synth/build.h"

namespace varve::synth {

Surface rectangle(const std::string& name, double half_width, double half_height, const Texture& texture,
                  Motion motion) {
  Surface surface;
  surface.name = name;
  surface.half_width = half_width;
  surface.half_height = half_height;
  surface.texture = texture;
  surface.motion = std::move(motion);
  return surface;
}

Surface disc(const std::string& name, double radius, const Texture& texture, Motion motion) {
  Surface surface = rectangle(name, radius, radius, texture, std::move(motion));
  surface.outline = Outline::disc;
  return surface;
}

Surface ball(const std::string& name, double radius, const Texture& texture, Motion motion) {
  Surface surface = rectangle(name, radius, radius, texture, std::move(motion));
  surface.outline = Outline::sphere;
  surface.lit = true;
  return surface;
}

Surface wall(double distance, const Texture& texture) {
  return rectangle("wall", 4000, 4000, texture, rests({0, 0, distance}));
}

Surface ground(double below, const Texture& texture) {
  return rectangle("floor", 8000, 8000, texture, [below](double) {
    return Pose{{0, below, 0}, turned_x(90 * kDegree)};
  });
}

Texture bricks(double size) { return {Pattern::bricks, {0.62, 0.27, 0.18}, {0.55, 0.52, 0.48}, size, 11}; }

Texture noise(glm::dvec3 first, glm::dvec3 second, double size, std::uint64_t seed) {
  return {Pattern::value_noise, first, second, size, seed};
}

Scene one_shot(CameraMotion camera) {
  Scene scene;
  scene.shots.resize(1);
  scene.shots[0].camera = std::move(camera);
  return scene;
}

Scene finished(Scene scene) {
  unsigned id = 0;
  for (Shot& shot : scene.shots)
    for (Surface& surface : shot.surfaces) {
      surface.id = ++id;
      scene.right_vectors = scene.right_vectors && surface.vectors == Vectors::own;
    }
  return scene;
}

}  // namespace varve::synth
