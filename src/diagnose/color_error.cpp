#include "diagnose/color_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/row_sums.h"

namespace varve {
namespace {

double clipped(float x) { return std::clamp(double(x), 0.0, 1.0); }
double toned(float x) {
  const double positive = std::max(0.0, double(x));
  return positive / (1 + positive);
}
double square(double x) { return x * x; }

}  // namespace

ColorError& ColorError::operator+=(const ColorError& more) {
  values += more.values;
  bad += more.bad;
  greatest = std::max(greatest, more.greatest);
  absolute += more.absolute;
  squares += more.squares;
  relative += more.relative;
  linear += more.linear;
  tone += more.tone;
  pu += more.pu;
  return *this;
}

double ColorError::over_good(double sum) const {
  return values > bad ? sum / double(values - bad) : std::numeric_limits<double>::quiet_NaN();
}
double ColorError::rmse() const { return std::sqrt(over_good(squares)); }
double ColorError::decibels(double sum) const {
  return values ? -10 * std::log10(sum / double(values)) : std::numeric_limits<double>::quiet_NaN();
}

ColorError color_error(const ColorPair& pair, double white, const PuTable& table, Workers& workers) {
  const Window window = pair.window();
  const double mean_luminance = sum_rows<double>(window, workers,
                                                 [&](int y) {
                                                   double sum = 0;
                                                   for (int x = 0; x < window.width(); ++x)
                                                     sum += double(luminance(pair.a.row(y)[x]));
                                                   return sum;
                                                 }) /
                                double(std::max<std::size_t>(1, window.pixels()));
  const double floor = 0.01 * square(mean_luminance), peak = pu_encode(white);
  const float to_nits = float(white);
  return sum_rows<ColorError>(window, workers, [&](int y) {
    ColorError sums;
    const glm::vec4 *ra = pair.a.row(y), *rb = pair.b.row(y);
    sums.values = 3 * std::size_t(window.width());
    for (int x = 0; x < window.width(); ++x) {
      if (pair.bad.row(y)[x]) {
        sums.bad += 3;
        sums.greatest = INFINITY;
        sums.linear += 3;
        sums.tone += 3;
        sums.pu += 3;
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        const float a = ra[x][c], b = rb[x][c];
        const double d = double(b) - double(a), squared = d * d;
        if (d == 0) continue;
        sums.greatest = std::max(sums.greatest, std::abs(d));
        sums.absolute += std::abs(d);
        sums.squares += squared;
        sums.relative += squared / (square(double(a)) + floor);
        sums.linear += square(clipped(b) - clipped(a));
        sums.tone += square(toned(b) - toned(a));
        sums.pu += square(double(table.encode(b * to_nits) - table.encode(a * to_nits)) / peak);
      }
    }
    return sums;
  });
}

}  // namespace varve
