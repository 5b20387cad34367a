#include "reference/evaluation_reference.h"

#include <cmath>
#include <vector>

namespace varve::test {
namespace {

double luma(const glm::vec4& c) { return 0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b); }

}  // namespace

EvaluatedPixel evaluate_pixel(const Present& present, const Accumulated& resolved, const RerenderRequest& request,
                              int x, int y) {
  const History& h = resolved.history;
  const Window& w = h.color.window();
  std::vector<double> samples, lights;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i) {
      if (!w.contains(i, j)) continue;
      if (present.valid.at(i, j) > 0) samples.push_back(luma(present.color.at(i, j)));
      lights.push_back(std::fabs(luma(h.color.at(i, j))));
    }
  double mean = 0, light = 0, around = 0;
  for (const double s : samples) mean += s / double(samples.size());
  for (const double l : lights) light += l / double(lights.size());
  for (const double s : samples)
    if (samples.size() > 1) around += (s - mean) * (s - mean) / double(samples.size() - 1);

  EvaluatedPixel out;
  const bool seen = h.total.at(x, y) > 0 && h.spread.at(x, y) > 0;
  out.count = seen ? std::fmax(1, 1 / double(h.spread.at(x, y))) : 0;
  const double n = std::fmax(1, out.count);
  const auto& d = resolved.diagnostics;
  out.failed = !seen || (!d.reject.empty() && d.reject.at(x, y) != 0 && out.count < 1.5);
  double one = around;
  if (!d.variance.empty() && seen) one = (double(d.variance.at(x, y)) * n * n + 2 * around) / (n + 2);
  const double variance = one / n;
  out.lacking = out.failed ? request.want_samples : std::fmax(0, request.want_samples - out.count);
  if (request.want_noise > 0 && variance > 0) {
    const double allowed = request.want_noise * light, wanted = n * variance / (allowed * allowed);
    out.lacking = std::fmax(out.lacking, allowed > 0 ? wanted - n : kMostLacking);
  }
  out.lacking = std::fmin(out.lacking, kMostLacking);
  out.variance = std::fmin(1, variance / std::pow(1 + light, 4));
  return out;
}

}  // namespace varve::test
