#include "rerender/evaluation.h"

#include <algorithm>
#include <cmath>

namespace varve {
namespace {

constexpr double kPriorSamples = 2;  // the spread around counts as if so many samples of the pixel had shown it
constexpr double kOwnSample = 1.5;   // effective samples up to which only the pixel's own is left

double luminance_of(const glm::vec4& c) { return 0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b); }

/// Spread of one sample's luminance: unbiased variance of the valid ones around.
double spread_around(const Present& p, int x, int y) {
  const Window& w = p.color.window();
  double shift = 0, sum = 0, squares = 0;
  int count = 0;
  for (int j = std::max(y - 1, w.y0); j <= std::min(y + 1, w.y1 - 1); ++j)
    for (int i = std::max(x - 1, w.x0); i <= std::min(x + 1, w.x1 - 1); ++i) {
      if (!(p.valid.at(i, j) > 0)) continue;
      const double light = luminance_of(p.color.at(i, j));
      if (count++ == 0) shift = light;
      sum += light - shift, squares += (light - shift) * (light - shift);
    }
  return count > 1 ? std::max(0.0, (squares - sum * sum / count) / (count - 1)) : 0;
}

double light_around(const Plane<glm::vec4>& color, int x, int y) {
  const Window& w = color.window();
  double sum = 0;
  int count = 0;
  for (int j = std::max(y - 1, w.y0); j <= std::min(y + 1, w.y1 - 1); ++j)
    for (int i = std::max(x - 1, w.x0); i <= std::min(x + 1, w.x1 - 1); ++i, ++count)
      sum += std::fabs(luminance_of(color.at(i, j)));
  return sum / count;
}

/// How many samples bring the noise to what is wanted.
double lacking_for_noise(double variance, double count, double light, double want) {
  if (!(variance > 0)) return 0;
  const double allowed = want * light, ratio = variance / (allowed * allowed);
  return ratio > 1 ? count * ratio - count : 0;  // black with noise: more than is ever asked for
}

}  // namespace

Evaluation evaluate(const Present& present, const Accumulated& resolved, const RerenderRequest& request,
                    Workers& workers) {
  const History& history = resolved.history;
  const Window& w = history.color.window();
  Evaluation out{Plane<float>(w), Plane<float>(w), Plane<float>(w), Plane<std::uint8_t>(w)};
  const Plane<float>& own = resolved.diagnostics.variance;
  const Plane<std::uint32_t>& reject = resolved.diagnostics.reject;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const double spread = double(history.spread.at(x, y));
      const bool empty = !(history.total.at(x, y) > 0) || !(spread > 0);
      const double count = empty ? 0 : std::max(1.0, 1 / spread), n = std::max(count, 1.0);
      const bool turned_down = !reject.empty() && reject.at(x, y) != 0;
      const bool failed = empty || (turned_down && count < kOwnSample);
      double of_sample = spread_around(present, x, y);
      if (!own.empty() && !empty)
        of_sample = (double(own.at(x, y)) * n * n + of_sample * kPriorSamples) / (n + kPriorSamples);
      const double variance = of_sample / n, light = light_around(history.color, x, y);
      double lacking = failed ? request.want_samples : std::max(0.0, request.want_samples - count);
      if (request.want_noise > 0)
        lacking = std::max(lacking, lacking_for_noise(variance, n, light, request.want_noise));
      const double slope = 1 / ((1 + light) * (1 + light)), seen = variance * slope * slope;
      out.lacking.at(x, y) = lacking < kMostLacking ? float(lacking) : float(kMostLacking);
      out.count.at(x, y) = float(count);
      out.variance.at(x, y) = seen < 1 ? float(seen) : 1.0f;
      out.failed.at(x, y) = failed;
    }
  });
  return out;
}

}  // namespace varve
