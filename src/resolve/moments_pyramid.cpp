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

/// Merges a node that counts `weight`; nothing of it must be touched when that is 0.
void add(Moments& sum, const Moments& node, double weight) {
  const double n = node.n * weight;
  if (!(n > 0)) return;
  const double all = sum.n + n, share = n / all, spread = sum.n * share;
  for (int k = 0; k < 4; ++k) {
    const double d = node.mean[k] - sum.mean[k];
    sum.mean[k] += d * share;
    sum.m2[k] += node.m2[k] * weight + d * d * spread;
  }
  sum.n = all;
}

/// Place of a pixel's centre among the squares of a level: the one before it, and the fraction towards the next.
struct Place {
  int base;
  double fraction;
};
Place place_of(int pixel, int level) {
  const double at = (pixel + 0.5) / double(1 << level) - 0.5;
  const int base = int(at + 1) - 1;  // floor: at is above -1
  return {base, at - base};
}

/// Row y of a level such that each pixel below counts `share` of 1 in all.
void mix_level(const MomentsPyramid& p, const AccumulateView& v, int level, double share, int y,
               std::vector<Moments>& out) {
  out.clear();
  if (share <= 0) return;
  const Place at = place_of(y, level);
  const double weight = share / std::ldexp(1.0, 2 * level);
  const auto value = [&](int x, int j) {
    return level == 0 ? leaf(v, x, j) : node(p.levels[std::size_t(level - 1)], x, j);
  };
  out.resize(std::size_t(level == 0 ? v.width : p.levels[std::size_t(level - 1)].width));
  for (int x = 0; x < int(out.size()); ++x) {
    add(out[std::size_t(x)], value(x, at.base), (1 - at.fraction) * weight);
    add(out[std::size_t(x)], value(x, at.base + 1), at.fraction * weight);
  }
}

void add_level(const std::vector<Moments>& row, int level, int x, Moments& sum) {
  const Place at = place_of(x, level);
  if (at.base >= 0 && at.base < int(row.size())) add(sum, row[std::size_t(at.base)], 1 - at.fraction);
  if (at.base + 1 < int(row.size())) add(sum, row[std::size_t(at.base + 1)], at.fraction);
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

void mix_pyramid_row(const MomentsPyramid& pyramid, const AccumulateView& view, int y, PyramidRow& row) {
  mix_level(pyramid, view, pyramid.lower, 1 - pyramid.upper_share, y, row.lower);
  mix_level(pyramid, view, pyramid.lower + 1, pyramid.upper_share, y, row.upper);
}

Moments sample_pyramid(const MomentsPyramid& pyramid, const PyramidRow& row, int x) {
  Moments sum;
  add_level(row.lower, pyramid.lower, x, sum);
  add_level(row.upper, pyramid.lower + 1, x, sum);
  return sum;
}

}  // namespace varve
