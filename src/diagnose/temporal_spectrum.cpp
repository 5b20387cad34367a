#include "diagnose/temporal_spectrum.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "diagnose/row_sums.h"

namespace varve {

void TemporalSpectrum::add(const ColorPair& pair, bool restart, Workers& workers) {
  const Window window = pair.window();
  if (restart || (!errors_.empty() && errors_.back().window() != window)) errors_.clear();
  Plane<float> error(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x)
      error.row(y)[x] = luminance(pair.b.row(y)[x]) - luminance(pair.a.row(y)[x]);
  });
  errors_.push_back(std::move(error));
  if (int(errors_.size()) < kStretch) return;
  power_ += measure(workers);
  measured_ = true;
  errors_.erase(errors_.begin(), errors_.begin() + kStretch / 2);
}

TemporalSpectrum::Power TemporalSpectrum::measure(Workers& workers) const {
  const std::size_t n = errors_.size(), bins = n / 2 + 1;
  // Window and Fourier terms in one: rows of cosines and sines. The Hann window is the periodic one, under which a
  // steady error reaches bins 0 and 1 only.
  std::vector<double> cosines(bins * n), sines(bins * n);
  for (std::size_t k = 0; k < bins; ++k)
    for (std::size_t t = 0; t < n; ++t) {
      const double turn = 2 * std::numbers::pi / double(n);
      const double hann = 0.5 - 0.5 * std::cos(turn * double(t));
      cosines[k * n + t] = hann * std::cos(turn * double(k * t % n));
      sines[k * n + t] = hann * std::sin(turn * double(k * t % n));
    }
  const Window window = errors_.front().window();
  return sum_rows<Power>(window, workers, [&](int y) {
    Power sums;
    std::vector<double> e(n);
    for (int x = 0; x < window.width(); ++x) {
      for (std::size_t t = 0; t < n; ++t) e[t] = double(errors_[t].row(y)[x]);
      for (std::size_t k = 0; k < bins; ++k) {
        double re = 0, im = 0;
        for (std::size_t t = 0; t < n; ++t) {
          re += cosines[k * n + t] * e[t];
          im += sines[k * n + t] * e[t];
        }
        // Bins between the ends stand for their mirror images too.
        const double power = (re * re + im * im) * (k == 0 || 2 * k == n ? 1 : 2);
        sums.all += power;
        if (8 * k >= n) sums.fast += power;
      }
    }
    return sums;
  });
}

double TemporalSpectrum::fast_share(Workers& workers) const {
  Power power = power_;
  if (!measured_) {
    if (int(errors_.size()) < kShortest) return std::numeric_limits<double>::quiet_NaN();
    power = measure(workers);
  }
  return power.all > 0 ? power.fast / power.all : 0;
}

}  // namespace varve
