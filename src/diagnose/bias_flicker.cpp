#include "diagnose/bias_flicker.h"

#include <limits>

#include "diagnose/row_sums.h"

namespace varve {
namespace {

struct SplitSums {
  double bias = 0, flicker = 0;
  std::size_t values = 0;
  SplitSums& operator+=(const SplitSums& more) {
    bias += more.bias;
    flicker += more.flicker;
    values += more.values;
    return *this;
  }
};

}  // namespace

void BiasFlicker::add(const ColorPair& pair, Workers& workers) {
  const Window window = pair.window();
  if (moments_.empty() || moments_.window() != window) {
    if (!moments_.empty()) finished_ = current(workers);
    moments_ = Plane<Moments>(window, 0, Moments{});
  }
  workers.for_rows(window.y0, window.y1, [&](int y) {
    const glm::vec4 *a = pair.a.row(y), *b = pair.b.row(y);
    Moments* row = moments_.row(y);
    for (int x = 0; x < window.width(); ++x) {
      if (pair.bad.row(y)[x]) continue;
      Moments& m = row[x];
      m.count += 1;
      for (int c = 0; c < 3; ++c) {
        const double e = double(b[x][c]) - double(a[x][c]), d = e - m.mean[c];
        m.mean[c] += d / m.count;
        m.squares[c] += d * (e - m.mean[c]);
      }
    }
  });
}

BiasFlicker::Split BiasFlicker::current(Workers& workers) const {
  const Window window = moments_.window();
  const SplitSums sums = sum_rows<SplitSums>(window, workers, [&](int y) {
    SplitSums row;
    for (int x = 0; x < window.width(); ++x) {
      const Moments& m = moments_.row(y)[x];
      if (m.count < 2) continue;
      for (int c = 0; c < 3; ++c) {
        row.bias += m.mean[c] * m.mean[c];
        row.flicker += m.squares[c] / m.count;
      }
      row.values += 3;
    }
    return row;
  });
  return {finished_.bias + sums.bias, finished_.flicker + sums.flicker, finished_.values + sums.values};
}

BiasFlicker::Split BiasFlicker::split(Workers& workers) const {
  Split total = current(workers);
  const double n = total.values ? double(total.values) : std::numeric_limits<double>::quiet_NaN();
  total.bias /= n;
  total.flicker /= n;
  return total;
}

}  // namespace varve
