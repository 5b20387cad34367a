#include "resolve/resampling_kernel.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace varve {
namespace {

double cubic(double b, double c, double x) {
  const double t = std::abs(x), t2 = t * t, t3 = t2 * t;
  if (t < 1) return ((12 - 9 * b - 6 * c) * t3 + (12 * b + 6 * c - 18) * t2 + (6 - 2 * b)) / 6;
  if (t < 2) return ((-b - 6 * c) * t3 + (6 * b + 30 * c) * t2 - (12 * b + 48 * c) * t + (8 * b + 24 * c)) / 6;
  return 0;
}

double quintic_bspline(double x) {
  const double t = std::abs(x), t2 = t * t, t3 = t2 * t, t4 = t2 * t2, t5 = t4 * t;
  if (t < 1) return (66 - 60 * t2 + 30 * t4 - 10 * t5) / 120;
  if (t < 2) return (51 + 75 * t - 210 * t2 + 150 * t3 - 45 * t4 + 5 * t5) / 120;
  if (!(t < 3)) return 0;
  const double u = 3 - t, u2 = u * u;
  return u2 * u2 * u / 120;
}

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

/// Weights of the pixels first, first + 1, ...
struct Kernel {
  int first;
  std::vector<double> w;
};

double gain_at(const Kernel& kernel, double frequency, double fraction) {
  std::complex<double> sum = 0;
  for (std::size_t k = 0; k < kernel.w.size(); ++k)
    sum += kernel.w[k] *
           std::polar(1.0, -2 * std::numbers::pi * frequency * (kernel.first + static_cast<double>(k) - fraction));
  return std::abs(sum);
}

/// Looks at a grid, then ever closer around the best of it.
template <class At>
LargestGain largest_gain(At kernel_at) {
  LargestGain best;
  const auto look = [&](double frequency, double fraction) {
    frequency = std::clamp(frequency, 0.0, 0.5);
    fraction = std::clamp(fraction, 0.0, 0.5);  // the other half mirrors it
    const double gain = gain_at(kernel_at(fraction), frequency, fraction);
    if (gain > best.gain) best = {gain, frequency, fraction};
  };
  for (int i = 0; i <= 32; ++i)
    for (int k = 0; k <= 128; ++k) look(k / 256.0, i / 64.0);
  double step = 1 / 64.0;
  for (int halving = 0; halving < 24; ++halving) {
    step /= 2;
    const LargestGain from = best;
    for (const double df : {-step, 0.0, step})
      for (const double dv : {-step, 0.0, step}) look(from.frequency + df, from.fraction + dv);
  }
  return best;
}

}  // namespace

CubicWeights cubic_weights(double b, double c, double f) {
  return {{cubic(b, c, 1 + f), cubic(b, c, f), cubic(b, c, 1 - f), cubic(b, c, 2 - f)}};
}

BsplineWeights bspline_weights(int degree, double f) {
  if (degree == 3) {
    const CubicWeights w = cubic_weights(1, 0, f);
    return {{w.w[0], w.w[1], w.w[2], w.w[3], 0, 0}};
  }
  return {{quintic_bspline(2 + f), quintic_bspline(1 + f), quintic_bspline(f), quintic_bspline(1 - f),
           quintic_bspline(2 - f), quintic_bspline(3 - f)}};
}

LargestGain cubic_gain(double b, double c) {
  return largest_gain([b, c](double fraction) {
    const CubicWeights w = cubic_weights(b, c, fraction);
    return Kernel{-1, {w.w[0], w.w[1], w.w[2], w.w[3]}};
  });
}

LargestGain lanczos_gain(int lobes) {
  return largest_gain([lobes](double fraction) {
    Kernel kernel{1 - lobes, {}};
    double sum = 0;
    for (int k = 1 - lobes; k <= lobes; ++k) {
      const double x = k - fraction, w = std::abs(x) < lobes ? sinc(x) * sinc(x / lobes) : 0;
      kernel.w.push_back(w);
      sum += w;
    }
    for (double& w : kernel.w) w /= sum;
    return kernel;
  });
}

// Rounding stays far below this; a gain of 1 + 1e-9 would take as many frames to show.
bool is_expansive(const LargestGain& gain) { return !(gain.gain <= 1 + 1e-9); }

double critical_alpha(const LargestGain& gain) { return 1 - 1 / (gain.gain * gain.gain); }

}  // namespace varve
