#include "resolve/bspline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace varve {
namespace {

/// A B-spline of one degree at the pixels, and the roots of its inverse inside the unit circle.
struct Inverse {
  double near, far;  ///< weight of the neighbors one and two pixels away; the rest is the pixel's own
  std::vector<double> poles;
};

Inverse inverse_of(int degree) {
  if (degree == 3) return {1.0 / 6, 0, {std::sqrt(3.0) - 2}};
  const double a = std::sqrt(67.5 - std::sqrt(4436.25)), b = std::sqrt(67.5 + std::sqrt(4436.25));
  return {26.0 / 120, 1.0 / 120, {a + std::sqrt(105.0) / 2 - 6.5, b - std::sqrt(105.0) / 2 - 6.5}};
}

/// Position in a line of `n` that goes on mirrored about its ends.
std::ptrdiff_t mirrored(std::ptrdiff_t i, std::ptrdiff_t n) {
  if (i >= 0 && i < n) return i;
  if (n == 1) return 0;
  const std::ptrdiff_t period = 2 * n - 2;
  i = ((i % period) + period) % period;
  return i < n ? i : period - i;
}

/// `lanes` lines of `n` values side by side: value i of a line lies `lanes` after value i - 1.
struct Lines {
  std::ptrdiff_t n, lanes;
  std::vector<double> value, work;

  Lines(std::ptrdiff_t length, std::ptrdiff_t count)
      : n(length), lanes(count), value(std::size_t(length * count)), work(std::size_t(length * count)) {}
  double* at(std::vector<double>& v, std::ptrdiff_t i) { return v.data() + i * lanes; }
};

/// One pole: a pass forward and one back. The start is the sum that a mirrored line makes of all that came before.
void run_pole(Lines& lines, double z) {
  const std::ptrdiff_t n = lines.n, m = lines.lanes;
  const double gain = (1 - z) * (1 - 1 / z);
  const auto horizon = std::ptrdiff_t(std::ceil(std::log(1e-18) / std::log(std::abs(z))));
  std::vector<double> start(std::size_t(m), 0.0);
  for (std::ptrdiff_t k = horizon; k >= 0; --k) {
    const double* s = lines.at(lines.work, mirrored(k, n));
    for (std::ptrdiff_t i = 0; i < m; ++i) start[std::size_t(i)] = start[std::size_t(i)] * z + s[i];
  }
  std::copy(start.begin(), start.end(), lines.at(lines.work, 0));
  for (std::ptrdiff_t k = 1; k < n; ++k) {
    double* s = lines.at(lines.work, k);
    for (std::ptrdiff_t i = 0; i < m; ++i) s[i] += z * s[i - m];
  }
  double* last = lines.at(lines.work, n - 1);
  for (std::ptrdiff_t i = 0; i < m; ++i) last[i] = z / (z * z - 1) * (last[i] + z * last[i - m]);
  for (std::ptrdiff_t k = n - 2; k >= 0; --k) {
    double* s = lines.at(lines.work, k);
    for (std::ptrdiff_t i = 0; i < m; ++i) s[i] = z * (s[i + m] - s[i]);
  }
  for (double& v : lines.work) v *= gain;
}

/// value <- coefficients. What the inverse adds to the values is filtered, not the values: it is made of differences,
/// so that a constant stays that constant.
void invert(Lines& lines, const Inverse& inverse) {
  const std::ptrdiff_t n = lines.n, m = lines.lanes;
  if (n < 2) return;
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const double *here = lines.at(lines.value, k), *left = lines.at(lines.value, mirrored(k - 1, n)),
                 *right = lines.at(lines.value, mirrored(k + 1, n)), *left2 = lines.at(lines.value, mirrored(k - 2, n)),
                 *right2 = lines.at(lines.value, mirrored(k + 2, n));
    double* out = lines.at(lines.work, k);
    for (std::ptrdiff_t i = 0; i < m; ++i)
      out[i] = -inverse.near * ((left[i] - here[i]) + (right[i] - here[i])) -
               inverse.far * ((left2[i] - here[i]) + (right2[i] - here[i]));
  }
  for (const double z : inverse.poles) run_pole(lines, z);
  for (std::size_t i = 0; i < lines.value.size(); ++i) lines.value[i] += lines.work[i];
}

float held(double v) {
  constexpr double limit = std::numeric_limits<float>::max();
  return float(std::clamp(v, -limit, limit));
}

}  // namespace

Plane<glm::vec4> bspline_coefficients(const Plane<glm::vec4>& color, int degree, Workers& workers) {
  const Window& w = color.window();
  const Inverse inverse = inverse_of(degree);
  Plane<glm::vec4> out(w);
  if (w.empty()) return out;
  std::vector<Lines> rows(std::size_t(workers.count()), Lines(w.width(), 4));
  workers.for_each(std::size_t(w.height()), [&](std::size_t y, int worker) {
    Lines& line = rows[std::size_t(worker)];
    const glm::vec4* from = color.row(w.y0 + int(y));
    for (int x = 0; x < w.width(); ++x)
      for (int k = 0; k < 4; ++k) line.at(line.value, x)[k] = double(from[x][k]);
    invert(line, inverse);
    glm::vec4* to = out.row(w.y0 + int(y));
    for (int x = 0; x < w.width(); ++x)
      for (int k = 0; k < 4; ++k) to[x][k] = held(line.at(line.value, x)[k]);
  });
  constexpr int kStrip = 4;  // pixels: a cache line
  std::vector<Lines> strips(std::size_t(workers.count()), Lines(w.height(), 4 * kStrip));
  workers.for_each(std::size_t((w.width() + kStrip - 1) / kStrip), [&](std::size_t strip, int worker) {
    Lines& lines = strips[std::size_t(worker)];
    const int begin = int(strip) * kStrip, count = std::min(kStrip, w.width() - begin);
    for (int y = 0; y < w.height(); ++y)
      for (int i = 0; i < 4 * count; ++i) lines.at(lines.value, y)[i] = double(out.row(w.y0 + y)[begin + i / 4][i % 4]);
    invert(lines, inverse);
    for (int y = 0; y < w.height(); ++y)
      for (int i = 0; i < 4 * count; ++i) out.row(w.y0 + y)[begin + i / 4][i % 4] = held(lines.at(lines.value, y)[i]);
  });
  return out;
}

}  // namespace varve
