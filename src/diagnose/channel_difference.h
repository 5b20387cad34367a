// How two channels differ, value by value. What is not finite is counted before anything is averaged.
#pragma once

#include <cstddef>
#include <span>

namespace varve {

/// Sums over pairs of values; add rows with +=.
struct ChannelDifference {
  std::size_t values = 0;
  std::size_t differing =
      0;  ///< pairs that are not the same number, or zeros of other sign; NaN against NaN counts unless told otherwise
  std::size_t not_finite = 0;        ///< of these, pairs with a NaN or an infinity
  std::size_t bad_a = 0, bad_b = 0;  ///< NaN and infinities on each side, whether they differ or not
  double greatest = 0;               ///< largest |b - a|; +inf when a pair is not finite and differs
  double absolute = 0, squares = 0;  ///< of b - a over the finite pairs
  std::size_t finite = 0;

  ChannelDifference& operator+=(const ChannelDifference& more);
  double mean() const { return finite ? absolute / double(finite) : 0; }
  double rmse() const;
};

/// One stretch of both channels, in the order of the pixels. Infinities of the same sign are the same number.
ChannelDifference difference_of(std::span<const double> a, std::span<const double> b, bool nan_equal);

}  // namespace varve
