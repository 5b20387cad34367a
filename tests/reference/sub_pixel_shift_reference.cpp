#include "reference/sub_pixel_shift_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace varve::reference {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Binomially smoothed value; NaN on the rim.
double smooth(const Plane<float>& p, int x, int y) {
  double sum = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (!p.window().contains(x + i, y + j)) return kNaN;
      sum += double(p.at(x + i, y + j)) * (2 - std::abs(i)) * (2 - std::abs(j)) / 16;
    }
  return sum;
}

/// The kernel of Catmull and Rom at a distance.
double kernel(double d) {
  d = std::abs(d);
  if (d >= 2) return 0;
  return d < 1 ? 1 - 2.5 * d * d + 1.5 * d * d * d : 2 - 4 * d + 2.5 * d * d - 0.5 * d * d * d;
}

/// NaN beside a step of the motion.
glm::dvec2 motion_of(const Plane<glm::vec2>& motion, int x, int y) {
  const glm::vec2 m = motion.at(x, y);
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!motion.window().contains(u, v)) continue;
      const glm::vec2 d = motion.at(u, v) - m;
      if (!(std::abs(d.x) < 0.1f && std::abs(d.y) < 0.1f)) return glm::dvec2(kNaN);
    }
  return m;
}

/// Sum over the neighbors of (ux, uy) of weight, gradient, and difference; the third is the squared gradient.
struct Term {
  double x = 0, y = 0, energy = 0;
};

Term term(double value, const Plane<float>& before, double ux, double uy, int bx, int by) {
  Term t;
  for (int qy = by - 1; qy <= by + 2; ++qy)
    for (int qx = bx - 1; qx <= bx + 2; ++qx) {
      // Outside of its four pixels the polynomial of each goes on: derivatives at a whole pixel are of one side.
      const double w = kernel(ux - qx) * kernel(uy - qy);
      const double gx = (smooth(before, qx + 1, qy) - smooth(before, qx - 1, qy)) / 2;
      const double gy = (smooth(before, qx, qy + 1) - smooth(before, qx, qy - 1)) / 2;
      const double d = value - smooth(before, qx, qy);
      t.x += w * gx * d, t.y += w * gy * d, t.energy += w * (gx * gx + gy * gy);
    }
  return t;
}

struct Tile {
  double fx = 0, fy = 0, fx_x = 0, fx_y = 0, fy_x = 0, fy_y = 0, energy = 0;
  double distance() const { return energy > 0 ? std::hypot(fx, fy) / std::sqrt(energy) : 0; }
};

std::map<std::pair<int, int>, Tile> tiles_at(const Plane<float>& now, const Plane<float>& before,
                                             const Plane<glm::vec2>& motion, glm::dvec2 shift) {
  std::map<std::pair<int, int>, Tile> tiles;
  const Window &w = now.window(), &b = before.window();
  const double h = 1e-6;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::dvec2 m = motion_of(motion, x, y);
      const double ux = x + m.x + shift.x, uy = y + m.y + shift.y;
      if (!(ux >= b.x0 + 2 && uy >= b.y0 + 2 && ux < b.x1 - 3 && uy < b.y1 - 3)) continue;
      const int bx = int(std::floor(ux)), by = int(std::floor(uy));
      const double value = smooth(now, x, y);
      const Term t = term(value, before, ux, uy, bx, by);
      if (!(std::isfinite(t.x) && std::isfinite(t.y))) continue;
      const Term right = term(value, before, ux + h, uy, bx, by), left = term(value, before, ux - h, uy, bx, by);
      const Term below = term(value, before, ux, uy + h, bx, by), above = term(value, before, ux, uy - h, bx, by);
      Tile& tile = tiles[{(y - w.y0) / 16, (x - w.x0) / 16}];
      tile.fx += t.x, tile.fy += t.y, tile.energy += t.energy;
      tile.fx_x += (right.x - left.x) / (2 * h), tile.fy_x += (right.y - left.y) / (2 * h);
      tile.fx_y += (below.x - above.x) / (2 * h), tile.fy_y += (below.y - above.y) / (2 * h);
    }
  return tiles;
}

/// Cauchy's weights about twice the distance that half of the structure keeps to.
void weigh(std::map<std::pair<int, int>, Tile>& tiles) {
  double whole = 0, usual = std::numeric_limits<double>::infinity();
  for (const auto& [place, tile] : tiles) whole += tile.energy;
  for (const auto& [place, candidate] : tiles) {
    double within = 0;
    for (const auto& [other, tile] : tiles)
      if (tile.distance() <= candidate.distance()) within += tile.energy;
    if (candidate.energy > 0 && within >= whole / 2) usual = std::min(usual, candidate.distance());
  }
  for (auto& [place, tile] : tiles) {
    const double ratio = tile.distance() / (2 * usual), weight = ratio > 0 ? 1 / (1 + ratio * ratio) : 1;
    tile = {tile.fx * weight,   tile.fy * weight,   tile.fx_x * weight,  tile.fx_y * weight,
            tile.fy_x * weight, tile.fy_y * weight, tile.energy * weight};
  }
}

/// Cramer's rule for the step that brings (fx, fy) to 0.
glm::dvec2 step_of(const Tile& all, double fx, double fy) {
  const double det = all.fx_x * all.fy_y - all.fx_y * all.fy_x;
  return {-(fx * all.fy_y - fy * all.fx_y) / det, -(fy * all.fx_x - fx * all.fy_x) / det};
}

}  // namespace

Shift sub_pixel_shift(const Plane<float>& now, const Plane<float>& before, const Plane<glm::vec2>& motion) {
  Shift result;
  for (int i = 0; i < 20; ++i) {
    auto tiles = tiles_at(now, before, motion, result.shift);
    weigh(tiles);
    Tile all;
    for (const auto& [place, t] : tiles) {
      all.fx += t.fx, all.fy += t.fy;
      all.fx_x += t.fx_x, all.fx_y += t.fx_y, all.fy_x += t.fy_x, all.fy_y += t.fy_y;
    }
    result.sigma = glm::dvec2(0);
    for (const auto& [place, t] : tiles) {
      const glm::dvec2 s = step_of(all, t.fx, t.fy);
      result.sigma += s * s;
    }
    result.sigma = {std::sqrt(result.sigma.x), std::sqrt(result.sigma.y)};
    const glm::dvec2 step = step_of(all, all.fx, all.fy);
    const double length = std::max(std::abs(step.x), std::abs(step.y));
    result.shift += length > 0.5 ? step * (0.5 / length) : step;
    if (length < 1e-6) break;
  }
  return result;
}

}  // namespace varve::reference
