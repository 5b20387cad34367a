#include "diagnose/resting_offsets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace varve {
namespace {

constexpr std::size_t kLags = 9, kShapes = 12;
constexpr std::size_t kFewestPixels = 1000;
constexpr double kMost =
    0.1;  // tone: a larger difference counts as this one, so that what moves after all weighs little
constexpr double kStep = 1e-3;   // px, of the numeric derivative
constexpr double kFurthest = 1;  // px from the mean

/// Lower triangle of a symmetric positive definite matrix, in place; false where it is none.
bool decompose(std::vector<double>& a, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j; i < n; ++i) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j && !(sum > 0)) return false;
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
  return true;
}

void substitute(const std::vector<double>& l, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
}

/// Even functions that edges (in four directions), smooth and thin things make variograms of.
std::array<double, kShapes> shapes_at(double x, double y) {
  const double rr = x * x + y * y, ax = std::abs(x), ay = std::abs(y);
  return {ax,
          ay,
          std::abs(x + y),
          std::abs(x - y),
          x * x,
          y * y,
          x * y,
          x * x * x * x,
          y * y * y * y,
          1 - std::exp(-rr / (2 * 0.4 * 0.4)),
          1 - std::exp(-x * x / (2 * 0.5 * 0.5)),
          1 - std::exp(-y * y / (2 * 0.5 * 0.5))};
}

struct Observation {
  std::size_t now, before;
  double lag_x, lag_y, value, weight;
};

/// Mean square differences of two frames at whole lags.
std::array<double, kLags> differences(const Plane<float>& now, const Plane<float>& before,
                                      const Plane<std::uint8_t>& resting, std::size_t& pixels, Workers& workers) {
  const Window& w = resting.window();
  struct Row {
    std::array<double, kLags> sums{};
    std::size_t pixels = 0;
  };
  std::vector<Row> rows(std::size_t(std::max(0, w.height() - 2)));
  workers.for_rows(w.y0 + 1, w.y1 - 1, [&](int y) {
    Row& row = rows[std::size_t(y - w.y0 - 1)];
    for (int x = w.x0 + 1; x + 1 < w.x1; ++x) {
      if (!resting.at(x, y)) continue;
      std::array<double, kLags> squares;
      double sum = 0;
      for (std::size_t k = 0; k < kLags; ++k) {
        const double d = double(now.at(x + int(k % 3) - 1, y + int(k / 3) - 1)) - double(before.at(x, y));
        squares[k] = std::min(d * d, kMost * kMost);
        sum += d;
      }
      if (!std::isfinite(sum)) continue;
      for (std::size_t k = 0; k < kLags; ++k) row.sums[k] += squares[k];
      ++row.pixels;
    }
  });
  std::array<double, kLags> all{};
  pixels = 0;
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < kLags; ++k) all[k] += row.sums[k];
    pixels += row.pixels;
  }
  for (double& v : all) v /= double(std::max<std::size_t>(pixels, 1));
  return all;
}

/// What is left of the observations, relative, once the best variogram for these offsets is taken away.
std::vector<double> left_over(const std::vector<Observation>& seen, const std::vector<double>& offsets) {
  std::vector<double> design(seen.size() * kShapes), values(seen.size()), matrix(kShapes * kShapes), right(kShapes);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Observation& o = seen[i];
    const std::array<double, kShapes> shapes = shapes_at(o.lag_x + offsets[2 * o.now] - offsets[2 * o.before],
                                                         o.lag_y + offsets[2 * o.now + 1] - offsets[2 * o.before + 1]);
    std::copy(shapes.begin(), shapes.end(), design.begin() + std::ptrdiff_t(i * kShapes));
    values[i] = o.value;
  }
  // What a pair differs by at every lag is noise and change, and says nothing.
  for (std::size_t pair = 0; pair < seen.size(); pair += kLags) {
    const auto center = [&](auto at) {
      double sum = 0, weights = 0;
      for (std::size_t i = pair; i < pair + kLags; ++i) {
        const double w = seen[i].weight * seen[i].weight;
        sum += w * at(i), weights += w;
      }
      for (std::size_t i = pair; i < pair + kLags; ++i) at(i) = (at(i) - sum / weights) * seen[i].weight;
    };
    center([&](std::size_t i) -> double& { return values[i]; });
    for (std::size_t m = 0; m < kShapes; ++m) center([&](std::size_t i) -> double& { return design[i * kShapes + m]; });
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t m = 0; m < kShapes; ++m) {
      right[m] += design[i * kShapes + m] * values[i];
      for (std::size_t n = 0; n <= m; ++n) matrix[m * kShapes + n] += design[i * kShapes + m] * design[i * kShapes + n];
    }
  double trace = 0;
  for (std::size_t m = 0; m < kShapes; ++m) trace += matrix[m * kShapes + m];
  for (std::size_t m = 0; m < kShapes; ++m) matrix[m * kShapes + m] += 1e-4 * trace / kShapes;
  std::vector<double> left(seen.size());
  if (!decompose(matrix, kShapes)) return {};
  substitute(matrix, right);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    left[i] = values[i];
    for (std::size_t m = 0; m < kShapes; ++m) left[i] -= design[i * kShapes + m] * right[m];
  }
  return left;
}

