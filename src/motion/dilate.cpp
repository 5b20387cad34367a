#include <algorithm>
#include <limits>
#include <utility>

#include "motion/motion.h"

namespace varve {
namespace {

/// How strongly a neighbor claims the pixel: the larger wins. NaN vectors claim nothing.
template <Dilation dilation>
float claim(const Plane<glm::vec2>& motion, const Plane<float>& depth, int x, int y) {
  const glm::vec2 v = motion.at(x, y);
  const float length2 = v.x * v.x + v.y * v.y;
  if (!(length2 >= 0)) return -std::numeric_limits<float>::infinity();
  if constexpr (dilation == Dilation::longest) return length2;
  return -depth.at(x, y);
}

struct Choice {
  int x, y;
};

template <Dilation dilation>
Choice choose(const Plane<glm::vec2>& motion, const Plane<float>& depth, int x, int y) {
  const Window& w = motion.window();
  Choice best{x, y};
  float strongest = claim<dilation>(motion, depth, x, y);
  const glm::vec2 own = motion.at(x, y);
  bool usable = own.x == own.x;
  for (int j = std::max(w.y0, y - 1); j <= std::min(w.y1 - 1, y + 1); ++j)
    for (int i = std::max(w.x0, x - 1); i <= std::min(w.x1 - 1, x + 1); ++i) {
      const glm::vec2 v = motion.at(i, j);
      if (!(v.x == v.x)) continue;
      const float strength = claim<dilation>(motion, depth, i, j);
      if (strength > strongest || !usable) {
        best = {i, j};
        strongest = strength;
        usable = true;
      }
    }
  return best;
}

template <Dilation dilation>
DilatedMotion dilate(const Plane<glm::vec2>& motion, const Plane<float>& depth, Workers& workers) {
  const Window& w = motion.window();
  DilatedMotion out{Plane<glm::vec2>(w), depth.empty() ? Plane<float>() : Plane<float>(w)};
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const Choice from = choose<dilation>(motion, depth, x, y);
      out.motion.at(x, y) = motion.at(from.x, from.y);
      if (!depth.empty()) out.depth.at(x, y) = depth.at(from.x, from.y);
    }
  });
  return out;
}

}  // namespace

DilatedMotion dilate_motion(Plane<glm::vec2> motion, const Plane<float>& depth, Dilation dilation, Workers& workers) {
  if (dilation == Dilation::longest) return dilate<Dilation::longest>(motion, depth, workers);
  if (dilation == Dilation::nearest && !depth.empty()) return dilate<Dilation::nearest>(motion, depth, workers);
  return {std::move(motion), depth.empty() ? Plane<float>() : depth.clone()};
}

}  // namespace varve
