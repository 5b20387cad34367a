// Light, shade and what is seen through: things no vector tells.
#include <algorithm>
#include <cmath>

#include "synth/build.h"
#include "synth/scenes.h"

namespace varve::synth {

Scene glints_scene() {
  Scene scene = one_shot([](double time) { return Camera{{{1.5 * (time - 24), 0, 0}}, 320}; });
  Shot& shot = scene.shots[0];
  Surface back = wall(640, noise({0.05, 0.06, 0.08}, {0.01, 0.01, 0.02}, 50, 3));
  shot.surfaces.push_back(back);
  Surface ball_a = ball("bumpy ball", 55, noise({0.25, 0.2, 0.15}, {0.1, 0.08, 0.06}, 12, 5), [](double time) {
    return Pose{{-70, -5, 330}, turned_y(1.5 * kDegree * time)};
  });
  ball_a.shine = {60, 300, 0.3, 5};
  shot.surfaces.push_back(ball_a);
  Surface plate = rectangle("bumpy plate", 70, 60, {Pattern::plain, {0.1, 0.12, 0.15}}, [](double time) {
    return Pose{{85, 0, 330}, turned_x(-(22 + 4 * std::sin(0.12 * time)) * kDegree) * turned_y(15 * kDegree)};
  });
  plate.shine = {40, 500, 0.12, 6};
  plate.lit = true;
  shot.surfaces.push_back(plate);
  return finished(std::move(scene));
}

Scene pulse_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(480, bricks(30)));
  const auto spot = [&](double x, std::function<double(double)> amount) {
    shot.spots.push_back({[x](double) { return glm::dvec3(x, -10, 480); }, glm::dvec3(95, 150, 95), std::move(amount)});
  };
  spot(-160, [](double time) { return 1.5 + 1.5 * std::sin(time * 0.6); });                 // pulses
  spot(0, [](double time) { return std::clamp((40 - time) / 24, 0.0, 1.0) * 3; });          // fades from frame 16 to 40
  spot(160, [](double time) { return std::fmod(std::abs(time), 11) < 0.5 ? 12.0 : 0.0; });  // flashes every 11th frame
  Surface lamp = disc("lamp", 10, {Pattern::plain, {4, 3.6, 2.4}}, moves({0, 100, 470}, {3, 0, 0}));
  lamp.brightness = [](double time) { return 0.55 + 0.45 * std::sin(time * 0.6); };
  shot.surfaces.push_back(lamp);
  return finished(std::move(scene));
}

Scene shadow_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  shot.surfaces.push_back(ground(70, {Pattern::checker, {0.8, 0.78, 0.7}, {0.3, 0.28, 0.25}, 24}));
  const auto shade = [&](glm::dvec3 at, glm::dvec3 per_frame, glm::dvec3 radii) {
    shot.spots.push_back(
        {[=](double time) { return at + per_frame * (time - 24); }, radii, [](double) { return -0.85; }});
  };
  shade({0, 70, 380}, {6, 0, 0}, {60, 20, 90});
  shade({40, -50, 640}, {-9, 1, 0}, {90, 90, 40});
  shade({-100, 0, 640}, {1.2, 0, 0}, {30, 160, 40});
  return finished(std::move(scene));
}

Scene stochastic_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  const auto add = [&](Surface s) {
    s.opacity = 0.25;
    s.stochastic = true;
    shot.surfaces.push_back(std::move(s));
  };
  add(rectangle("still veil", 60, 60, {Pattern::plain, {2, 1.8, 1.2}}, rests({-80, 0, 320})));
  add(disc("moving veil", 55, {Pattern::checker, {0.1, 0.6, 0.9}, {0.9, 0.9, 0.9}, 16},
           moves({70, 0, 320}, {1.3, 0.4, 0})));
  return finished(std::move(scene));
}

Scene panes_scene() {
  Scene scene = one_shot();
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(wall(640, bricks(40)));
  Surface rear = rectangle("rear pane", 80, 55, {Pattern::checker, {0.1, 0.5, 0.8}, {0.5, 0.8, 0.9}, 11},
                           moves({0, -10, 420}, {2.6, 0.5, 0}));
  rear.opacity = 0.4;
  rear.layer = Layer::middle;
  shot.surfaces.push_back(rear);
  Surface front = rectangle("front pane", 50, 50, {Pattern::stripes, {0.9, 0.5, 0.1}, {0.4, 0.1, 0.05}, 6},
                            moves({10, 10, 320}, {-3.7, 0.3, 0}));
  front.opacity = 0.5;
  front.layer = Layer::foreground;
  shot.surfaces.push_back(front);
  return finished(std::move(scene));
}

Scene hdr_scene() {
  Scene scene = one_shot([](double time) { return Camera{{{2.3 * (time - 24), 0.4 * (time - 24), 0}}, 320}; });
  Shot& shot = scene.shots[0];
  shot.surfaces.push_back(
      rectangle("lamps", 4000, 4000, {Pattern::emitters, glm::dvec3(65504), glm::dvec3(0.02), 37}, rests({0, 0, 640})));
  shot.surfaces.push_back(disc("passing disc", 30, {Pattern::checker, {0.5, 0.5, 0.5}, {0.05, 0.05, 0.05}, 8},
                               moves({0, 0, 320}, {4, 0, 0})));
  return finished(std::move(scene));
}

}  // namespace varve::synth
