#include "deep/visibility.h"

#include <algorithm>
#include <cmath>

namespace varve {
namespace {

// Sums over ranges of intervals without a subtraction: a tree whose leaves are the intervals. An interval's sum is that
// of the nodes above it, a range's that of the few nodes that make it up.
void add_to_range(std::vector<double>& tree, std::size_t first, std::size_t last, double value) {
  const std::size_t leaves = tree.size() / 2;
  for (first += leaves, last += leaves; first < last; first /= 2, last /= 2) {
    if (first & 1) tree[first++] += value;
    if (last & 1) tree[--last] += value;
  }
}

double sum_at(const std::vector<double>& tree, std::size_t leaf) {
  double sum = 0;
  for (leaf += tree.size() / 2; leaf > 0; leaf /= 2) sum += tree[leaf];
  return sum;
}

double sum_over(const std::vector<double>& tree, std::size_t first, std::size_t last) {
  const std::size_t leaves = tree.size() / 2;
  double sum = 0;
  for (first += leaves, last += leaves; first < last; first /= 2, last /= 2) {
    if (first & 1) sum += tree[first++];
    if (last & 1) sum += tree[--last];
  }
  return sum;
}

// Optical depth; only below opaque.
double depth_of(double opacity) { return -std::log1p(-opacity); }
// Of a slice of that optical depth: what is sent from everywhere in it and reaches its front.
double seen_through(double depth) { return depth > 0 ? -std::expm1(-depth) / depth : 1; }
// What a sample sends from within, where its color is what leaves its front.
double emission(double opacity, double depth) { return opacity > 0 ? depth / opacity : 1; }

void see_point(std::span<const double> opacity, std::span<double> visibility, std::size_t sample,
               double& transmittance) {
  visibility[sample] = transmittance;
  transmittance *= 1 - opacity[sample];
}

}  // namespace

void lay_out(std::span<const DeepSample> samples, DeepLayout& layout) {
  layout.cuts.clear();
  layout.ranges.resize(samples.size());
  layout.volumes = false;
  for (const DeepSample& s : samples) {
    if (layout.cuts.empty() || layout.cuts.back() != s.front) layout.cuts.push_back(s.front);
    layout.volumes = layout.volumes || s.back > s.front;
  }
  if (layout.volumes) {
    for (const DeepSample& s : samples) layout.cuts.push_back(s.back);
    std::sort(layout.cuts.begin(), layout.cuts.end());
    layout.cuts.erase(std::unique(layout.cuts.begin(), layout.cuts.end()), layout.cuts.end());
  }
  std::size_t at = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    while (layout.cuts[at] != samples[i].front) ++at;
    layout.ranges[i] = {std::uint32_t(at), std::uint32_t(at)};
    if (samples[i].back > samples[i].front)
      layout.ranges[i].last =
          std::uint32_t(std::lower_bound(layout.cuts.begin() + std::ptrdiff_t(at), layout.cuts.end(), samples[i].back) -
                        layout.cuts.begin());
  }
}

void find_visibility(const DeepLayout& layout, std::span<const double> opacity, std::span<double> visibility,
                     VisibilityScratch& scratch) {
  const std::size_t samples = layout.ranges.size();
  double transmittance = 1;
  if (!layout.volumes) {
    for (std::size_t i = 0; i < samples; ++i) see_point(opacity, visibility, i, transmittance);
    return;
  }
  const auto is_volume = [&](std::size_t i) { return layout.ranges[i].last > layout.ranges[i].first; };
  const auto length = [&](std::size_t i) {
    return layout.cuts[layout.ranges[i].last] - layout.cuts[layout.ranges[i].first];
  };
  const std::size_t intervals = layout.cuts.size() - 1;
  scratch.rates.assign(2 * intervals, 0);  // optical depth per unit of distance
  scratch.seen.assign(2 * intervals, 0);   // what reaches the eye of what is sent evenly, times the distance
  scratch.walls.assign(intervals, 0);      // opaque volumes that begin
  for (std::size_t i = 0; i < samples; ++i) {
    if (!is_volume(i)) continue;
    if (opacity[i] < 1)
      add_to_range(scratch.rates, layout.ranges[i].first, layout.ranges[i].last, depth_of(opacity[i]) / length(i));
    else
      scratch.walls[layout.ranges[i].first] += 1;
  }

  std::fill(visibility.begin(), visibility.end(), 0.0);
  std::size_t next = 0;  // sample
  for (std::size_t j = 0; j <= intervals && transmittance > 0; ++j) {
    for (; next < samples && layout.ranges[next].first == j && !is_volume(next); ++next)
      see_point(opacity, visibility, next, transmittance);
    if (!(transmittance > 0)) break;
    const std::size_t begin = next;
    while (next < samples && layout.ranges[next].first == j) ++next;
    if (j == intervals) break;
    if (scratch.walls[j] > 0) {
      for (std::size_t i = begin; i < next; ++i)
        if (!(opacity[i] < 1)) visibility[i] = transmittance / scratch.walls[j];
      transmittance = 0;
      break;
    }
    const double distance = layout.cuts[j + 1] - layout.cuts[j];
    const double depth = sum_at(scratch.rates, j) * distance;
    scratch.seen[intervals + j] = transmittance * seen_through(depth) * distance;
    transmittance *= std::exp(-depth);
  }
  for (std::size_t node = intervals; node-- > 1;)
    scratch.seen[node] = scratch.seen[2 * node] + scratch.seen[2 * node + 1];
  for (std::size_t i = 0; i < samples; ++i)
    if (is_volume(i) && opacity[i] < 1)
      visibility[i] = emission(opacity[i], depth_of(opacity[i])) / length(i) *
                      sum_over(scratch.seen, layout.ranges[i].first, layout.ranges[i].last);
}

}  // namespace varve
