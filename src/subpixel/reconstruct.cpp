#include "subpixel/reconstruct.h"

#include <algorithm>
#include <cmath>

#include "base/reject.h"
#include "resolve/surface_test.h"

namespace varve {
namespace {

constexpr double kLongest = 1e9;      // px: positions stay inside an int
constexpr double kLeastShare = 0.25;  // of what one whole history weighs, as the recursive accumulator has it

SurfaceTests tests_of(const SubpixelBuffer& q, const Present& p, const RecursiveParameters& recursive) {
  SurfaceTests t;
  t.depth = recursive.disocclusion == Disocclusion::depth && !p.depth.empty() && !q.depth.empty();
  t.normal = recursive.reject.normal_angle > 0 && !p.normal.empty() && !q.normal.empty();
  t.id = recursive.reject.id != IdTest::off && !p.id.empty() && !q.id.empty();
  t.depth_tolerance = recursive.depth_tolerance;
  return t;
}

/// Adds the samples of one history; gives back the share of it that was there, under a tent of one pixel.
double add_samples(const SubpixelBuffer& q, std::size_t quadrant, const TestedSurface& surface, bool first_order,
                   double px, double py, Reconstruction& r) {
  const Window& w = q.color.window();
  const double bx = std::floor(px), by = std::floor(py), fx = px - bx, fy = py - by;
  const int x0 = int(bx), y0 = int(by);
  double share = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
      const int x = x0 + i, y = y0 + j;
      if (!(weight > 0)) continue;
      if (!w.contains(x, y)) {
        r.reject |= kRejectWindow;
        continue;
      }
      if (!(q.total.at(x, y) > 0)) {
        r.reject |= kRejectEmptyHistory;
        continue;
      }
      if (const unsigned failed = failed_tests(surface, q.depth, q.normal, q.id, x, y)) {
        r.reject |= failed;
        continue;
      }
      const auto k = std::size_t(r.samples.count++);
      r.texel[k] = {x, y, quadrant};
      r.samples.place[k] = {x - px, y - py};
      r.samples.center[k] = r.samples.place[k];
      if (first_order) r.samples.center[k] += glm::dvec2(q.moments.at(x, y));
      share += weight;
    }
  return share;
}

}  // namespace

Reconstruction reconstruct(const SubpixelHistory& history, const Present& present, const SubpixelParameters& subpixel,
                           const RecursiveParameters& recursive, std::size_t target, int x, int y) {
  Reconstruction r;
  double share = 0;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const SubpixelBuffer& q = history.quadrants[k];
    if (q.empty()) continue;
    const glm::dvec2 way = q.way.empty() ? glm::dvec2(0.0) : glm::dvec2(q.way.at(x, y));
    if (!(way.x * way.x + way.y * way.y <= kLongest * kLongest)) {
      r.reject |= kRejectVector;
      continue;
    }
    const SurfaceTests tests = tests_of(q, present, recursive);
    TestedSurface surface{};
    if (tests.any()) surface = surface_at(present, tests, recursive.reject, x, y);
    const glm::dvec2 offset = kQuadrantMiddle[target] - kQuadrantMiddle[k];
    share += add_samples(
        q, k, surface,
        subpixel.weights == SubpixelWeights::first_order || subpixel.weights == SubpixelWeights::second_order,
        x + offset.x + way.x, y + offset.y + way.y, r);
  }
  if (!(share >= kLeastShare)) return r;
  r.found = weigh_samples_around(r.samples, subpixel.radius, subpixel.weights);
  if (!r.found) return r;
  const auto& weights = r.samples.weight;
  r.heaviest = int(std::max_element(weights.begin(), weights.begin() + r.samples.count) - weights.begin());
  r.reject = 0;
  return r;
}

ReconstructedWeights weighed_history(const SubpixelHistory& history, const Reconstruction& r) {
  ReconstructedWeights out;
  double tents = 0;
  for (int i = 0; i < r.samples.count; ++i) {
    const auto k = std::size_t(i);
    if (!(r.samples.tent[k] > 0)) continue;
    const auto& t = r.texel[k];
    const SubpixelBuffer& q = history.quadrants[t.quadrant];
    const double tent = r.samples.tent[k], weight = r.samples.weight[k];
    const glm::dvec2 d = r.samples.place[k];
    const glm::dvec3 m(q.moments.at(t.x, t.y));
    tents += tent;
    out.total += tent * double(q.total.at(t.x, t.y));
    out.spread += tent * double(q.spread.at(t.x, t.y));
    out.moments.x += weight * (m.x + d.x);
    out.moments.y += weight * (m.y + d.y);
    const double step = weight * (d.x * m.x + d.y * m.y + (d.x * d.x + d.y * d.y) / 2);
    out.carried += step;
    out.moments.z += weight * m.z + step;
  }
  out.total /= tents;
  out.spread /= tents;
  out.moments.z = std::max(0.0, out.moments.z);  // first-order weights may be negative
  return out;
}

}  // namespace varve
