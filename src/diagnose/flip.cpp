#include "diagnose/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>

#include "diagnose/flip_space.h"
#include "diagnose/row_sums.h"
#include "diagnose/separable.h"

namespace varve {
namespace {

using Planes = std::array<Plane<float>, 3>;

/// Contrast sensitivity filters as weights along one axis. Each is Gaussian; Cz is the sum of two.
struct Sensitivity {
  Kernel y, cx, cz_narrow, cz_wide;
};

/// a * exp(-pi^2 d^2 / b), d in degrees, as a 1-D part whose square is the 2-D filter.
std::vector<double> gaussian_part(double a, double b, int radius, double ppd) {
  constexpr double pi = std::numbers::pi;
  std::vector<double> weights;
  for (int i = -radius; i <= radius; ++i)
    weights.push_back(std::sqrt(a * std::sqrt(pi / b)) * std::exp(-pi * pi * (i / ppd) * (i / ppd) / b));
  return weights;
}

double sum_of(const std::vector<double>& weights) {
  double sum = 0;
  for (double w : weights) sum += w;
  return sum;
}

Kernel scaled(const std::vector<double>& weights, double factor) {
  Kernel kernel;
  for (double w : weights) kernel.push_back(float(w * factor));
  return kernel;
}

Sensitivity make_sensitivity(double ppd) {
  constexpr double pi = std::numbers::pi;
  const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  const auto y = gaussian_part(1, 0.0047, radius, ppd), cx = gaussian_part(1, 0.0053, radius, ppd);
  const auto cz1 = gaussian_part(34.1, 0.04, radius, ppd), cz2 = gaussian_part(13.5, 0.025, radius, ppd);
  const double s1 = sum_of(cz1), s2 = sum_of(cz2), joint = 1 / std::sqrt(s1 * s1 + s2 * s2);
  return {scaled(y, 1 / sum_of(y)), scaled(cx, 1 / sum_of(cx)), scaled(cz1, joint), scaled(cz2, joint)};
}

/// Gaussian, and its first and second derivative with the positive and the negative part summing to 1 each.
struct FeatureKernels {
  Kernel gauss, edge, point;
};

Kernel balanced(const std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (double w : weights) (w > 0 ? positive : negative) += w;
  Kernel kernel;
  for (double w : weights) kernel.push_back(float(w > 0 ? w / positive : w / -negative));
  return kernel;
}

FeatureKernels make_features(double ppd) {
  const double sigma = 0.5 * 0.082 * ppd;
  const int radius = int(std::ceil(3 * sigma));
  std::vector<double> first, second;
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-double(i) * i / (2 * sigma * sigma));
    first.push_back(-i * g);
    second.push_back((double(i) * i / (sigma * sigma) - 1) * g);
  }
  return {gaussian_kernel(sigma, radius), balanced(first), balanced(second)};
}

/// YCxCz of a color held to 0..1.
Planes to_ycxcz(const Plane<glm::vec4>& color, Workers& workers) {
  const Window window = color.window();
  Planes planes = {Plane<float>(window), Plane<float>(window), Plane<float>(window)};
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x) {
      const glm::vec3 p = ycxcz_of(glm::clamp(glm::vec3(color.row(y)[x]), 0.f, 1.f));
      for (int c = 0; c < 3; ++c) planes[std::size_t(c)].row(y)[x] = p[c];
    }
  });
  return planes;
}

Plane<float> blur(const Plane<float>& in, const Kernel& kernel, Workers& workers) {
  return convolve_columns(convolve_rows(in, kernel, workers), kernel, workers);
}

