#include "reference/history_filter_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace varve::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// As printed in the paper of 1988, equation 8.
double mitchell_netravali(double x, double b, double c) {
  x = std::abs(x);
  if (x < 1) return ((12 - 9 * b - 6 * c) * std::pow(x, 3) + (-18 + 12 * b + 6 * c) * std::pow(x, 2) + (6 - 2 * b)) / 6;
  if (x < 2)
    return ((-b - 6 * c) * std::pow(x, 3) + (6 * b + 30 * c) * std::pow(x, 2) + (-12 * b - 48 * c) * x +
            (8 * b + 24 * c)) /
           6;
  return 0;
}

/// Centered B-spline: each degree from the one below.
double bspline(int degree, double x) {
  if (degree == 0) return x >= -0.5 && x < 0.5 ? 1 : 0;
  const double half = (degree + 1) / 2.0;
  return ((half + x) * bspline(degree - 1, x + 0.5) + (half - x) * bspline(degree - 1, x - 0.5)) / degree;
}

int mirrored(int i, int n) {
  if (n == 1) return 0;
  while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;
  return i;
}

/// Solves for coefficients whose spline meets `values`: Gauss, with pivots.
std::vector<double> solve_line(const std::vector<double>& values, int degree) {
  const int n = int(values.size());
  using Row = std::vector<long double>;
  std::vector<Row> m(std::size_t(n), Row(std::size_t(n) + 1, 0));
  for (int i = 0; i < n; ++i) {
    for (int k = -degree / 2; k <= degree / 2; ++k)
      m[std::size_t(i)][std::size_t(mirrored(i + k, n))] += static_cast<long double>(bspline(degree, k));
    m[std::size_t(i)][std::size_t(n)] = static_cast<long double>(values[std::size_t(i)]);
  }
  for (int column = 0; column < n; ++column) {
    const auto pivot = std::max_element(m.begin() + column, m.end(), [&](const Row& a, const Row& b) {
      return std::abs(a[std::size_t(column)]) < std::abs(b[std::size_t(column)]);
    });
    std::iter_swap(m.begin() + column, pivot);
    for (int i = 0; i < n; ++i) {
      if (i == column) continue;
      const long double f = m[std::size_t(i)][std::size_t(column)] / m[std::size_t(column)][std::size_t(column)];
      for (int k = column; k <= n; ++k) m[std::size_t(i)][std::size_t(k)] -= f * m[std::size_t(column)][std::size_t(k)];
    }
  }
  std::vector<double> out;
  for (int i = 0; i < n; ++i)
    out.push_back(double(m[std::size_t(i)][std::size_t(n)] / m[std::size_t(i)][std::size_t(i)]));
  return out;
}

}  // namespace

double cubic_at(const Plane<glm::vec4>& color, double b, double c, double x, double y, int channel, bool dering) {
  const int bx = int(std::floor(x)), by = int(std::floor(y));
  double sum = 0, low = kInfinity, high = -kInfinity;
  for (int j = by - 1; j <= by + 2; ++j)
    for (int i = bx - 1; i <= bx + 2; ++i) {
      const double wx = mitchell_netravali(i - x, b, c), wy = mitchell_netravali(j - y, b, c);
      const double value = color.at(i, j)[channel];
      sum += wx * wy * value;
      const bool nearest = (i == bx || i == bx + 1) && (j == by || j == by + 1);
      // Weights that are 0 but for rounding decide nothing that shows.
      if (nearest || (wx > 0 && wy > 0)) low = std::min(low, value), high = std::max(high, value);
    }
  return dering || channel == 3 ? std::clamp(sum, low, high) : sum;
}

Plane<glm::dvec4> solve_bspline(const Plane<glm::vec4>& color, int degree) {
  const Window& w = color.window();
  Plane<glm::dvec4> out(w);
  for (int k = 0; k < 4; ++k) {
    for (int y = w.y0; y < w.y1; ++y) {
      std::vector<double> line;
      for (int x = w.x0; x < w.x1; ++x) line.push_back(double(color.at(x, y)[k]));
      line = solve_line(line, degree);
      for (int x = w.x0; x < w.x1; ++x) out.at(x, y)[k] = line[std::size_t(x - w.x0)];
    }
    for (int x = w.x0; x < w.x1; ++x) {
      std::vector<double> line;
      for (int y = w.y0; y < w.y1; ++y) line.push_back(out.at(x, y)[k]);
      line = solve_line(line, degree);
      for (int y = w.y0; y < w.y1; ++y) out.at(x, y)[k] = line[std::size_t(y - w.y0)];
    }
  }
  return out;
}

double bspline_at(const Plane<glm::dvec4>& coefficients, const Plane<glm::vec4>& color, int degree, double x, double y,
                  int channel, bool dering) {
  const Window& w = color.window();
  const int bx = int(std::floor(x)), by = int(std::floor(y));
  double sum = 0;
  for (int j = by - 3; j <= by + 4; ++j)
    for (int i = bx - 3; i <= bx + 4; ++i)
      sum += bspline(degree, i - x) * bspline(degree, j - y) *
             coefficients.at(w.x0 + mirrored(i - w.x0, w.width()), w.y0 + mirrored(j - w.y0, w.height()))[channel];
  if (!dering && channel < 3) return sum;
  double low = kInfinity, high = -kInfinity;
  for (int j = by; j <= by + 1; ++j)
    for (int i = bx; i <= bx + 1; ++i) {
      low = std::min(low, double(color.at(i, j)[channel]));
      high = std::max(high, double(color.at(i, j)[channel]));
    }
  return std::clamp(sum, low, high);
}

glm::dvec4 unjittered(const Present& present, glm::dvec2 jitter, int x, int y) {
  const glm::dvec4 own(present.color.at(x, y));
  if (!(present.valid.at(x, y) > 0)) return own;
  glm::dvec4 sum(0.0);
  double weights = 0;
  for (int j = y - 2; j <= y + 2; ++j)
    for (int i = x - 2; i <= x + 2; ++i) {
      if (!present.color.window().contains(i, j) || !(present.valid.at(i, j) > 0)) continue;
      const double w = std::max(0.0, 1 - std::abs(i + jitter.x - x)) * std::max(0.0, 1 - std::abs(j + jitter.y - y));
      sum += w * glm::dvec4(present.color.at(i, j));
      weights += w;
    }
  return weights > 0 ? sum / weights : own;
}

glm::dvec4 sharpened(const Plane<glm::vec4>& color, const Plane<float>& total, double strength, int x, int y) {
  glm::dvec4 out(color.at(x, y));
  if (!(total.at(x, y) > 0)) return out;
  for (int k = 0; k < 3; ++k) {
    double low = kInfinity, high = -kInfinity, mean = 0;
    int neighbors = 0;
    for (int j = y - 1; j <= y + 1; ++j)
      for (int i = x - 1; i <= x + 1; ++i) {
        if (!color.window().contains(i, j) || !(total.at(i, j) > 0)) continue;
        const double v = color.at(i, j)[k];
        low = std::min(low, v), high = std::max(high, v);
        if (std::abs(i - x) + std::abs(j - y) == 1) mean += v, ++neighbors;
      }
    if (neighbors == 0 || (low == 0 && high == 0)) continue;
    const double contrast = (high - low) / (std::abs(high) + std::abs(low));
    out[k] = std::clamp(out[k] + strength * (1 - contrast) * (out[k] - mean / neighbors), low, high);
  }
  return out;
}

}  // namespace varve::reference
