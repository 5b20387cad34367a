// Motion of the camera and of things, all of it in the vectors.
#include <cmath>

#include "synth/build.h"
#include "synth/scenes.h"

namespace varve::synth {
namespace {

// Detail of every size between a tenth of a pixel and ten.
void add_detail(Shot& shot) {
  shot.surfaces.push_back(wall(480, bricks(24)));
  shot.surfaces.push_back(disc("zone plate", 88, {Pattern::zone_plate, {0.95, 0.95, 0.95}, {0.03, 0.03, 0.03}, 110},
                               rests({-110, -20, 479})));
  shot.surfaces.push_back(rectangle(
      "fine checker", 60, 60, {Pattern::checker, {0.9, 0.9, 0.9}, {0.05, 0.05, 0.05}, 2.3}, rests({30, -40, 478})));
  shot.surfaces.push_back(
      rectangle("noise", 60, 60, noise({0.9, 0.8, 0.5}, {0.05, 0.1, 0.2}, 12, 7), rests({165, -40, 478})));
  shot.surfaces.push_back(ground(70, {Pattern::checker, {0.75, 0.73, 0.7}, {0.06, 0.07, 0.1}, 20}));
}

Scene detail(CameraMotion camera) {
  Scene scene = one_shot(std::move(camera));
  add_detail(scene.shots[0]);
  return finished(std::move(scene));
}

Surface fence_at(double distance, double pitch, double width, const Motion& motion) {
  Surface s = rectangle("fence", 150, 70, {Pattern::plain, {0.95, 0.95, 0.9}}, motion);
  s.outline = Outline::bars;
  s.bar_pitch = pitch * distance / 320;
  s.bar_width = width * distance / 320;
  return s;
}

}  // namespace

Scene still_scene() { return detail(camera_rests()); }

Scene pan_scene() {
  return detail([](double time) { return Camera{{{4.3 * (time - 24), 0.7 * (time - 24), 0}}, 320}; });
}

Scene zoom_scene() {
  return detail([](double time) { return Camera{{}, 320 * std::exp2((time - 24) / 40)}; });
}

Scene zoom_lacking_scene() {
  Scene scene = zoom_scene();
  for (Surface& surface : scene.shots[0].surfaces) surface.vectors = Vectors::lensless;
  return finished(std::move(scene));
}

Scene shift_lacking_scene() {
  Scene scene = detail([](double time) {
    return Camera{{{1.7 * (time - 24), 0, 0}}, 320, {2.1 * (time - 24), -0.6 * (time - 24)}};
  });
  for (Surface& surface : scene.shots[0].surfaces) surface.vectors = Vectors::lensless;
  return finished(std::move(scene));
}

Scene rotation_scene() {
  return detail([](double time) { return Camera{{{0, 0, 0}, turned_z(1.1 * kDegree * (time - 24))}, 320}; });
}

Scene fence_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, noise({0.25, 0.3, 0.4}, {0.02, 0.03, 0.05}, 60, 2)));
  shot.surfaces.push_back(fence_at(500, 6, 0.3, moves({0, -60, 500}, {0.31, 0, 0})));
  shot.surfaces.push_back(fence_at(320, 9, 0.2, [](double time) {
    return Pose{{0, 40, 320}, turned_z(8 * kDegree + 0.05 * kDegree * time)};
  }));
  shot.surfaces.push_back(rectangle("power line", 400, 0.12, {Pattern::plain, {1, 1, 0.9}}, [](double time) {
    return Pose{{0, -60 + 0.13 * time, 300}, turned_z(-3 * kDegree)};
  }));
  return finished(std::move(scene));
}

Scene zone_plate_scene() {
  Scene scene = one_shot();
  scene.shots[0].surfaces.push_back(rectangle(
      "zone plate", 1000, 1000, {Pattern::zone_plate, {1, 1, 1}, {0, 0, 0}, 100}, moves({0, 0, 320}, {0.37, 0.21, 0})));
  return finished(std::move(scene));
}

Scene crossing_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  const Texture squares{Pattern::checker, {0.85, 0.2, 0.15}, {0.95, 0.9, 0.8}, 7};
  const Texture dots{Pattern::spots, {0.2, 0.5, 0.7}, {0.95, 0.95, 0.6}, 9, 4};
  const auto add = [&](Surface s, Layer layer) {
    s.layer = layer;
    shot.surfaces.push_back(std::move(s));
  };
  add(rectangle("slow", 60, 44, dots, moves({0, -40, 480}, {1.95, 0, 0})), Layer::middle);
  add(rectangle("opposite", 44, 60, squares, moves({0, 30, 440}, {-5.5, 0, 0})), Layer::middle);
  add(disc("fast", 26, dots, moves({0, 0, 320}, {7.3, 0.8, 0})), Layer::foreground);
  add(rectangle("falling", 18, 18, squares, moves({-40, 0, 300}, {0, 4.1, 0})), Layer::foreground);
  return finished(std::move(scene));
}

Scene reversal_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  const Texture squares{Pattern::checker, {0.85, 0.2, 0.15}, {0.95, 0.9, 0.8}, 7};
  shot.surfaces.push_back(rectangle("back and forth", 30, 30, squares, turns_back({60, -50, 360}, {5, 0, 0})));
  shot.surfaces.push_back(
      disc("pendulum", 26, {Pattern::spots, {0.2, 0.5, 0.7}, {0.95, 0.95, 0.6}, 9, 4}, [](double time) {
        return Pose{{90 * std::sin(time * 0.35), 45, 340}};
      }));
  return finished(std::move(scene));
}

Scene teleport_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  const Texture squares{Pattern::checker, {0.85, 0.2, 0.15}, {0.95, 0.9, 0.8}, 7};
  shot.surfaces.push_back(rectangle("jumper", 30, 30, squares, [](double time) {
    const double leap = std::floor((time - 1) / 12);  // in frames 13, 25 and 37
    const double side = std::fmod(std::abs(leap), 2) == 0 ? -80 : 80;
    return Pose{{side + 0.4 * time, 20 * std::fmod(std::abs(leap), 3) - 20, 320}};
  }));
  return finished(std::move(scene));
}

Scene cut_scene() {
  Scene scene = detail([](double time) { return Camera{{{2 * (time - 12), 0, 0}}, 320}; });
  Scene second = crossing_scene();
  for (Surface& s : second.shots[0].surfaces) s.layer = Layer::background;
  second.shots[0].first_frame = 25;
  scene.shots.push_back(std::move(second.shots[0]));
  return finished(std::move(scene));
}

Scene sky_scene() {
  Scene scene = one_shot([](double time) { return Camera{{{0, 0, 0}, turned_y(0.8 * kDegree * (time - 24))}, 320}; });
  Shot& shot = scene.shots[0];
  Surface sky = rectangle("sky", 320, 320, noise({0.9, 0.95, 1.1}, {0.1, 0.25, 0.7}, 34, 9), rests({0, 0, 0}));
  sky.outline = Outline::sky;
  shot.surfaces.push_back(sky);
  shot.surfaces.push_back(ground(90, {Pattern::checker, {0.35, 0.5, 0.2}, {0.1, 0.2, 0.06}, 40}));
  for (int i = -6; i <= 6; ++i)
    shot.surfaces.push_back(rectangle("tower", 12, 60, bricks(9), rests({70.0 * i, 35, 420 + 25.0 * (i & 3)})));
  return finished(std::move(scene));
}

Scene sky_zero_scene() {
  Scene scene = sky_scene();
  scene.shots[0].surfaces[0].vectors = Vectors::none;
  return finished(std::move(scene));
}

}  // namespace varve::synth