/// What the eye resolves, back in linear RGB, as Hunt-weighted CIELAB.
Planes perceived(const Planes& ycxcz, const Sensitivity& filters, Workers& workers) {
  Planes out = {blur(ycxcz[0], filters.y, workers), blur(ycxcz[1], filters.cx, workers),
                blur(ycxcz[2], filters.cz_narrow, workers)};
  const Plane<float> wide = blur(ycxcz[2], filters.cz_wide, workers);
  const Window window = wide.window();
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x) {
      const glm::vec3 p(out[0].row(y)[x], out[1].row(y)[x], out[2].row(y)[x] + wide.row(y)[x]);
      const glm::vec3 lab = hunt_lab(glm::clamp(rgb_of_ycxcz(p), 0.f, 1.f));
      for (int c = 0; c < 3; ++c) out[std::size_t(c)].row(y)[x] = lab[c];
    }
  });
  return out;
}

/// Strength of edges and of points.
struct Features {
  Plane<float> edge, point;
};

Features features_of(Plane<float> luma, const FeatureKernels& kernels, Workers& workers) {
  const Window window = luma.window();
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x) luma.row(y)[x] = (luma.row(y)[x] + 16) / 116;
  });
  const Plane<float> smooth = convolve_rows(luma, kernels.gauss, workers);
  const auto strength = [&](const Kernel& kernel) {
    Plane<float> along = convolve_columns(convolve_rows(luma, kernel, workers), kernels.gauss, workers);
    const Plane<float> across = convolve_columns(smooth, kernel, workers);
    workers.for_rows(window.y0, window.y1, [&](int y) {
      for (int x = 0; x < window.width(); ++x) {
        const float a = along.row(y)[x], b = across.row(y)[x];
        along.row(y)[x] = std::sqrt(a * a + b * b);
      }
    });
    return along;
  };
  return {strength(kernels.edge), strength(kernels.point)};
}

/// Below 0.4 of the largest difference nearly all of the range, above it the rest.
float spread(float difference, float largest) {
  const float knee = 0.4f * largest;
  return difference < knee ? 0.95f / knee * difference : 0.95f + (difference - knee) / (largest - knee) * 0.05f;
}

}  // namespace

Plane<float> flip_map(const Plane<glm::vec4>& reference, const Plane<glm::vec4>& test, const Plane<std::uint8_t>& bad,
                      Workers& workers, double pixels_per_degree) {
  const Window window = reference.window();
  if (window.empty()) return {};
  const Sensitivity filters = make_sensitivity(pixels_per_degree);
  const FeatureKernels kernels = make_features(pixels_per_degree);
  Planes ra = to_ycxcz(reference, workers), rb = to_ycxcz(test, workers);
  const Planes a = perceived(ra, filters, workers), b = perceived(rb, filters, workers);
  const Features fa = features_of(std::move(ra[0]), kernels, workers);
  const Features fb = features_of(std::move(rb[0]), kernels, workers);
  const float largest = hyab_power(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));

  Plane<float> map(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x) {
      if (!bad.empty() && bad.row(y)[x]) {
        map.row(y)[x] = 1;
        continue;
      }
      const auto lab = [&](const Planes& p) { return glm::vec3(p[0].row(y)[x], p[1].row(y)[x], p[2].row(y)[x]); };
      const float color = spread(hyab_power(lab(a), lab(b)), largest);
      const float structure =
          std::max(std::abs(fa.edge.row(y)[x] - fb.edge.row(y)[x]), std::abs(fa.point.row(y)[x] - fb.point.row(y)[x]));
      const float feature = std::sqrt(std::clamp(structure / std::numbers::sqrt2_v<float>, 0.f, 1.f));
      map.row(y)[x] = color > 0 ? std::min(1.f, std::pow(color, 1 - feature)) : 0.f;
    }
  });
  return map;
}

double mean_of(const Plane<float>& map, Workers& workers) {
  const Window window = map.window();
  if (window.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double sum = sum_rows<double>(window, workers, [&](int y) {
    double row = 0;
    for (int x = 0; x < window.width(); ++x) row += double(map.row(y)[x]);
    return row;
  });
  return sum / double(window.pixels());
}

}  // namespace varve
