#include "subpixel/blur_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace varve {
namespace {

constexpr double kQuarterVariance = 1.0 / 48, kQuartersApart = 1.0 / 16;  // px^2

using Row = std::array<double, kQuadrants>;

/// Solves a x = b; a is diagonally dominant enough to need no search for pivots beyond its column.
Row solve(std::array<Row, kQuadrants> a, Row b) {
  for (std::size_t c = 0; c < kQuadrants; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < kQuadrants; ++r)
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t r = c + 1; r < kQuadrants; ++r) {
      const double f = a[r][c] / a[c][c];
      for (std::size_t k = c; k < kQuadrants; ++k) a[r][k] -= f * a[c][k];
      b[r] -= f * b[c];
    }
  }
  Row x{};
  for (std::size_t r = kQuadrants; r-- > 0;) {
    double sum = b[r];
    for (std::size_t k = r + 1; k < kQuadrants; ++k) sum -= a[r][k] * x[k];
    x[r] = sum / a[r][r];
  }
  return x;
}

/// Samples of all histories around the middle of quarter k when its turn comes; `from` tells whose they are.
TentSamples samples_around(std::size_t k, const glm::dvec2& velocity, std::array<std::size_t, kMostTentSamples>& from) {
  TentSamples s;
  for (std::size_t j = 0; j < kQuadrants; ++j) {
    const double lag = double((k + 2 * kQuadrants - j - 1) % kQuadrants + 1);
    const glm::dvec2 at = kQuadrantMiddle[k] - kQuadrantMiddle[j] - velocity * lag;
    const glm::dvec2 base(std::floor(at.x), std::floor(at.y));
    for (int i = 0; i < 4; ++i) {
      const auto n = std::size_t(s.count++);
      s.place[n] = s.center[n] = base + glm::dvec2(i % 2, i / 2) - at;
      from[n] = j;
    }
  }
  return s;
}

}  // namespace

SteadyKernels steady_kernels(const glm::dvec2& velocity, double alpha, const WeighSamples& weigh) {
  struct Target {
    TentSamples samples;
    std::array<std::size_t, kMostTentSamples> from;
  };
  std::array<Target, kQuadrants> targets;
  std::array<Row, kQuadrants> a{};
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    Target& t = targets[k];
    t.samples = samples_around(k, velocity, t.from);
    a[k][k] = 1;
    if (!weigh(t.samples)) t.samples.count = 0;
    for (int i = 0; i < t.samples.count; ++i)
      a[k][t.from[std::size_t(i)]] -= (1 - alpha) * t.samples.weight[std::size_t(i)];
  }
  SteadyKernels out;
  for (int axis = 0; axis < 2; ++axis) {
    Row b{};
    for (std::size_t k = 0; k < kQuadrants; ++k)
      for (int i = 0; i < targets[k].samples.count; ++i)
        b[k] +=
            (1 - alpha) * targets[k].samples.weight[std::size_t(i)] * targets[k].samples.place[std::size_t(i)][axis];
    const Row mean = solve(a, b);
    Row c;
    c.fill(alpha * kQuarterVariance);
    for (std::size_t k = 0; k < kQuadrants; ++k)
      for (int i = 0; i < targets[k].samples.count; ++i) {
        const auto n = std::size_t(i);
        const double d = targets[k].samples.place[n][axis], w = targets[k].samples.weight[n];
        c[k] += (1 - alpha) * w * (2 * d * mean[targets[k].from[n]] + d * d);
      }
    const Row second = solve(a, c);
    for (std::size_t k = 0; k < kQuadrants; ++k) out.mean[k][axis] = mean[k], out.second[k][axis] = second[k];
  }
  return out;
}

double largest_moment(const SteadyKernels& kernels) {
  double most = 0;
  for (const glm::dvec2& q : kernels.second) most = std::max(most, (q.x + q.y) / 2);
  return most;
}

double picture_moment(const SteadyKernels& kernels, double alpha) {
  double sum = 0;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const glm::dvec2 &q = kernels.second[k], &m = kernels.mean[k], &middle = kQuadrantMiddle[k];
    const double before = alpha < 1 ? ((q.x + q.y) / 2 - alpha * kQuarterVariance) / (1 - alpha) : 0;
    sum += before + middle.x * m.x + middle.y * m.y;
  }
  return sum / double(kQuadrants) + kQuartersApart;
}

double least_alpha(double limit, const std::function<double(double alpha)>& moment) {
  double low = 1e-3, high = 1;
  if (moment(low) <= limit) return low;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (moment(middle) <= limit ? high : low) = middle;
  }
  return high;
}

double BlurTable::at(const glm::dvec2& velocity) const {
  const auto fold = [](double v) {
    const double f = v - std::floor(v);
    return std::min(f, 1 - f) * 2 * (kSteps - 1);
  };
  const double x = fold(velocity.x), y = fold(velocity.y);
  if (!(x >= 0 && y >= 0)) return 0;
  const auto x0 = std::size_t(std::min(x, double(kSteps - 2))), y0 = std::size_t(std::min(y, double(kSteps - 2)));
  return std::max({alpha[y0][x0], alpha[y0][x0 + 1], alpha[y0 + 1][x0], alpha[y0 + 1][x0 + 1]});
}

BlurTable tabulate_blur(double limit, const WeighSamples& weigh) {
  BlurTable table;
  for (int j = 0; j < BlurTable::kSteps; ++j)
    for (int i = 0; i < BlurTable::kSteps; ++i) {
      // A little beside the places where the grids of samples coincide.
      const glm::dvec2 v(i / (2.0 * (BlurTable::kSteps - 1)) + 1e-4, j / (2.0 * (BlurTable::kSteps - 1)) + 2e-4);
      table.alpha[std::size_t(j)][std::size_t(i)] =
          least_alpha(limit, [&](double a) { return picture_moment(steady_kernels(v, a, weigh), a); });
    }
  return table;
}

}  // namespace varve
