// Distance of a picture from its reference, as the development figures count it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "read_rgb.h"

namespace varve::tools {

struct Sums {
  double tone = 0, linear = 0;
  std::size_t values = 0, not_finite = 0;
};

inline void add_squares(const Rgb& reference, const Rgb& test, Sums& sums) {
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < reference.planes[c].size(); ++i) {
      const double r = std::max(0.0, double(reference.planes[c][i])), t = std::max(0.0, double(test.planes[c][i]));
      ++sums.values;
      if (!std::isfinite(test.planes[c][i])) {
        ++sums.not_finite;  // the worst there is, so that it cannot improve a figure
        sums.tone += 1;
        sums.linear += 1;
        continue;
      }
      const double tone = t / (1 + t) - r / (1 + r), linear = std::min(1.0, t) - std::min(1.0, r);
      sums.tone += tone * tone;
      sums.linear += linear * linear;
    }
}

inline double decibels(double squares, std::size_t values) { return -10 * std::log10(squares / double(values)); }

}  // namespace varve::tools
