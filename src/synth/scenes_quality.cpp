// One crowded scene in four variants: everything at rest, the camera moves, the objects move, both. A light pulse and a
// sliding shadow, neither with vectors of its own, are active in all four.
#include <algorithm>
#include <cmath>

#include "synth/build.h"
#include "synth/scenes.h"

namespace varve::synth {
namespace {

// Pan, dolly and roll; 1 to 6 pixels a frame over the picture.
Camera traveling(double time) {
  const double t = time - 24;
  return {{{3.6 * t, -0.15 * t, 1.2 * t}, turned_z(0.12 * kDegree * t)}, 320};
}

// x 2.6 within three frames from frame 19 on, gone nine frames later.
double pulse(double time) {
  const double rise = std::clamp((time - 19) / 3, 0.0, 1.0), fall = std::clamp((31 - time) / 9, 0.0, 1.0);
  return 1.6 * rise * fall;
}

Surface fence() {
  Surface s = rectangle("fence", 42, 34, {Pattern::plain, {0.85, 0.85, 0.8}}, rests({-58, -22, 200}));
  s.outline = Outline::bars;
  s.bar_pitch = 2.6;
  s.bar_width = 0.25;  // 0.3 to 0.5 pixels at this distance
  s.layer = Layer::foreground;
  return s;
}

std::vector<Surface> resting_things() {
  std::vector<Surface> list;
  list.push_back(wall(640, bricks(34)));
  list.push_back(ground(80, {Pattern::checker, {0.71, 0.69, 0.65}, {0.08, 0.09, 0.12}, 26}));
  list.push_back(disc("zone plate", 84, {Pattern::zone_plate, {0.88, 0.88, 0.88}, {0.04, 0.04, 0.04}, 150},
                      rests({-190, -80, 639})));
  list.push_back(fence());
  return list;
}

std::vector<Surface> moving_things() {
  const Texture dots{Pattern::spots, {0.85, 0.75, 0.2}, {0.1, 0.15, 0.5}, 7, 3};
  const Texture lines{Pattern::stripes, {0.9, 0.9, 0.9}, {0.1, 0.3, 0.1}, 3.2};
  const Texture squares{Pattern::checker, {0.8, 0.15, 0.12}, {0.9, 0.85, 0.75}, 4.5};
  const Texture net{Pattern::grid, {0.15, 0.45, 0.6}, {0.95, 0.95, 0.9}, 6};
  std::vector<Surface> list;
  // Pixels a frame = units a frame * 320 / distance.
  list.push_back(disc("disc 0.35", 26, dots, moves({90, -50, 480}, {0.525, 0, 0})));
  list.push_back(rectangle("box 0.5", 22, 18, net, moves({-20, -48, 450}, {0, 0.703, 0})));
  list.push_back(disc("disc 1.7", 22, squares, moves({30, 8, 420}, {-2.23, 0.1, 0})));
  list.push_back(rectangle("box 3.3", 17, 15, lines, turns_back({110, 34, 380}, {3.92, 0, 0})));
  list.push_back(rectangle("box 6", 15, 20, dots, moves({0, 42, 340}, {6.375, 0, 0})));
  list.push_back(disc("disc 12", 13, net, turns_back({140, -20, 300}, {11.25, -0.6, 0})));
  list.push_back(rectangle("rod", 46, 0.175, {Pattern::plain, {1, 0.95, 0.8}}, spins({76, -12, 320}, 2.2 * kDegree)));
  Surface shiny = ball("ball", 26, noise({0.2, 0.3, 0.5}, {0.1, 0.12, 0.2}, 9, 5), [](double time) {
    return Pose{{-36 + 0.6 * (time - 24), 34, 330}, turned_y(2 * kDegree * time)};
  });
  shiny.shine = {8, 120, 0.22, 7};
  list.push_back(shiny);
  for (Surface& s : list) s.layer = Layer::middle;
  return list;
}

Scene quality(bool camera_moves, bool objects_move) {
  Scene scene = one_shot(camera_moves ? CameraMotion(traveling) : camera_rests());
  Shot& shot = scene.shots[0];
  shot.surfaces = resting_things();
  for (Surface& s : moving_things()) {
    if (!objects_move) s.motion = frozen(s.motion);
    shot.surfaces.push_back(s);
  }
  shot.spots.push_back({[](double) { return glm::dvec3(120, -90, 640); }, glm::dvec3(230, 200, 230), pulse});
  shot.spots.push_back({[](double time) { return glm::dvec3(-260 + 9 * time, 80, 420); }, glm::dvec3(110, 30, 170),
                        [](double) { return -0.75; }});
  return finished(std::move(scene));
}

}  // namespace

Scene quality_still() { return quality(false, false); }
Scene quality_camera() { return quality(true, false); }
Scene quality_objects() { return quality(false, true); }
Scene quality_all() { return quality(true, true); }

}  // namespace varve::synth