double square_sum(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

/// Products of the derivatives of all that is left over, and of it with them; the first frame stays where it is.
void linearize(const std::vector<Observation>& seen, const std::vector<double>& offsets,
               const std::vector<double>& left, std::vector<double>& normal, std::vector<double>& gradient) {
  const std::size_t n = offsets.size() - 2;
  std::vector<std::vector<double>> slopes;
  for (std::size_t p = 0; p < n; ++p) {
    std::vector<double> a = offsets, b = offsets;
    a[p + 2] += kStep, b[p + 2] -= kStep;
    std::vector<double> slope = left_over(seen, a);
    const std::vector<double> other = left_over(seen, b);
    for (std::size_t i = 0; i < slope.size() && i < other.size(); ++i) slope[i] = (slope[i] - other[i]) / (2 * kStep);
    slope.resize(left.size());
    slopes.push_back(std::move(slope));
  }
  normal.assign(n * n, 0), gradient.assign(n, 0);
  for (std::size_t p = 0; p < n; ++p)
    for (std::size_t i = 0; i < left.size(); ++i) {
      gradient[p] -= slopes[p][i] * left[i];
      for (std::size_t q = 0; q <= p; ++q) normal[p * n + q] += slopes[p][i] * slopes[q][i];
    }
}

/// Levenberg and Marquardt. False where nothing can be solved.
bool fit(const std::vector<Observation>& seen, std::vector<double>& offsets, std::vector<double>& left) {
  left = left_over(seen, offsets);
  if (left.empty()) return false;
  double damping = 1e-2;
  for (int round = 0; round < 40; ++round) {
    std::vector<double> normal, gradient;
    linearize(seen, offsets, left, normal, gradient);
    const std::size_t n = gradient.size();
    bool better = false;
    double length = 0;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      std::vector<double> damped = normal, step = gradient, moved = offsets;
      for (std::size_t p = 0; p < n; ++p) damped[p * n + p] += damping * normal[p * n + p] + 1e-12;
      if (!decompose(damped, n)) return false;
      substitute(damped, step);
      length = 0;
      for (std::size_t p = 0; p < n; ++p) {
        step[p] = std::clamp(step[p], -0.2, 0.2);
        moved[p + 2] += step[p];
        length = std::max(length, std::abs(step[p]));
      }
      std::vector<double> now = left_over(seen, moved);
      better = !now.empty() && square_sum(now) <= square_sum(left);
      damping *= better ? 0.3 : 5;
      if (better) offsets = std::move(moved), left = std::move(now);
    }
    if (!better || length < 1e-4) break;
  }
  return true;
}

}  // namespace

RestingOffsets resting_offsets(std::span<const Plane<float>* const> tones, const Plane<std::uint8_t>& resting,
                               std::span<const glm::dvec2> start, Workers& workers) {
  RestingOffsets result;
  const std::size_t frames = tones.size();
  if (frames < kFewestAtRest || start.size() != frames) return result;
  std::vector<Observation> seen;
  for (std::size_t now = 1; now < frames; ++now)
    for (std::size_t before = 0; before < now; ++before) {
      std::size_t pixels = 0;
      const std::array<double, kLags> values = differences(*tones[now], *tones[before], resting, pixels, workers);
      if (pixels < kFewestPixels) return result;
      for (std::size_t k = 0; k < kLags; ++k)
        seen.push_back({now, before, double(k % 3) - 1, double(k / 3) - 1, values[k], 1});
    }
  double mean = 0;
  for (const Observation& o : seen) mean += o.value / double(seen.size());
  if (!(mean > 1e-9)) return result;
  for (Observation& o : seen) o.weight = 1 / (o.value + 0.1 * mean);

  std::vector<double> offsets(2 * frames);
  for (std::size_t i = 0; i < frames; ++i)
    if (std::isfinite(start[i].x)) offsets[2 * i] = start[i].x, offsets[2 * i + 1] = start[i].y;
  std::vector<double> left;
  if (!fit(seen, offsets, left)) return result;
  const double unknowns = double(offsets.size() - 2 + kShapes);
  const double variance = square_sum(left) / std::max(1.0, double(left.size()) - unknowns);
  result.misfit = std::sqrt(square_sum(left) / double(left.size()));

  std::vector<double> normal, gradient;
  linearize(seen, offsets, left, normal, gradient);
  const std::size_t n = gradient.size();
  if (!decompose(normal, n)) return result;
  glm::dvec2 center(0);
  for (std::size_t i = 0; i < frames; ++i) center += glm::dvec2(offsets[2 * i], offsets[2 * i + 1]) / double(frames);
  result.found = true;
  for (std::size_t i = 0; i < frames; ++i) {
    double error[2];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      // The first frame is as sure as the surest: its place is where the others are told from.
      std::vector<double> unit(n);
      const std::size_t p = i == 0 ? axis : 2 * (i - 1) + axis;
      unit[p] = 1;
      substitute(normal, unit);
      error[axis] = std::sqrt(std::max(unit[p] * variance, 0.0));
    }
    result.offsets.push_back(glm::dvec2(offsets[2 * i], offsets[2 * i + 1]) - center);
    result.sigma.push_back({error[0], error[1]});
    const glm::dvec2& o = result.offsets.back();
    result.found = result.found && std::abs(o.x) <= kFurthest && std::abs(o.y) <= kFurthest &&
                   std::isfinite(error[0]) && std::isfinite(error[1]);
  }
  return result;
}

}  // namespace varve
