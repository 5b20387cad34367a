// A room as Yang 2009 shows one: large smooth things, hardly a silhouette, and paint that is far too fine for the
// pixels. What a resolver gains here is what it gains on aliased shading.
#include <cmath>

#include "synth/build.h"
#include "synth/scenes.h"

namespace varve::synth {
namespace {

/// Sways sideways and forward and turns, 1 to 4 pixels a frame; never steady, so that no fraction of a pixel lasts.
Camera strolling(double time) {
  const double t = time - 24;
  return {{{1.9 * t + 6 * std::sin(0.11 * t), 0.3 * t, 2.2 * t}, turned_y(0.1 * kDegree * t)}, 320};
}

std::vector<Surface> room() {
  const Texture mosaic{Pattern::checker, {0.74, 0.7, 0.6}, {0.16, 0.11, 0.09}, 9};
  const Texture carpet{Pattern::spots, {0.55, 0.16, 0.12}, {0.85, 0.75, 0.5}, 4.5, 17};
  std::vector<Surface> list;
  list.push_back(wall(700, bricks(22)));
  list.push_back(ground(120, mosaic));
  Surface ceiling = ground(-170, noise({0.82, 0.8, 0.75}, {0.4, 0.36, 0.3}, 6, 23));
  ceiling.name = "ceiling";
  list.push_back(ceiling);
  list.push_back(rectangle("left wall", 8000, 4000, noise({0.7, 0.62, 0.4}, {0.25, 0.2, 0.12}, 4, 29), [](double) {
    return Pose{{-420, 0, 0}, turned_y(90 * kDegree)};
  }));
  list.push_back(
      rectangle("right wall", 8000, 4000, {Pattern::stripes, {0.65, 0.68, 0.7}, {0.2, 0.26, 0.3}, 5}, [](double) {
        return Pose{{440, 0, 0}, turned_y(90 * kDegree)};
      }));
  list.push_back(rectangle("carpet", 150, 90, carpet, [](double time) {
    return Pose{{30 + 0.4 * (time - 24), 119.5, 520}, turned_x(90 * kDegree)};
  }));
  list.push_back(ball("globe", 75, noise({0.25, 0.4, 0.7}, {0.75, 0.7, 0.5}, 5, 31), [](double time) {
    return Pose{{150 - 0.8 * (time - 24), 40, 560}, turned_y(-0.7 * kDegree * (time - 24))};
  }));
  return list;
}

Scene indoors(bool moves) {
  Scene scene = one_shot(moves ? CameraMotion(strolling) : camera_rests());
  for (Surface& s : room()) {
    if (!moves) s.motion = frozen(s.motion);
    scene.shots[0].surfaces.push_back(s);
  }
  return finished(std::move(scene));
}

}  // namespace

Scene indoor_still() { return indoors(false); }
Scene indoor_moving() { return indoors(true); }

}  // namespace varve::synth
