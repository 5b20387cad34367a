// Count, mean and centred second moment of colors, and their merge.
#pragma once

#include <algorithm>
#include <limits>

namespace varve {

/// Of RGBA samples; `n` may be a sum of weights. n = 0: nothing, mean 0.
struct Moments {
  double n = 0;
  double mean[4] = {0, 0, 0, 0};
  double m2[4] = {0, 0, 0, 0};
};

/// Both together (Chan, Golub and LeVeque 1983). Nothing is subtracted from a sum, so the second moment cannot become
/// negative and a highlight leaves no trace beside its window.
inline Moments merge(const Moments& a, const Moments& b) {
  Moments c;
  c.n = a.n + b.n;
  const double share = b.n > 0 ? b.n / c.n : 0, spread = a.n * share;
  for (int k = 0; k < 4; ++k) {
    const double d = b.mean[k] - a.mean[k];
    c.mean[k] = a.mean[k] + d * share;
    c.m2[k] = a.m2[k] + b.m2[k] + d * d * spread;
  }
  return c;
}

/// Least and greatest of RGBA samples; without any, low is above high.
struct Extremes {
  float low[4] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                  std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  float high[4] = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
};

inline Extremes merge(const Extremes& a, const Extremes& b) {
  Extremes c;
  for (int k = 0; k < 4; ++k) {
    c.low[k] = std::min(a.low[k], b.low[k]);
    c.high[k] = std::max(a.high[k], b.high[k]);
  }
  return c;
}

}  // namespace varve
