#include "diagnose/separable.h"

#include <algorithm>
#include <cmath>

namespace varve {

Plane<float> convolve_rows(const Plane<float>& in, const Kernel& kernel, Workers& workers) {
  const Window window = in.window();
  const int radius = int(kernel.size() / 2), width = window.width();
  Plane<float> out(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    std::vector<float> padded(std::size_t(width + 2 * radius));
    const float* row = in.row(y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy(row, row + width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
    float* to = out.row(y);
    std::fill_n(to, width, 0.f);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const float weight = kernel[k];
      const float* from = padded.data() + k;
      for (int x = 0; x < width; ++x) to[x] += weight * from[x];
    }
  });
  return out;
}

Plane<float> convolve_columns(const Plane<float>& in, const Kernel& kernel, Workers& workers) {
  const Window window = in.window();
  const int radius = int(kernel.size() / 2), width = window.width();
  Plane<float> out(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    float* to = out.row(y);
    std::fill_n(to, width, 0.f);
    for (int k = -radius; k <= radius; ++k) {
      const float weight = kernel[std::size_t(k + radius)];
      const float* from = in.row(std::clamp(y + k, window.y0, window.y1 - 1));
      for (int x = 0; x < width; ++x) to[x] += weight * from[x];
    }
  });
  return out;
}

Kernel gaussian_kernel(double sigma, int radius) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-double(i) * i / (2 * sigma * sigma)));
    sum += weights.back();
  }
  Kernel kernel;
  for (double w : weights) kernel.push_back(float(w / sum));
  return kernel;
}

}  // namespace varve
