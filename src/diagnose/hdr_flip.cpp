#include "diagnose/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

#include "diagnose/flip_space.h"

namespace varve {
namespace {

constexpr double kDarkest = 0x1p-16, kBrightest = 65504;

/// Rational fit of the ACES curve (Narkowicz 2016) with the input scaled by 0.6:
/// (n2 x^2 + n1 x) / (d2 x^2 + d1 x + d0).
constexpr double kN2 = 0.36 * 2.51, kN1 = 0.6 * 0.03, kD2 = 0.36 * 2.43, kD1 = 0.6 * 0.59, kD0 = 0.14;

float toned(float x) {
  // Beyond 1e15 the squares leave the range of float; the curve is flat there.
  const double v = std::clamp(double(x), 0.0, 1e15);
  return float(std::clamp((kN2 * v + kN1) * v / ((kD2 * v + kD1) * v + kD0), 0.0, 1.0));
}

/// The larger x that the curve takes to `value`.
double inverse_toned(double value) {
  const double a = kN2 - value * kD2, b = kN1 - value * kD1, c = -value * kD0;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

Plane<glm::vec4> exposed(const Plane<glm::vec4>& color, double stops, Workers& workers) {
  const Window window = color.window();
  const float factor = float(std::exp2(stops));
  Plane<glm::vec4> out(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = 0; x < window.width(); ++x) {
      const glm::vec4 c = color.row(y)[x] * factor;
      out.row(y)[x] = {toned(c.r), toned(c.g), toned(c.b), 1};
    }
  });
  return out;
}

}  // namespace

ExposureRange exposure_range(const Plane<glm::vec4>& reference) {
  const Window window = reference.window();
  if (window.empty()) return {};
  std::vector<float> luminances;
  luminances.reserve(window.pixels());
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = 0; x < window.width(); ++x)
      luminances.push_back(flip_luminance(glm::max(glm::vec3(reference.row(y)[x]), 0.f)));
  // Of an even count the upper of the two in the middle, as in the published figures.
  const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = std::clamp(double(*middle), kDarkest, kBrightest);
  const double greatest = std::clamp(double(*std::max_element(middle, luminances.end())), kDarkest, kBrightest);
  const double target = inverse_toned(0.85);
  ExposureRange range{std::log2(target / greatest), std::log2(target / median), 2};
  range.count = std::clamp(int(std::ceil(range.last - range.first)), 2, 40);
  return range;
}

Plane<float> hdr_flip_map(const Plane<glm::vec4>& reference, const Plane<glm::vec4>& test,
                          const Plane<std::uint8_t>& bad, const ExposureRange& range, Workers& workers,
                          double pixels_per_degree) {
  const Window window = reference.window();
  Plane<float> worst(window, 0, 0.f);
  for (int i = 0; i < range.count; ++i) {
    const double stops = range.first + (range.last - range.first) * i / (range.count - 1);
    const Plane<float> map =
        flip_map(exposed(reference, stops, workers), exposed(test, stops, workers), bad, workers, pixels_per_degree);
    workers.for_rows(window.y0, window.y1, [&](int y) {
      for (int x = 0; x < window.width(); ++x) worst.row(y)[x] = std::max(worst.row(y)[x], map.row(y)[x]);
    });
  }
  return worst;
}

}  // namespace varve
