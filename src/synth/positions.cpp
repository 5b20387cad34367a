#include "synth/positions.h"

#include <cmath>
#include <cstddef>

namespace varve::synth {
namespace {

constexpr double kRadius = 1.5;  // pixels
constexpr double kSigma = 0.5;
constexpr double kPi = 3.141592653589793;

// Weight to the left of x, not normalized.
double weight_below(Filter filter, double x) {
  if (filter == Filter::gaussian) return std::erf(x / (kSigma * std::sqrt(2.0)));
  // Integral of a0 + a1 cos + a2 cos + a3 cos (window centered on 0).
  const double w = kPi * x / kRadius;
  return 0.35875 * w + 0.48829 * std::sin(w) + 0.14128 / 2 * std::sin(2 * w) + 0.01168 / 3 * std::sin(3 * w);
}

}  // namespace

FilterPositions::FilterPositions(Filter filter) {
  if (filter == Filter::box) return;
  constexpr int kSteps = 4096;
  const double lowest = weight_below(filter, -kRadius), all = weight_below(filter, kRadius) - lowest;
  for (int i = 0; i <= kSteps; ++i) {
    const double wanted = lowest + all * i / kSteps;
    double low = -kRadius, high = kRadius;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (low + high);
      (weight_below(filter, middle) < wanted ? low : high) = middle;
    }
    table_.push_back(0.5 * (low + high));
  }
}

}  // namespace varve::synth
