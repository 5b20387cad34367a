#include "resolve/moments_pyramid.h"

#include <cmath>

namespace varve {
namespace {

Moments leaf(const AccumulateView& v, int x, int y) {
  Moments m;
  if (x < 0 || y < 0 || x >= v.width || y >= v.height || !(v.weight.origin[y * v.weight.stride + x] > 0)) return m;
  const float* color = v.neighbors.origin + y * v.neighbors.stride + 4 * x;
  m.n = 1;
  for (int k = 0; k < 4; ++k) m.mean[k] = double(color[k]);
  return m;
}

Moments node(const MomentsPyramid::Level& l, int x, int y) {
  if (x < 0 || y < 0 || x >= l.width || y >= l.height) return {};
  return l.nodes[std::size_t(y) * std::size_t(l.width) + std::size_t(x)];
}

Moments scaled(Moments m, double weight) {
  m.n *= weight;
  for (double& value : m.m2) value *= weight;
  return m;
}

/// The four nodes around the pixel's centre, weighed so that each pixel below counts `share` of 1 in all.
void add_level(const MomentsPyramid& p, const AccumulateView& v, int level, double share, int x, int y, Moments& sum) {
  if (share <= 0) return;
  const double size = std::ldexp(1.0, level);
  const double px = (x + 0.5) / size - 0.5, py = (y + 0.5) / size - 0.5;
  const int bx = int(std::floor(px)), by = int(std::floor(py));
  const double fx = px - bx, fy = py - by;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy) * share / (size * size);
      if (weight <= 0) continue;
      const Moments m = level == 0 ? leaf(v, bx + i, by + j) : node(p.levels[std::size_t(level - 1)], bx + i, by + j);
      sum = merge(sum, scaled(m, weight));
    }
}

}  // namespace

MomentsPyramid make_pyramid(const AccumulateView& view, int window, Workers& workers) {
  MomentsPyramid p;
  // Squares of size s, read bilinearly, blur by a variance of s^2 / 4; the box by (window^2 - 1) / 12.
  const double wanted = (double(window) * window - 1) / 3;
  while (std::ldexp(1.0, 2 * (p.lower + 1)) <= wanted) ++p.lower;
  const double low = std::ldexp(1.0, 2 * p.lower), high = 4 * low;
  p.upper_share = (wanted - low) / (high - low);
  p.levels.resize(std::size_t(p.lower + 1));
  int width = view.width, height = view.height;
  for (std::size_t l = 0; l < p.levels.size(); ++l) {
    const bool first = l == 0;
    MomentsPyramid::Level& level = p.levels[l];
    level.width = width = (width + 1) / 2;
    level.height = height = (height + 1) / 2;
    level.nodes.resize(std::size_t(width) * std::size_t(height));
    workers.for_rows(0, height, [&](int y) {
      for (int x = 0; x < level.width; ++x) {
        const auto below = [&](int i, int j) {
          return first ? leaf(view, 2 * x + i, 2 * y + j) : node(p.levels[l - 1], 2 * x + i, 2 * y + j);
        };
        level.nodes[std::size_t(y) * std::size_t(level.width) + std::size_t(x)] =
            merge(merge(below(0, 0), below(1, 0)), merge(below(0, 1), below(1, 1)));
      }
    });
  }
  return p;
}

Moments sample_pyramid(const MomentsPyramid& pyramid, const AccumulateView& view, int x, int y) {
  Moments sum;
  add_level(pyramid, view, pyramid.lower, 1 - pyramid.upper_share, x, y, sum);
  add_level(pyramid, view, pyramid.lower + 1, pyramid.upper_share, x, y, sum);
  return sum;
}

}  // namespace varve
