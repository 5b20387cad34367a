#include "rerender/rerender_list.h"

#include <algorithm>
#include <cstdio>

namespace varve {
namespace {

constexpr int kTries = 12;

using Rectangles = std::vector<std::vector<RenderRectangle>>;

Rectangles merge_all(const std::vector<TileFrame>& frames, int overhead) {
  Rectangles all;
  for (const TileFrame& frame : frames) all.push_back(merge_tiles(frame, overhead));
  return all;
}

double cost_of(const Rectangles& all) {
  double sum = 0;
  for (const std::vector<RenderRectangle>& frame : all) sum += cost_of(frame);
  return sum;
}

/// Merging renders more than was spent: so much less is spent that it fits.
Rectangles within_budget(std::vector<TileFrame>& frames, const RerenderRequest& request, std::size_t pixels) {
  if (!(request.budget > 0)) {
    spend_all(frames);
    return merge_all(frames, request.overhead);
  }
  const double budget = request.budget * double(pixels);
  double low = 0, high = budget;
  Rectangles best(frames.size());
  for (int k = 0; k < kTries && high > low; ++k) {
    const double tried = k == 0 ? high : (low + high) / 2;
    spend(frames, tried);
    Rectangles made = merge_all(frames, request.overhead);
    if (cost_of(made) > budget) {
      high = tried;
      continue;
    }
    best = std::move(made);
    low = tried;
    if (k == 0) break;
  }
  return best;
}

std::string file_name(const RerenderEntry& entry, int sample) {
  char name[80];
  std::snprintf(name, sizeof name, "extra.r%03d.s%02d.%s%04d.exr", entry.rectangle, sample, entry.frame < 0 ? "-" : "",
                entry.frame < 0 ? -entry.frame : entry.frame);
  return name;
}

}  // namespace

RerenderList make_rerender_list(std::vector<TileFrame> frames, const Window& display, const RerenderRequest& request,
                                const FramePositions& known) {
  RerenderList list{request, display, {}, 0, frames.size(), 0, 0, 0};
  for (const TileFrame& frame : frames) {
    list.pixels += frame.window.pixels();
    for (const Tile& tile : frame.tiles) list.variance += tile.variance;
  }
  const Rectangles rectangles = within_budget(frames, request, list.pixels);
  std::map<int, int> counts;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (const RenderRectangle& r : rectangles[f]) {
      int& most = counts[frames[f].frame];
      most = std::max(most, r.samples);
    }
  const FramePositions positions = fill_positions(counts, known);
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (const RenderRectangle& r : rectangles[f]) {
      RerenderEntry entry{frames[f].frame, int(&r - rectangles[f].data()), r, {}, {}};
      for (int s = 0; s < r.samples; ++s) {
        entry.positions.push_back(positions.at(entry.frame)[std::size_t(s)]);
        entry.files.push_back(file_name(entry, s));
      }
      list.samples += double(r.window.pixels()) * r.samples;
      list.gain += r.gain;
      list.entries.push_back(std::move(entry));
    }
  return list;
}

}  // namespace varve
