// Pixel windows in display-window coordinates: x right, y down, half open.
// OpenEXR's inclusive boxes are converted in exr/ and nowhere else.
#pragma once

#include <algorithm>
#include <cstddef>

namespace varve {

/// Pixels x0 <= x < x1, y0 <= y < y1. The centre of pixel (x, y) lies at (x + 0.5, y + 0.5).
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return std::max(0, x1 - x0); }
  int height() const { return std::max(0, y1 - y0); }
  bool empty() const { return width() == 0 || height() == 0; }
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  std::size_t pixels() const { return std::size_t(width()) * std::size_t(height()); }
  bool operator==(const Window&) const = default;
};

/// Pixels that lie in both windows; empty when they do not meet.
inline Window intersect(const Window& a, const Window& b) {
  Window w{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return w.empty() ? Window{} : w;
}

/// Smallest window that holds both; an empty one adds nothing.
inline Window unite(const Window& a, const Window& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace varve
