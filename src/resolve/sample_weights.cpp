#include "resolve/sample_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/held_float.h"

namespace varve {
namespace {

constexpr double kGaussianSigma = 0.47;
constexpr double kBlackmanHarrisWidth = 3.3;

double blackman_harris(double x) {
  const double t = 2 * std::numbers::pi * x / kBlackmanHarrisWidth;
  const double a0 = 0.35875;
  return (a0 + 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) + 0.01168 * std::cos(3 * t)) /
         (a0 * kBlackmanHarrisWidth);
}

/// Mitchell and Netravali 1988, B = C = 1/3.
double mitchell(double x) {
  const double t = std::abs(x), t2 = t * t, t3 = t2 * t;
  if (t < 1) return (7 * t3 - 12 * t2 + 16.0 / 3) / 6;
  return (-7.0 / 3 * t3 + 12 * t2 - 20 * t + 32.0 / 3) / 6;
}

/// Kernel values at the offsets -3..3 of the neighbors' samples along one axis.
struct AxisWeights {
  std::array<double, 7> w;
  int first = 3, last = -3;  // offsets with a weight other than 0

  AxisWeights(SampleFilter filter, double jitter) {
    for (int i = -kPresentBorder; i <= kPresentBorder; ++i) {
      const double v = reconstruction_kernel(filter, i + jitter);
      w[std::size_t(i + kPresentBorder)] = v;
      if (v != 0) first = std::min(first, i), last = std::max(last, i);
    }
  }
  double at(int i) const { return w[std::size_t(i + kPresentBorder)]; }
};

struct Sum {
  double color[4] = {0, 0, 0, 0};
  double weight = 0;
};

Sum weigh(const Present& p, int x, int y, const AxisWeights& wx, const AxisWeights& wy, bool positive_only) {
  Sum s;
  for (int j = wy.first; j <= wy.last; ++j)
    for (int i = wx.first; i <= wx.last; ++i) {
      const double w = wx.at(i) * wy.at(j) * double(p.valid.at(x + i, y + j));
      if (positive_only && w < 0) continue;
      const glm::vec4& c = p.color.at(x + i, y + j);
      for (int k = 0; k < 4; ++k) s.color[k] += w * double(c[k]);
      s.weight += w;
    }
  return s;
}

}  // namespace

double reconstruction_radius(SampleFilter filter) {
  switch (filter) {
    case SampleFilter::none:
      return 0.5;
    case SampleFilter::tent:
      return 1;
    case SampleFilter::gaussian:
      return 1.5;
    case SampleFilter::blackman_harris:
      return kBlackmanHarrisWidth / 2;
    case SampleFilter::mitchell:
      return 2;
  }
  return 0;
}

double reconstruction_kernel(SampleFilter filter, double x) {
  if (!(std::abs(x) < reconstruction_radius(filter))) return 0;
  switch (filter) {
    case SampleFilter::none:
      return 1;
    case SampleFilter::tent:
      return 1 - std::abs(x);
    case SampleFilter::gaussian: {
      const double t = x / kGaussianSigma;
      return std::exp(-0.5 * t * t) / (kGaussianSigma * std::sqrt(2 * std::numbers::pi));
    }
    case SampleFilter::blackman_harris:
      return blackman_harris(x);
    case SampleFilter::mitchell:
      return mitchell(x);
  }
  return 0;
}

WeighedPresent weigh_samples(const Present& present, SampleFilter filter, glm::dvec2 jitter, Workers& workers) {
  const Window& w = present.color.window();
  const AxisWeights wx(filter, jitter.x), wy(filter, jitter.y);
  WeighedPresent out{Plane<glm::vec4>(w), Plane<float>(w)};
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      Sum s = weigh(present, x, y, wx, wy, false);
      if (s.weight < 0.1) s = weigh(present, x, y, wx, wy, true);
      glm::vec4& color = out.color.at(x, y);
      color = present.color.at(x, y);
      out.sample_weight.at(x, y) = s.weight > 0 ? float(s.weight) : 0.0f;
      if (s.weight > 0)
        for (int k = 0; k < 4; ++k) color[k] = held_float(s.color[k] / s.weight);
    }
  });
  return out;
}

Plane<glm::vec4> unjitter_bilinear(const Present& present, glm::dvec2 jitter, Workers& workers) {
  const Window& w = present.color.window();
  // The sample of pixel p lies at p + jitter: the center lies at p - jitter among the samples.
  const int dx = int(std::floor(-jitter.x)), dy = int(std::floor(-jitter.y));
  const double fx = -jitter.x - dx, fy = -jitter.y - dy;
  const double weights[2][2] = {{(1 - fx) * (1 - fy), fx * (1 - fy)}, {(1 - fx) * fy, fx * fy}};
  Plane<glm::vec4> out(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::vec4& own = present.color.at(x, y);
      double sum[4] = {0, 0, 0, 0}, total = 0;
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const double weight = weights[j][i] * double(present.valid.at(x + dx + i, y + dy + j));
          const glm::vec4& c = present.color.at(x + dx + i, y + dy + j);
          // Differences, so that a constant stays that constant.
          for (int k = 0; k < 4; ++k) sum[k] += weight * (double(c[k]) - double(own[k]));
          total += weight;
        }
      const bool valid = present.valid.at(x, y) > 0 && total > 0;
      for (int k = 0; k < 4; ++k) out.at(x, y)[k] = valid ? float(double(own[k]) + sum[k] / total) : own[k];
    }
  });
  return out;
}

}  // namespace varve
