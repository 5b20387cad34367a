#include "reference/morphology_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/vec2.hpp>

namespace varve::reference {
namespace {

/// The picture, or the picture turned over its diagonal: boundaries are those between rows in both.
struct View {
  const Plane<glm::vec4>& color;
  bool turned;

  bool has(int x, int y) const {
    if (turned) std::swap(x, y);
    const Window& w = color.window();
    return x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
  }
  glm::dvec4 operator()(int x, int y) const { return turned ? glm::dvec4(color.at(y, x)) : glm::dvec4(color.at(x, y)); }
  View other() const { return {color, !turned}; }
};

double contrast(const View& v, int x0, int y0, int x1, int y1) {
  if (!v.has(x0, y0) || !v.has(x1, y1)) return 0;
  const auto ratio = [](double a, double b) {
    return a == b ? 0.0 : std::abs(a - b) / std::fmax(std::abs(a), std::abs(b));
  };
  const auto light = [](const glm::dvec4& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; };
  const glm::dvec4 a = v(x0, y0), b = v(x1, y1);
  return std::fmax(ratio(light(a), light(b)), ratio(a.a, b.a));
}

/// The boundary above pixel (x, y).
bool edge_above(const View& v, int x, int y) {
  const double own = contrast(v, x, y - 1, x, y);
  double most = std::fmax(contrast(v, x, y - 2, x, y - 1), contrast(v, x, y, x, y + 1));
  for (const int row : {y - 1, y})
    for (const int side : {-1, 1}) most = std::fmax(most, contrast(v, x, row, x + side, row));
  return own > 0.1 && own >= 0.5 * most;
}

bool edge_left(const View& v, int x, int y) { return edge_above(v.other(), y, x); }

/// Areas above and below the boundary over pixel (x, y) that the contour of its run cuts off within that column.
void cut(const View& v, int x, int y, double& above, double& below) {
  above = below = 0;
  if (!v.has(x, y) || !v.has(x, y - 1) || !edge_above(v, x, y)) return;
  constexpr int kReach = 32;
  int left = 0, right = 0;
  while (left < kReach && edge_above(v, x - left - 1, y)) ++left;
  while (right < kReach && edge_above(v, x + right + 1, y)) ++right;
  const auto step = [&](int at) {
    const bool up = edge_left(v, at, y - 1), down = edge_left(v, at, y);
    return up == down ? 0.0 : up ? -0.5 : 0.5;
  };
  const double from = left < kReach ? step(x - left) : 0, to = right < kReach ? step(x + right + 1) : 0;
  const double length = left + 1 + right;
  constexpr int kSlices = 4096;
  for (int i = 0; i < kSlices; ++i) {
    const double at = left + (i + 0.5) / kSlices;  // from the left end of the run
    const double height = at < length / 2 ? from * (1 - 2 * at / length) : to * (2 * at / length - 1);
    (height < 0 ? above : below) += std::abs(height) / kSlices;
  }
}

}  // namespace

glm::dvec4 smoothed_pixel(const Plane<glm::vec4>& color, int x, int y) {
  const auto shares = [&](const View& v, int px, int py) {
    double above, below, lower_above, lower_below;
    cut(v, px, py, above, below);
    cut(v, px, py + 1, lower_above, lower_below);
    return glm::dvec2(below, lower_above);  // taken from the pixel above, from the one below
  };
  const View upright{color, false}, turned{color, true};
  const glm::dvec2 rows = shares(upright, x, y), columns = shares(turned, y, x);
  const bool vertical = rows.x + rows.y > columns.x + columns.y - 1e-6;  // slices do not add up exactly
  const glm::dvec2 share = vertical ? rows : columns;
  const View& v = vertical ? upright : turned;
  const int px = vertical ? x : y, py = vertical ? y : x;
  glm::dvec4 sum = glm::dvec4(color.at(x, y)) * (1 - share.x - share.y);
  if (share.x > 0) sum += share.x * v(px, py - 1);
  if (share.y > 0) sum += share.y * v(px, py + 1);
  return sum;
}

}  // namespace varve::reference
