#include "reference/two_sided_reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace varve::reference {
namespace {

/// Variance of the valid 3x3, summed over three channels, in two passes.
double variance_around(const Present& present, int x, int y) {
  double total = 0, largest = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (int j = y - 1; j <= y + 1; ++j)
      for (int i = x - 1; i <= x + 1; ++i)
        if (present.color.window().contains(i, j) && present.valid.at(i, j) > 0)
          values.push_back(double(present.color.at(i, j)[k]));
    if (values.empty()) return 0;
    double mean = 0, variance = 0;
    for (const double v : values) mean += v / double(values.size());
    for (const double v : values) variance += (v - mean) * (v - mean) / double(values.size());
    total += variance;
    largest = std::max(largest, std::abs(mean));
  }
  return total + 1e-12 * largest * largest;
}

}  // namespace

SidePixel side_pixel(const Present& present, const History& beyond, const RecursiveParameters& p,
                     const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, unsigned restart_bit, int x,
                     int y) {
  SidePixel out;
  Color fetched{};
  RectifyParameters undiscounted = rectify;
  undiscounted.clip_discount = false;
  double trust = 0;
  out.strict = rectified_history(present, beyond, p, undiscounted, jitter, restart_bit, x, y, fetched, trust);
  Pixel& side = out.strict;
  side.total *= trust;
  if (side.total > 0 && rectify.clip_discount) {
    double d2 = 0;
    for (std::size_t k = 0; k < 3; ++k) d2 += (side.color[k] - fetched[k]) * (side.color[k] - fetched[k]);
    if (d2 > 0) side.total /= 1 + side.total * d2 / variance_around(present, x, y);
  }
  double w = 0;
  const Color now = weighed_present(present, p.sample_filter, jitter, x, y, w);
  const double sum = side.total + w;
  for (std::size_t k = 0; k < 4; ++k)
    out.state[k] = side.total > 0 ? (side.total * side.color[k] + w * now[k]) / sum : now[k];
  out.state_spread = side.total > 0 ? (side.total * side.total * side.spread + w * w) / (sum * sum) : w > 0 ? 1 : 0;
  const double b = 1 - p.alpha;
  out.state_total = p.alpha_rule == AlphaRule::fixed ? b * sum : std::min(sum, b / p.alpha);
  return out;
}

Pixel merged_pixel(const Present& present, const Pixel& past, const Pixel& future, const RecursiveParameters& p,
                   std::optional<glm::dvec2> jitter, int x, int y) {
  Pixel out;
  double w = 0;
  const Color now = weighed_present(present, p.sample_filter, jitter, x, y, w);
  out.total = past.total + w + future.total;
  out.color = now;
  out.clip = std::max(past.clip, future.clip);
  out.reject = past.reject;
  if (out.total <= 0) return out;
  for (std::size_t k = 0; k < 4; ++k)
    out.color[k] = ((past.total > 0 ? past.total * past.color[k] : 0) +
                    (future.total > 0 ? future.total * future.color[k] : 0) + w * now[k]) /
                   out.total;
  out.spread = (past.total * past.total * past.spread + future.total * future.total * future.spread + w * w) /
               (out.total * out.total);
  out.weight = 1 - w / out.total;
  return out;
}

}  // namespace varve::reference
