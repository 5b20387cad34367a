#include "motion/validate_motion.h"

#include <cmath>

#include "motion/vector_cells.h"

namespace varve {
namespace {

/// Whether the way there and back misses by more than a quarter pixel and a hundredth of both lengths (after Sundaram,
/// Brox and Keutzer 2010). False where nothing leads back.
bool misses_back(glm::vec2 there, glm::vec2 back) {
  const auto square = [](double a, double b) { return a * a + b * b; };
  return square(double(there.x) + double(back.x), double(there.y) + double(back.y)) >
         0.0625 + 1e-4 * (square(double(there.x), double(there.y)) + square(double(back.x), double(back.y)));
}

/// Whether the 3x3 of a pixel are of its own surface: one sample cannot have slipped through.
bool is_inside(const Plane<std::uint32_t>* id, const Plane<float>* depth, int x, int y) {
  const Window& w = id ? id->window() : depth->window();
  if (!(x > w.x0 && y > w.y0 && x + 1 < w.x1 && y + 1 < w.y1)) return false;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (id && id->at(x + i, y + j) != id->at(x, y)) return false;
      if (!depth) continue;
      const float a = depth->at(x, y), b = depth->at(x + i, y + j);
      if (a != b && !(std::fabs(a - b) <= 0.1f * std::min(a, b))) return false;
    }
  return true;
}

bool one_way(const SeenPair& pair, const Plane<glm::vec2>& back, int x, int y, glm::vec2 v) {
  if (back.empty()) return false;
  const LandsOn at = land(pair, x, y, glm::dvec2(v));
  return at.known && back.window().contains(at.u, at.v) && misses_back(v, back.at(at.u, at.v));
}

}  // namespace

MotionCensus& MotionCensus::operator+=(const MotionCensus& more) {
  pixels += more.pixels, unusable += more.unusable, zero += more.zero, one_way += more.one_way;
  for (std::size_t k = 0; k < verdicts.size(); ++k) verdicts[k] += more.verdicts[k];
  return *this;
}

MotionValidity validate_motion(const SeenPair& pair, const Plane<glm::vec2>& motion, const Plane<glm::vec2>& back,
                               double doubt, Workers& workers) {
  const Window& w = pair.here();
  MotionValidity out{Plane<float>(w), Plane<std::uint8_t>(w)};
  const auto judge = [&](int x, int y, float& residual) {
    const glm::vec2 v = motion.at(x, y);
    residual = 0;
    if (!(v.x == v.x)) return VectorVerdict::wrong;
    const LandsOn at = land(pair, x, y, glm::dvec2(v));
    switch (at.known ? pair.meet_around(x, y, at.u, at.v) : Meeting::outside) {
      case Meeting::outside:
      case Meeting::hidden:
        return VectorVerdict::untestable;
      case Meeting::absent:
        residual = 1;
        // Without depth another object may as well stand in front.
        if (!pair.has_depths()) return VectorVerdict::untestable;
        return is_inside(pair.has_ids() ? &pair.ids_here() : nullptr, &pair.depths_here(), x, y)
                   ? VectorVerdict::wrong
                   : VectorVerdict::doubtful;
      case Meeting::same:
        break;
    }
    residual = pair.miss(x, y, at.u, at.v);
    return double(residual) > doubt || one_way(pair, back, x, y, v) ? VectorVerdict::doubtful : VectorVerdict::trusted;
  };
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) out.verdict.at(x, y) = std::uint8_t(judge(x, y, out.residual.at(x, y)));
  });
  return out;
}

MotionCensus take_census(const MotionValidity& validity, const SeenPair& pair, const Plane<glm::vec2>& motion,
                         const Plane<glm::vec2>& back) {
  MotionCensus census;
  const Window& w = motion.window();
  census.pixels = w.pixels();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::vec2 v = motion.at(x, y);
      census.unusable += !(v.x == v.x);
      census.zero += v.x == 0 && v.y == 0;
      census.one_way += one_way(pair, back, x, y, v);
      ++census.verdicts[validity.verdict.at(x, y)];
    }
  return census;
}

}  // namespace varve
