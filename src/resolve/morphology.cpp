#include "resolve/morphology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/vec2.hpp>

namespace varve {
namespace {

constexpr double kContrast = 0.1;       // of the greater of two pixels
constexpr double kLeastOfAround = 0.5;  // of the contrast beside an edge

/// Difference of two pixels relative to the greater; 0 for equal ones.
double relative(double a, double b) {
  const double most = std::max(std::abs(a), std::abs(b));
  return most > 0 ? std::abs(a - b) / most : 0.0;
}

/// What edges are seen in: Rec. 709 luminance, and alpha.
glm::dvec2 seen(const glm::vec4& c) {
  return {0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b), double(c.a)};
}

/// One direction of a picture: `across` leads over the boundaries, `along` runs with them.
struct Axis {
  int across_x, across_y;
  int along_x() const { return across_y; }
  int along_y() const { return across_x; }
};
constexpr Axis kRows{0, 1}, kColumns{1, 0};

bool contains(const Window& w, int x, int y) { return x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1; }

/// Contrast of the boundary between (x, y) and the pixel before it across; 0 at the rim of the window.
double contrast(const Plane<glm::vec4>& color, const Axis& axis, int x, int y) {
  const int bx = x - axis.across_x, by = y - axis.across_y;
  if (!contains(color.window(), x, y) || !contains(color.window(), bx, by)) return 0;
  const glm::dvec2 a = seen(color.at(x, y)), b = seen(color.at(bx, by));
  return std::max(relative(a.x, b.x), relative(a.y, b.y));
}

bool is_edge(const Plane<glm::vec4>& color, const Axis& axis, int x, int y) {
  const double own = contrast(color, axis, x, y);
  if (!(own > kContrast)) return false;
  const Axis turned{axis.across_y, axis.across_x};
  const int bx = x - axis.across_x, by = y - axis.across_y;
  double around = std::max(contrast(color, axis, bx, by), contrast(color, axis, x + axis.across_x, y + axis.across_y));
  for (const auto& [px, py] : {std::pair(x, y), std::pair(bx, by)})
    around = std::max(
        {around, contrast(color, turned, px, py), contrast(color, turned, px + axis.along_x(), py + axis.along_y())});
  return own >= kLeastOfAround * around;
}

using Edges = Plane<std::uint8_t>;

Edges find_edges(const Plane<glm::vec4>& color, const Axis& axis, Workers& workers) {
  const Window& w = color.window();
  Edges edges(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) edges.at(x, y) = is_edge(color, axis, x, y);
  });
  return edges;
}

bool at(const Edges& edges, int x, int y) { return contains(edges.window(), x, y) && edges.at(x, y) != 0; }

/// One end of a run: how many boundaries away, and by how much the contour leaves the boundary there, across.
struct End {
  int distance = 0;
  double offset = 0;
};

/// Follows the run of boundary (x, y) to one side. `step` is 1 or -1 along.
End follow(const Edges& edges, const Edges& crossing, const Axis& axis, int x, int y, int step) {
  End end;
  while (end.distance < kEdgeReach &&
         at(edges, x + axis.along_x() * step * (end.distance + 1), y + axis.along_y() * step * (end.distance + 1)))
    ++end.distance;
  if (end.distance == kEdgeReach) return end;  // longer than can be told: straight
  // The boundary that crosses at the end lies before the last pixel along, or after it.
  const int past = step > 0 ? end.distance + 1 : -end.distance;
  const int cx = x + axis.along_x() * past, cy = y + axis.along_y() * past;
  const bool behind = at(crossing, cx - axis.across_x, cy - axis.across_y), here = at(crossing, cx, cy);
  if (behind != here) end.offset = here ? 0.5 : -0.5;
  return end;
}

/// What the contour of a run cuts off a pixel on it: behind the boundary (before it, across) and on this side.
struct Cut {
  double behind = 0, here = 0;

  /// The part between `from` and `to` pixels from an end whose contour falls from `offset` to 0 within `half` pixels.
  void add(double offset, double half, double from, double to) {
    to = std::min(to, half);
    if (!(to > from)) return;
    const double area = std::abs(offset) * (to - from) * (1 - (from + to) / (2 * half));
    (offset < 0 ? behind : here) += area;
  }
};

Cut cut_at(const Edges& edges, const Edges& crossing, const Axis& axis, int x, int y) {
  if (!at(edges, x, y)) return {};
  const End before = follow(edges, crossing, axis, x, y, -1), after = follow(edges, crossing, axis, x, y, 1);
  const double half = 0.5 * (before.distance + 1 + after.distance);
  Cut cut;
  cut.add(before.offset, half, before.distance, before.distance + 1);
  cut.add(after.offset, half, after.distance, after.distance + 1);
  return cut;
}

/// How much of its two neighbors across a pixel takes over.
struct Share {
  double before = 0, after = 0;
  double sum() const { return before + after; }
};

Share share_of(const Edges& edges, const Edges& crossing, const Axis& axis, int x, int y) {
  return {cut_at(edges, crossing, axis, x, y).here,
          cut_at(edges, crossing, axis, x + axis.across_x, y + axis.across_y).behind};
}

}  // namespace

Plane<glm::vec4> smooth_edges(const Plane<glm::vec4>& color, Workers& workers) {
  const Window& w = color.window();
  const Edges rows = find_edges(color, kRows, workers), columns = find_edges(color, kColumns, workers);
  Plane<glm::vec4> out(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const Share up_down = share_of(rows, columns, kRows, x, y), sides = share_of(columns, rows, kColumns, x, y);
      const bool vertical = up_down.sum() >= sides.sum();
      const Share& share = vertical ? up_down : sides;
      const Axis& axis = vertical ? kRows : kColumns;
      const glm::dvec4 own(color.at(x, y));
      const auto taken = [&](double part, int step) {
        return part > 0 ? part * (glm::dvec4(color.at(x + step * axis.across_x, y + step * axis.across_y)) - own)
                        : glm::dvec4(0.0);
      };
      out.at(x, y) = glm::vec4(own + (taken(share.before, -1) + taken(share.after, 1)));
    }
  });
  return out;
}

}  // namespace varve
