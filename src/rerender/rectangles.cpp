#include "rerender/rectangles.h"

#include <algorithm>

namespace varve {
namespace {

constexpr std::size_t kMostToMerge = 600;  // of one frame; trying pairs takes the square of it

double cost_of(const RenderRectangle& r) { return double(r.window.pixels()) * r.samples; }

RenderRectangle rectangle_of(const Tile& tile) {
  return {tile.window, samples_of_step(tile.step), tile.gain[tile.step], tile.lacking, tile.variance, tile.failed,
          tile.noisy};
}

void take(RenderRectangle& to, const RenderRectangle& from) {
  to.window = unite(to.window, from.window);
  to.samples = std::max(to.samples, from.samples);
  to.gain += from.gain, to.lacking += from.lacking, to.variance += from.variance;
  to.failed += from.failed, to.noisy += from.noisy;
}

/// Neighbors of equal samples: along rows, then rows of the same extent.
std::vector<RenderRectangle> runs(const TileFrame& frame) {
  std::vector<RenderRectangle> all;
  for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
    const RenderRectangle next = rectangle_of(frame.tiles[i]);
    if (next.samples == 0) continue;
    const bool goes_on = !all.empty() && int(i) % frame.columns != 0 && all.back().samples == next.samples &&
                         all.back().window.x1 == next.window.x0 && all.back().window.y0 == next.window.y0;
    if (goes_on)
      take(all.back(), next);
    else
      all.push_back(next);
  }
  std::vector<RenderRectangle> stacked;
  for (const RenderRectangle& r : all) {
    const auto above = std::find_if(stacked.begin(), stacked.end(), [&](const RenderRectangle& s) {
      return s.samples == r.samples && s.window.x0 == r.window.x0 && s.window.x1 == r.window.x1 &&
             s.window.y1 == r.window.y0;
    });
    if (above == stacked.end())
      stacked.push_back(r);
    else
      take(*above, r);
  }
  return stacked;
}

/// The rectangles that become one when `a` and `b` do: all that the window of both touches, and so on.
struct Union {
  std::vector<std::size_t> members;
  RenderRectangle made;
};

Union unite_all(const std::vector<RenderRectangle>& all, std::size_t a, std::size_t b) {
  Union u{{}, {}};
  Window window = unite(all[a].window, all[b].window);
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (intersect(all[i].window, window).empty() ||
          std::find(u.members.begin(), u.members.end(), i) != u.members.end())
        continue;
      u.members.push_back(i);
      window = unite(window, all[i].window);
      grew = true;
    }
  }
  for (const std::size_t i : u.members) take(u.made, all[i]);
  return u;
}

/// What is saved; above 0: it is worth it.
double saved(const std::vector<RenderRectangle>& all, const Union& u, int overhead) {
  double before = 0;
  for (const std::size_t i : u.members) before += cost_of(all[i]) + double(overhead) * all[i].samples;
  return before - cost_of(u.made) - double(overhead) * u.made.samples;
}

/// Joins each rectangle with the one that saves most by it, again and again; true if any was joined.
bool merge_once(std::vector<RenderRectangle>& all, int overhead) {
  bool merged = false;
  for (std::size_t a = 0; a < all.size(); ++a) {
    double best = 0;
    Union chosen;
    for (std::size_t b = 0; b < all.size(); ++b) {
      if (b == a) continue;
      const RenderRectangle &r = all[a], &s = all[b];
      const double together = double(unite(r.window, s.window).pixels()) * std::max(r.samples, s.samples);
      // Saves nothing by itself; what lies between may still do, and is tried from there.
      if (together - cost_of(r) - cost_of(s) > double(overhead) * (r.samples + s.samples)) continue;
      Union u = unite_all(all, a, b);
      const double gain = saved(all, u, overhead);
      if (gain > best) best = gain, chosen = std::move(u);
    }
    if (!(best > 0)) continue;
    std::sort(chosen.members.begin(), chosen.members.end());
    for (std::size_t k = chosen.members.size(); k-- > 0;) all.erase(all.begin() + std::ptrdiff_t(chosen.members[k]));
    all.insert(all.begin() + std::ptrdiff_t(chosen.members.front()), chosen.made);
    a = chosen.members.front();
    merged = true;
  }
  return merged;
}

}  // namespace

std::vector<RenderRectangle> merge_tiles(const TileFrame& frame, int overhead) {
  std::vector<RenderRectangle> all = runs(frame);
  while (overhead > 0 && all.size() <= kMostToMerge && merge_once(all, overhead)) {
  }
  std::sort(all.begin(), all.end(), [](const RenderRectangle& a, const RenderRectangle& b) {
    return a.window.y0 != b.window.y0 ? a.window.y0 < b.window.y0 : a.window.x0 < b.window.x0;
  });
  return all;
}

double cost_of(const std::vector<RenderRectangle>& rectangles) {
  double sum = 0;
  for (const RenderRectangle& r : rectangles) sum += cost_of(r);
  return sum;
}

}  // namespace varve
