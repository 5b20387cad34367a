// The middle of a list of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace varve {

/// The value that half of the others are not above; of an even number the greater of the two in the middle. `if_none`
/// of an empty list. No value may be NaN.
template <class Number>
Number upper_median(std::vector<Number> values, Number if_none = 0) {
  if (values.empty()) return if_none;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace varve
