#include "deep/flatten.h"

#include <algorithm>
#include <utility>

namespace varve {
namespace {

double luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }

}  // namespace

FlatPixel flatten(std::vector<DeepSample>& samples, bool colored, LayerRule rule, FlattenScratch& scratch) {
  if (!std::is_sorted(samples.begin(), samples.end(), is_before)) std::sort(samples.begin(), samples.end(), is_before);
  lay_out(samples, scratch.layout);
  const std::size_t count = samples.size();
  scratch.opacity.resize(count);
  for (std::vector<double>& lane : scratch.visibility) lane.resize(count);
  for (int k = colored ? 0 : 3; k < 4; ++k) {
    for (std::size_t i = 0; i < count; ++i) scratch.opacity[i] = samples[i].opacity[k];
    find_visibility(scratch.layout, scratch.opacity, scratch.visibility[std::size_t(k)], scratch.visibility_scratch);
  }
  if (!colored)
    for (std::size_t k = 0; k < 3; ++k)
      std::copy(scratch.visibility[3].begin(), scratch.visibility[3].end(), scratch.visibility[k].begin());

  FlatPixel flat;
  double best = -1;
  for (std::size_t i = 0; i < count; ++i) {
    const DeepSample& s = samples[i];
    glm::dvec4 light(0.0), change(0.0);
    for (int k = 0; k < 4; ++k) {
      const double v = scratch.visibility[std::size_t(k)][i];
      if (!(v > 0)) continue;
      light[k] = v * (k < 3 ? s.color[k] : s.opacity[k] + 0 * s.color[k]);  // a NaN color spoils alpha too
      change[k] = v * s.opacity[k];
    }
    flat.color += light;
    const double variation = colored ? luminance(change[0], change[1], change[2]) : change[3];
    const double rank = rule == LayerRule::variation ? variation : luminance(light[0], light[1], light[2]);
    flat.seen += change != glm::dvec4(0.0) || light != glm::dvec4(0.0);
    if (rank > best) {
      best = rank;
      flat.winner = s.index;
      flat.place = i;
      flat.variation = variation;
    }
  }
  return flat;
}

}  // namespace varve
