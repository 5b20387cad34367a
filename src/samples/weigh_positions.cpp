#include "samples/weigh_positions.h"

#include <vector>

#include "base/held_float.h"
#include "resolve/sample_weights.h"

namespace varve {
namespace {

constexpr int kReach = kPresentBorder;

/// A neighbor whose sample has weight at the pixel's center.
struct Tap {
  int x, y;
  double weight;
};

/// One sample of the pixels around, by its distance from the middle one's center.
std::vector<Tap> taps_of(SampleFilter filter, glm::dvec2 jitter) {
  std::vector<Tap> taps;
  for (int y = -kReach; y <= kReach; ++y)
    for (int x = -kReach; x <= kReach; ++x)
      if (const double w = position_weight(filter, glm::dvec2(x, y) + jitter); w != 0) taps.push_back({x, y, w});
  return taps;
}

/// Colors that are summed together: that of the present, then its companions.
const Plane<glm::vec4>& plane_of(const Present& p, std::size_t k) { return k == 0 ? p.color : p.companions[k - 1]; }

struct Weights {
  Samples samples;
  std::vector<std::vector<Tap>> taps;  ///< of each sample

  /// Calls use(sample, x, y, weight) with every sample that counts at pixel (x, y).
  template <class Use>
  void visit(int x, int y, bool positive_only, const Use& use) const {
    for (std::size_t s = 0; s < samples.size(); ++s)
      for (const Tap& tap : taps[s]) {
        if (positive_only && tap.weight < 0) continue;
        if (samples[s]->valid.at(x + tap.x, y + tap.y) > 0) use(*samples[s], x + tap.x, y + tap.y, tap.weight);
      }
  }
  double sum(int x, int y, bool positive_only, double whole) const {
    double total = 0;
    visit(x, y, positive_only, [&](const Present&, int, int, double w) { total += w; });
    return total / whole;
  }
};

}  // namespace

double position_weight(SampleFilter filter, glm::dvec2 jitter) {
  return reconstruction_kernel(filter, jitter.x) * reconstruction_kernel(filter, jitter.y);
}

void weigh_positions(Samples samples, SampleFilter filter, Present& out, Workers& workers, double whole) {
  mean_colors(samples, out, workers);
  Weights weights{samples, {}};
  for (const Present* sample : samples) weights.taps.push_back(taps_of(filter, *sample->jitter));
  const Window& w = out.color.window();
  const std::size_t planes = 1 + out.companions.size();
  out.sample_weight = Plane<float>(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      double total = weights.sum(x, y, false, whole);
      const bool positive_only = total < 0.1;
      if (positive_only) total = weights.sum(x, y, true, whole);
      out.sample_weight.at(x, y) = total > 0 ? float(total) : 0.0f;
      if (!(total > 0)) continue;
      const double weight_of_all = total * whole;
      for (std::size_t k = 0; k < planes; ++k) {
        glm::dvec4 sum(0);
        weights.visit(x, y, positive_only, [&](const Present& sample, int i, int j, double weight) {
          sum += glm::dvec4(plane_of(sample, k).at(i, j)) * weight;
        });
        (k == 0 ? out.color : out.companions[k - 1]).at(x, y) = held_color(sum / weight_of_all);
      }
    }
  });
}

}  // namespace varve
