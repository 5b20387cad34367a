#include <cmath>

#include "motion/dilate.h"
#include "motion/repair_motion.h"
#include "plan/knob_words.h"
#include "stability/passes.h"

namespace varve::stability {
namespace {

/// Vectors as numbers; what is unusable is told apart, since NaN is a legal answer here.
void keep(const Plane<glm::vec2>& motion, Planes& planes) {
  const Window& w = motion.window();
  for (int c = 0; c < 2; ++c) {
    Plane<float> plane(w);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const glm::vec2 v = motion.at(x, y);
        plane.at(x, y) = std::isnan(v.x) || std::isnan(v.y) ? -1e9f : v[c];
      }
    planes.numbers.push_back(std::move(plane));
  }
}

void keep(const Plane<float>& depth, Planes& planes) {
  const Window& w = depth.window();
  Plane<float> plane(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) plane.at(x, y) = std::isinf(depth.at(x, y)) ? -1.0f : depth.at(x, y);
  planes.numbers.push_back(std::move(plane));
}

}  // namespace

std::vector<Pass> motion_passes() {
  std::vector<Pass> passes;
  const auto add = [&](const std::string& name, const auto& step) {
    Pass pass{name, [step](const RawShot& shot, Workers& w) {
                Planes planes;
                for (std::size_t i = 0; i < shot.size(); ++i) {
                  Present here = present_of(shot[i], w);
                  Present there = present_of(shot[i > 0 ? i - 1 : i], w);
                  step(here, there, planes, w);
                }
                return planes;
              }};
    pass.mirror = -1;  // vectors turn with a mirror: their own tests hold that
    passes.push_back(pass);
  };
  for (const Word<Dilation>& dilation : kDilations)
    for (const bool apart : {false, true})
      add("dilate " + std::string(dilation.word) + (apart ? " surfaces apart" : ""),
          [dilation, apart](Present& here, Present&, Planes& planes, Workers& w) {
            const DilatedMotion d = apart ? dilate_surfaces_apart(std::move(here.motion), here.depth, dilation.value, w)
                                          : dilate_motion(std::move(here.motion), here.depth, dilation.value, w);
            keep(d.motion, planes), keep(d.depth, planes);
          });
  add("invert_motion", [](Present& here, Present& there, Planes& planes, Workers&) {
    keep(invert_motion(there.forward, there.depth, here.depth, 0.05, here.motion.clone()), planes);
  });
  add("reject_one_way_motion", [](Present& here, Present& there, Planes& planes, Workers& w) {
    reject_one_way_motion(here.motion, there.forward, 0.5, w);
    keep(here.motion, planes);
  });
  for (const bool marks : {true, false})
    add(marks ? "repair_motion" : "repair_motion without marks",
        [marks](Present& here, Present& there, Planes& planes, Workers& w) {
          const Plane<float> light = light_of(here.color, w), other = light_of(there.color, w);
          const SeenFrame a{&light, marks ? &here.depth : nullptr, marks ? &here.id : nullptr, *here.jitter};
          const SeenFrame b{&other, marks ? &there.depth : nullptr, marks ? &there.id : nullptr, *there.jitter};
          RepairParameters p;
          p.mode = RepairMotion::on;
          MotionRepair said = repair_motion(here.motion, a, b, there.forward, {}, p, w);
          keep(here.motion, planes);
          planes.numbers.push_back(std::move(said.residual));
        });
  return passes;
}

std::vector<Pass> all_passes() {
  std::vector<Pass> all = resolve_passes();
  for (std::vector<Pass> more : {combining_passes(), motion_passes()})
    for (Pass& pass : more) all.push_back(std::move(pass));
  return all;
}

std::vector<Pass> few_passes() {
  std::vector<Pass> few;
  for (Pass& pass : all_passes())
    for (const char* const name :
         {"sanitize", "weigh_samples mitchell", "accumulate box variance clip present rgb", "accumulate box none",
          "accumulate box hull clip mean", "accumulate moments separable 15 variance", "companions catmull-rom clip",
          "two-sided box variance", "gather plain", "gather gain", "composite_presents variation",
          "resolve_samples none", "flatten deep gray variation", "sharpen 1", "fallback own", "dilate longest"})
      if (pass.name == name || (pass.name.starts_with(name) && std::string(name) == "accumulate box none")) {
        few.push_back(pass);
        break;
      }
  return few;
}

}  // namespace varve::stability
