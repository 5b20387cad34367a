#include "diagnose/channel_difference.h"

#include <algorithm>
#include <cmath>

namespace varve {

ChannelDifference& ChannelDifference::operator+=(const ChannelDifference& more) {
  values += more.values;
  differing += more.differing;
  not_finite += more.not_finite;
  bad_a += more.bad_a;
  bad_b += more.bad_b;
  greatest = std::max(greatest, more.greatest);
  absolute += more.absolute;
  squares += more.squares;
  finite += more.finite;
  return *this;
}

double ChannelDifference::rmse() const { return finite ? std::sqrt(squares / double(finite)) : 0; }

ChannelDifference difference_of(std::span<const double> a, std::span<const double> b, bool nan_equal) {
  ChannelDifference sums;
  sums.values = a.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool finite_a = std::isfinite(a[i]), finite_b = std::isfinite(b[i]);
    if (finite_a && finite_b) {
      const double d = b[i] - a[i];
      sums.differing += d != 0 || std::signbit(a[i]) != std::signbit(b[i]);  // 0 and -0 are not the same bits
      sums.greatest = std::max(sums.greatest, std::abs(d));
      sums.absolute += std::abs(d);
      sums.squares += d * d;
      ++sums.finite;
      continue;
    }
    sums.bad_a += !finite_a;
    sums.bad_b += !finite_b;
    const bool same = a[i] == b[i] || (nan_equal && std::isnan(a[i]) && std::isnan(b[i]));
    if (same) continue;
    ++sums.differing;
    ++sums.not_finite;
    sums.greatest = INFINITY;
  }
  return sums;
}

}  // namespace varve
