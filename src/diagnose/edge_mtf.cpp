#include "diagnose/edge_mtf.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace varve {
namespace {

constexpr int kOversampling = 4;  ///< bins per pixel across the edge
constexpr double kBin = 1.0 / kOversampling;
constexpr double kNear = 10;  ///< pixels on either side of the edge that its line spread is looked for in

/// Values with the edge running roughly along columns: at(along, across).
struct Patch {
  const Plane<float>& plane;
  bool turned = false;
  int across() const { return turned ? plane.window().height() : plane.window().width(); }
  int along() const { return turned ? plane.window().width() : plane.window().height(); }
  double at(int i, int j) const {
    const Window& w = plane.window();
    return double(turned ? plane.at(w.x0 + i, w.y0 + j) : plane.at(w.x0 + j, w.y0 + i));
  }
};

double change_across(const Patch& patch) {
  double sum = 0;
  for (int i = 0; i < patch.along(); ++i) sum += patch.at(i, patch.across() - 1) - patch.at(i, 0);
  return std::abs(sum) / patch.along();
}

/// Where the edge crosses line i: offset + slope * i.
struct Line {
  double offset = 0, slope = 0;
  double at(double i) const { return offset + slope * i; }
};

/// Through the centroids of the change in each line, within `reach` of the line known so far.
std::optional<Line> fit_line(const Patch& patch, const Line& known, double reach) {
  double n = 0, si = 0, sj = 0, sii = 0, sij = 0;
  for (int i = 0; i < patch.along(); ++i) {
    double weight = 0, moment = 0;
    for (int j = 0; j + 1 < patch.across(); ++j) {
      if (!(std::abs(j + 0.5 - known.at(i)) <= reach)) continue;
      const double d = patch.at(i, j + 1) - patch.at(i, j);
      weight += d;
      moment += d * (j + 0.5);
    }
    if (weight == 0) continue;
    const double center = moment / weight;
    n += 1, si += i, sj += center, sii += double(i) * i, sij += i * center;
  }
  const double determinant = n * sii - si * si;
  if (!(determinant > 0)) return std::nullopt;
  const double slope = (n * sij - si * sj) / determinant;
  const Line line{(sj - slope * si) / n, slope};
  return std::isfinite(line.offset) && std::abs(slope) <= 1 ? std::optional(line) : std::nullopt;
}

/// The step across the edge in quarter pixels, 0 on the left and 1 on the right; bin i is centered at (i - middle) / 4.
std::vector<double> edge_spread(const Patch& patch, const Line& line) {
  const double cosine = 1 / std::sqrt(1 + line.slope * line.slope);
  const int half = int(std::min(kNear + 2, patch.across() / 2.0 - 1) * kOversampling);
  std::vector<double> sums(std::size_t(2 * half + 1)), counts(sums.size());
  for (int i = 0; i < patch.along(); ++i)
    for (int j = 0; j < patch.across(); ++j) {
      const int bin = int(std::lround((j - line.at(i)) * cosine * kOversampling)) + half;
      if (bin < 0 || bin >= int(sums.size())) continue;
      sums[std::size_t(bin)] += patch.at(i, j);
      counts[std::size_t(bin)] += 1;
    }
  std::vector<double> spread;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    // A bin no pixel fell into takes the one before.
    if (counts[k] > 0)
      spread.push_back(sums[k] / counts[k]);
    else
      spread.push_back(spread.empty() ? patch.at(0, 0) : spread.back());
  }
  const double low = spread.front(), high = spread.back();
  for (double& v : spread) v = (v - low) / (high - low);
  return spread;
}

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

/// Contrast at a frequency. Bins and differences blur by a quarter pixel each, which is taken out again.
double contrast_at(const std::vector<double>& line_spread, double frequency) {
  double re = 0, im = 0;
  for (std::size_t k = 0; k < line_spread.size(); ++k) {
    const double angle = 2 * std::numbers::pi * frequency * kBin * double(k);
    re += line_spread[k] * std::cos(angle);
    im += line_spread[k] * std::sin(angle);
  }
  const double own = sinc(frequency * kBin);
  return std::sqrt(re * re + im * im) / (own * own);
}

/// Position in bins where the spread first rises to `level`.
double crossing(const std::vector<double>& spread, double level) {
  for (std::size_t k = 1; k < spread.size(); ++k)
    if (spread[k] >= level) return double(k) - (spread[k] - level) / std::max(spread[k] - spread[k - 1], 1e-12);
  return double(spread.size());
}

EdgeSharpness measure(const std::vector<double>& spread) {
  EdgeSharpness result;
  std::vector<double> line_spread;
  double first = 0, second = 0;
  for (std::size_t k = 0; k + 1 < spread.size(); ++k) {
    line_spread.push_back(spread[k + 1] - spread[k]);
    first += line_spread.back() * kBin * double(k);
  }
  for (std::size_t k = 0; k < line_spread.size(); ++k) {
    const double d = kBin * double(k) - first;
    second += line_spread[k] * d * d;
  }
  result.variance = second - 2 * kBin * kBin / 12;  // a bin and a difference are boxes of their own
  result.width = (crossing(spread, 0.9) - crossing(spread, 0.1)) * kBin;
  for (int i = 0; i <= 64; ++i) result.mtf.push_back(contrast_at(line_spread, i / 64.0));
  double before = 1;
  result.mtf50 = 2;
  for (int i = 1; i <= 256; ++i) {
    const double contrast = contrast_at(line_spread, i / 128.0);
    if (contrast <= 0.5) {
      result.mtf50 = (i - (0.5 - contrast) / std::max(before - contrast, 1e-12)) / 128.0;
      break;
    }
    before = contrast;
  }
  return result;
}

}  // namespace

std::optional<EdgeSharpness> edge_sharpness(const Plane<float>& luminance) {
  const Window window = luminance.window();
  if (window.width() < 8 || window.height() < 8) return std::nullopt;
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x)
      if (!std::isfinite(luminance.at(x, y))) return std::nullopt;
  const Patch upright{luminance, false}, turned{luminance, true};
  const Patch& patch = change_across(upright) >= change_across(turned) ? upright : turned;
  if (!(change_across(patch) > 0)) return std::nullopt;
  std::optional<Line> line = fit_line(patch, {}, INFINITY);
  for (int pass = 0; line && pass < 2; ++pass) line = fit_line(patch, *line, kNear);
  if (!line) return std::nullopt;
  const std::vector<double> spread = edge_spread(patch, *line);
  if (!std::ranges::all_of(spread, [](double v) { return std::isfinite(v); })) return std::nullopt;
  return measure(spread);
}

}  // namespace varve
