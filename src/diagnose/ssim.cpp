#include "diagnose/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "diagnose/row_sums.h"
#include "diagnose/separable.h"

namespace varve {
namespace {

constexpr int kRadius = 5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

/// a, b, aa, bb, ab. In double, so that mean of squares minus square of mean keeps 12 digits of the variance.
struct Moments {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  void add(double weight, const Moments& m) {
    a += weight * m.a;
    b += weight * m.b;
    aa += weight * m.aa;
    bb += weight * m.bb;
    ab += weight * m.ab;
  }
};

Plane<float> toned_luminance(const Plane<glm::vec4>& color, Workers& workers) {
  const Window window = color.window();
  Plane<float> out(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x) {
      const float l = std::max(0.f, luminance(color.row(y)[x]));
      out.row(y)[x] = std::isfinite(l) ? l / (1 + l) : 1.f;
    }
  });
  return out;
}

double similarity(const Moments& m) {
  const double va = m.aa - m.a * m.a, vb = m.bb - m.b * m.b, covariance = m.ab - m.a * m.b;
  return (2 * m.a * m.b + kC1) * (2 * covariance + kC2) / ((m.a * m.a + m.b * m.b + kC1) * (va + vb + kC2));
}

}  // namespace

double ssim(const ColorPair& pair, Workers& workers) {
  const Plane<float> a = toned_luminance(pair.a, workers), b = toned_luminance(pair.b, workers);
  const Window window = pair.window();
  const int width = window.width();
  const Kernel kernel = gaussian_kernel(1.5, kRadius);
  const double total = sum_rows<double>(window, workers, [&](int y) {
    std::vector<Moments> columns(static_cast<std::size_t>(width));
    for (int k = -kRadius; k <= kRadius; ++k) {
      const int from = std::clamp(y + k, window.y0, window.y1 - 1);
      const float *ra = a.row(from), *rb = b.row(from);
      const double weight = double(kernel[std::size_t(k + kRadius)]);
      for (int x = 0; x < width; ++x) {
        const double va = double(ra[x]), vb = double(rb[x]);
        columns[std::size_t(x)].add(weight, {va, vb, va * va, vb * vb, va * vb});
      }
    }
    double sum = 0;
    for (int x = 0; x < width; ++x) {
      Moments m;
      for (int k = -kRadius; k <= kRadius; ++k)
        m.add(double(kernel[std::size_t(k + kRadius)]), columns[std::size_t(std::clamp(x + k, 0, width - 1))]);
      sum += pair.bad.row(y)[x] ? -1 : similarity(m);
    }
    return sum;
  });
  return total / double(window.pixels());
}

}  // namespace varve
