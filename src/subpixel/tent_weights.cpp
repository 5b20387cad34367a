#include "subpixel/tent_weights.h"

#include <algorithm>
#include <cmath>

namespace varve {
namespace {

constexpr double kLargestCondition = 1e6, kLargestGain = 1.5;  // of first-order weights
// px: a centroid as near as this is left alone. It is tracked, so that what is left does not add up.
constexpr double kNoOffset = 0.05;

/// Sums over the tent: weights, and first and second moments of the centers.
struct TentSums {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

TentSums tent_of(TentSamples& s, double radius) {
  TentSums sums;
  const double slope = 1 / radius;
  for (int i = 0; i < s.count; ++i) {
    const auto k = std::size_t(i);
    const double tx = 1 - std::abs(s.place[k].x) * slope, ty = 1 - std::abs(s.place[k].y) * slope;
    const double w = std::max(0.0, tx) * std::max(0.0, ty);
    const double wx = w * s.center[k].x, wy = w * s.center[k].y;
    s.tent[k] = w;
    sums.w += w;
    sums.x += wx;
    sums.y += wy;
    sums.xx += wx * s.center[k].x;
    sums.xy += wx * s.center[k].y;
    sums.yy += wy * s.center[k].y;
  }
  return sums;
}

void normalize(TentSamples& s, const TentSums& sums) {
  const double scale = 1 / sums.w;
  for (int i = 0; i < s.count; ++i) s.weight[std::size_t(i)] = s.tent[std::size_t(i)] * scale;
}

/// Whether first-order weights are well determined; they are filled in then.
bool first_order(TentSamples& s, const TentSums& m) {
  // Minimizing sum w (p(d) - f)^2 over linear p: the value at 0 is sum w (c0 + c . d) f.
  const double det = m.xx * m.yy - m.xy * m.xy, trace = m.xx + m.yy;
  // The ratio of the eigenvalues of a 2x2 matrix lies between trace^2 / det - 2 and that number.
  if (!(det * kLargestCondition > trace * trace)) return false;
  const double ax = (m.yy * m.x - m.xy * m.y) / det, ay = (m.xx * m.y - m.xy * m.x) / det;
  const double left = m.w - (m.x * ax + m.y * ay);
  if (!(left * kLargestCondition > m.w)) return false;
  const double c0 = 1 / left, cx = -ax * c0, cy = -ay * c0;
  double gain = 0;
  for (int i = 0; i < s.count; ++i) {
    const auto k = std::size_t(i);
    s.weight[k] = s.tent[k] * (c0 + cx * s.center[k].x + cy * s.center[k].y);
    gain += std::abs(s.weight[k]);
  }
  return gain <= kLargestGain;
}

/// The same for parabolas: sum w' d_i d_j = 0 as well, so that reading adds nothing to the second moment.
bool second_order(TentSamples& s) {
  constexpr int n = 6;
  double m[n][n] = {}, c[n] = {};
  const auto basis = [&](int i, double(&b)[n]) {
    const glm::dvec2 d = s.center[std::size_t(i)];
    b[0] = 1, b[1] = d.x, b[2] = d.y, b[3] = d.x * d.x, b[4] = d.x * d.y, b[5] = d.y * d.y;
  };
  for (int i = 0; i < s.count; ++i) {
    const double w = s.tent[std::size_t(i)];
    if (!(w > 0)) continue;
    double b[n];
    basis(i, b);
    for (int r = 0; r < n; ++r)
      for (int k = 0; k <= r; ++k) m[r][k] += w * b[r] * b[k];
  }
  // Cholesky; then m c = (1, 0, ...).
  const double scale = m[0][0];
  for (int r = 0; r < n; ++r)
    for (int k = 0; k <= r; ++k) {
      double sum = m[r][k];
      for (int q = 0; q < k; ++q) sum -= m[r][q] * m[k][q];
      if (k < r) {
        m[r][k] = sum / m[k][k];
      } else {
        if (!(sum > 1e-6 * scale)) return false;
        m[r][r] = std::sqrt(sum);
      }
    }
  for (int r = 0; r < n; ++r) {
    double sum = r == 0 ? 1 : 0;
    for (int q = 0; q < r; ++q) sum -= m[r][q] * c[q];
    c[r] = sum / m[r][r];
  }
  for (int r = n; r-- > 0;) {
    double sum = c[r];
    for (int q = r + 1; q < n; ++q) sum -= m[q][r] * c[q];
    c[r] = sum / m[r][r];
  }
  double gain = 0;
  for (int i = 0; i < s.count; ++i) {
    double b[n], p = 0;
    basis(i, b);
    for (int r = 0; r < n; ++r) p += c[r] * b[r];
    s.weight[std::size_t(i)] = s.tent[std::size_t(i)] * p;
    gain += std::abs(s.weight[std::size_t(i)]);
  }
  return gain <= kLargestGain;
}

bool is_centered(const TentSums& m) { return std::abs(m.x) <= kNoOffset * m.w && std::abs(m.y) <= kNoOffset * m.w; }

}  // namespace

bool weigh_samples_once(TentSamples& samples, double radius, SubpixelWeights weights) {
  const TentSums sums = tent_of(samples, weights == SubpixelWeights::bilinear ? 1 : radius);
  if (!(sums.w > 0)) return false;
  if (weights != SubpixelWeights::first_order || !first_order(samples, sums)) normalize(samples, sums);
  return true;
}

bool weigh_samples_around(TentSamples& samples, double radius, SubpixelWeights weights) {
  constexpr double kStep = 0.125, kWidest = 1;  // px
  if (weights == SubpixelWeights::bilinear) radius = kWidest;
  if (weights == SubpixelWeights::second_order) {
    for (double r = std::max(radius, 0.75); r <= kWidest; r += kStep) {
      tent_of(samples, r);
      if (second_order(samples)) return true;
    }
    weights = SubpixelWeights::first_order;
  }
  for (double r = radius; r <= kWidest; r = r < kWidest ? std::min(kWidest, r + kStep) : r + kStep) {
    const TentSums sums = tent_of(samples, r);
    if (!(sums.w > 0)) continue;
    if (weights != SubpixelWeights::first_order || is_centered(sums)) {
      normalize(samples, sums);
      return true;
    }
    if (first_order(samples, sums)) return true;
    if (r < kWidest) continue;
    normalize(samples, sums);
    return true;
  }
  return false;
}

}  // namespace varve
