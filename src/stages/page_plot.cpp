#include "stages/page_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace varve {
namespace {

constexpr double kWidth = 300, kHeight = 120, kLeft = 52, kRight = 10, kTop = 8, kBottom = 20;

std::string number(double value) {
  std::array<char, 32> text;
  const bool large = std::abs(value) >= 1e4 && std::abs(value) < 1e7;
  std::snprintf(text.data(), text.size(), large ? "%.0f" : "%.4g", value);
  return text.data();
}
std::string place(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}
std::string label(double x, double y, const char* anchor, const std::string& text) {
  return "<text x='" + place(x) + "' y='" + place(y) + "' text-anchor='" + anchor + "'>" + text + "</text>";
}
std::string line(double x0, double y0, double x1, double y1, const char* kind) {
  return std::string("<line class='") + kind + "' x1='" + place(x0) + "' y1='" + place(y0) + "' x2='" + place(x1) +
         "' y2='" + place(y1) + "'/>";
}

/// Lowest and highest value to draw, never the same.
struct Extent {
  double low = INFINITY, high = -INFINITY;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
  void widen() {
    const double margin = high > low ? 0.08 * (high - low) : std::max(1e-6, 0.1 * std::abs(high));
    low -= margin;
    high += margin;
  }
};

}  // namespace

std::string page_plot(const std::vector<int>& frames, const std::vector<double>& values, std::optional<double> limit) {
  Extent measured, extent;
  for (double v : values) measured.add(v);
  if (measured.empty()) return "";
  extent = measured;
  if (limit) extent.add(*limit);
  extent.widen();
  const double span = std::max(1, frames.back() - frames.front());
  const auto x_of = [&](int frame) { return kLeft + (kWidth - kLeft - kRight) * (frame - frames.front()) / span; };
  const auto y_of = [&](double value) {
    return kTop + (kHeight - kTop - kBottom) * (extent.high - value) / (extent.high - extent.low);
  };
  std::string svg = "<svg viewBox='0 0 " + place(kWidth) + " " + place(kHeight) + "' role='img'>";
  svg += line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "axis");
  svg += line(kLeft, kTop, kLeft, kHeight - kBottom, "axis");
  svg += label(kLeft - 5, y_of(measured.high) + 4, "end", number(measured.high));
  if (y_of(measured.low) - y_of(measured.high) > 14)
    svg += label(kLeft - 5, y_of(measured.low) + 4, "end", number(measured.low));
  svg += label(kLeft, kHeight - 5, "start", std::to_string(frames.front()));
  svg += label(kWidth - kRight, kHeight - 5, "end", std::to_string(frames.back()));
  if (limit) svg += line(kLeft, y_of(*limit), kWidth - kRight, y_of(*limit), "limit");
  std::string points, dots;
  const auto flush = [&] {
    if (!points.empty()) svg += "<polyline points='" + points + "'/>";
    points.clear();
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!std::isfinite(values[i])) {
      flush();
      continue;
    }
    const std::string x = place(x_of(frames[i])), y = place(y_of(values[i]));
    points += x + "," + y + " ";
    dots += "<circle cx='" + x + "' cy='" + y + "' r='2.5'><title>frame " + std::to_string(frames[i]) + ": " +
            number(values[i]) + "</title></circle>";
  }
  flush();
  return svg + dots + "</svg>";
}

}  // namespace varve
