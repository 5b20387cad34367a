// Where in and around a pixel the samples of truth lie.
#pragma once

#include <vector>

namespace varve::synth {

/// Pixel filters: box of one pixel; Gaussian of sigma 0.5, cut at 1.5 pixels; four-term Blackman-Harris window over 3
/// pixels (Harris 1978).
enum class Filter { box, gaussian, blackman_harris };

/// A filter as positions: samples placed by it count all the same.
class FilterPositions {
 public:
  explicit FilterPositions(Filter filter);
  /// Distance from the pixel center, pixels, for a share 0 <= share < 1 of the filter's weight; ascending.
  double operator()(double share) const {
    if (table_.empty()) return share - 0.5;
    const double at = share * double(table_.size() - 1);
    const std::size_t i = std::size_t(at);
    return table_[i] + (at - double(i)) * (table_[i + 1] - table_[i]);
  }

 private:
  std::vector<double> table_;  // empty: box
};

}  // namespace varve::synth
