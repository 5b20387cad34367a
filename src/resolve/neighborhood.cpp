#include "resolve/neighborhood.h"

namespace varve {

bool counts_itself(const AccumulateView& view, int x, int y) {
  return !view.leave_present_out && view.weight.origin[y * view.weight.stride + x] > 0;
}

void gather_samples(const AccumulateView& view, int radius, int x, int y, Samples& samples) {
  samples.clear();
  const int x0 = std::max(0, x - radius), x1 = std::min(view.width - 1, x + radius);
  for (int j = std::max(0, y - radius); j <= std::min(view.height - 1, y + radius); ++j) {
    const float* weight = view.weight.origin + j * view.weight.stride;
    for (int i = x0; i <= x1; ++i) {
      if (!(weight[i] > 0) || (view.leave_present_out && i == x && j == y)) continue;
      samples.push_back(color_at(view.neighbors, i, j));
    }
  }
}

Moments moments_of(const Samples& samples) {
  Moments m;
  m.n = double(samples.size());
  if (samples.empty()) return m;
  const glm::dvec4 pivot = samples.front();  // constant in, the same constant out
  glm::dvec4 sum(0), squares(0), rest(0);
  for (const glm::dvec4& c : samples) sum += c - pivot;
  const glm::dvec4 mean = pivot + sum / m.n;
  for (const glm::dvec4& c : samples) {
    const glm::dvec4 d = c - mean;
    squares += d * d;
    rest += d;
  }
  for (int k = 0; k < 4; ++k) {
    m.mean[k] = mean[k];
    m.m2[k] = std::max(0.0, squares[k] - rest[k] * rest[k] / m.n);  // less what rounding of the mean has added
  }
  return m;
}

Extremes extremes_of(const Samples& samples) {
  Extremes e;
  for (const glm::dvec4& c : samples)
    for (int k = 0; k < 4; ++k) {
      e.low[k] = std::min(e.low[k], float(c[k]));
      e.high[k] = std::max(e.high[k], float(c[k]));
    }
  return e;
}

}  // namespace varve
