// Vectors that are wrong in the ways Wronski ("Temporal supersampling and antialiasing", 2014) met in production.
#include <cmath>

#include "synth/build.h"
#include "synth/scenes.h"

namespace varve::synth {
namespace {

Texture cloth_paint() { return {Pattern::checker, {0.75, 0.12, 0.15}, {0.95, 0.9, 0.85}, 8}; }

}  // namespace

// A banner that ripples; its vectors are those of the pole that carries it.
Scene cloth_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  const Motion pole = moves({0, 0, 320}, {0.9, 0, 0});
  shot.surfaces.push_back(
      rectangle("pole", 100, 3, {Pattern::stripes, {0.4, 0.3, 0.2}, {0.7, 0.6, 0.4}, 9}, [pole](double time) {
        return pole(time) * Pose{{0, -62, 0}};
      }));
  Surface banner = rectangle("banner", 80, 55, cloth_paint(), pole);
  banner.sway = {9, 0.09, 0.45, false};
  banner.vectors = Vectors::carrier;
  banner.carrier = pole;
  shot.surfaces.push_back(banner);
  return finished(std::move(scene));
}

// Blades that sway in the vertex program; their vectors are zero although the camera moves too.
Scene vegetation_scene() {
  Scene scene = one_shot([](double time) { return Camera{{{0.8 * (time - 24), 0, 0}}, 320}; });
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, noise({0.5, 0.6, 0.8}, {0.3, 0.4, 0.6}, 80, 2)));
  shot.surfaces.push_back(ground(75, {Pattern::checker, {0.3, 0.25, 0.15}, {0.15, 0.12, 0.08}, 20}));
  for (int row = 0; row < 4; ++row) {
    Surface blades =
        rectangle("blades", 260, 38, noise({0.35, 0.6, 0.15}, {0.08, 0.2, 0.04}, 5, 20 + std::uint64_t(row)),
                  rests({1.7 * row, 42, 420 - 45.0 * row}));
    blades.outline = Outline::bars;
    blades.bar_pitch = 5;
    blades.bar_width = 1.6;
    blades.sway = {14, 0.02, 0.23 + 0.06 * row, true};
    blades.vectors = Vectors::none;
    shot.surfaces.push_back(blades);
  }
  return finished(std::move(scene));
}

// Water that is not in the vector and depth buffers: they hold the ground below.
Scene ocean_scene() {
  Scene scene = one_shot([](double time) { return Camera{{{1.6 * (time - 24), 0, 0}}, 320}; });
  Shot& shot = scene.shots[0];
  Surface sky = rectangle("sky", 320, 320, noise({0.8, 0.85, 0.95}, {0.35, 0.5, 0.8}, 60, 9), rests({0, 0, 0}));
  sky.outline = Outline::sky;
  shot.surfaces.push_back(sky);
  shot.surfaces.push_back(ground(130, {Pattern::spots, {0.6, 0.5, 0.3}, {0.35, 0.3, 0.2}, 24, 6}));
  Surface water = ground(70, noise({0.25, 0.5, 0.6}, {0.02, 0.1, 0.2}, 22, 8));
  water.name = "water";
  water.motion = [](double time) { return Pose{{-3.0 * time, 70, -2.0 * time}, turned_x(90 * kDegree)}; };
  water.opacity = 0.85;
  water.vectors = Vectors::below;
  shot.surfaces.push_back(water);
  return finished(std::move(scene));
}

// A propeller with a matrix of its own whose last value is not kept: its vectors know the camera only.
Scene matrix_scene() {
  Scene scene = one_shot([](double time) { return Camera{{{1.2 * (time - 24), 0, 0}}, 320}; });
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  for (int blade = 0; blade < 3; ++blade) {
    Surface s =
        rectangle("blade", 70, 9, {Pattern::checker, {0.9, 0.8, 0.2}, {0.15, 0.15, 0.15}, 9}, [blade](double time) {
          return Pose{{0, 0, 320.0 - blade}, turned_z((4.0 * time + 60.0 * blade) * kDegree)};
        });
    s.vectors = Vectors::carrier;
    shot.surfaces.push_back(s);
  }
  return finished(std::move(scene));
}

// A walker whose root jumps while its skin is blended as if it had not: the vectors lack the jump, and only that.
Scene skinned_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  const Motion walk = moves({0, 0, 320}, {1.1, 0, 0});
  Surface walker = rectangle("walker", 24, 50, cloth_paint(), [walk](double time) {
    const double leap = std::floor((time - 1) / 12);  // in frames 13, 25 and 37
    return Pose{{std::fmod(std::abs(leap), 2) == 0 ? -70 : 70, 0, 0}} * walk(time);
  });
  walker.vectors = Vectors::carrier;
  walker.carrier = walk;
  shot.surfaces.push_back(walker);
  return finished(std::move(scene));
}

}  // namespace varve::synth
