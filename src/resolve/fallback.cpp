#include "resolve/fallback.h"

#include <algorithm>
#include <cmath>

#include "resolve/morphology.h"
#include "resolve/row_passes.h"
#include "resolve/sample_weights.h"

namespace varve {
namespace {

constexpr int kTile = 20;  // px, the middle of the source's choices of 10, 20 and 40

double length2(glm::vec2 v) { return double(v.x) * double(v.x) + double(v.y) * double(v.y); }

/// The longer of two; a vector that is no number is none.
glm::vec2 longer(glm::vec2 a, glm::vec2 b) { return length2(b) > length2(a) ? b : a; }

/// The longest vector of each tile and its eight neighbors. One pixel a tile.
Plane<glm::vec2> longest_around(const Plane<glm::vec2>& motion, Workers& workers) {
  const Window& w = motion.window();
  const Window tiles{0, 0, (w.width() + kTile - 1) / kTile, (w.height() + kTile - 1) / kTile};
  Plane<glm::vec2> longest(tiles, 1, glm::vec2(0.0f)), around(tiles);
  workers.for_rows(0, tiles.y1, [&](int ty) {
    for (int y = w.y0 + ty * kTile; y < std::min(w.y1, w.y0 + (ty + 1) * kTile); ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        glm::vec2& tile = longest.at((x - w.x0) / kTile, ty);
        tile = longer(tile, motion.at(x, y));
      }
  });
  workers.for_rows(0, tiles.y1, [&](int ty) {
    for (int tx = 0; tx < tiles.x1; ++tx) {
      glm::vec2 best(0.0f);
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) best = longer(best, longest.at(tx + i, ty + j));
      around.at(tx, ty) = best;
    }
  });
  return around;
}

/// The present between pixels, held at the window's edge. (x, y): display coordinates, integers at pixel centers.
glm::dvec4 bilinear(const Plane<glm::vec4>& color, double x, double y) {
  const Window& w = color.window();
  x = std::clamp(x, double(w.x0), double(w.x1 - 1));
  y = std::clamp(y, double(w.y0), double(w.y1 - 1));
  const int x0 = std::min(int(std::floor(x)), w.x1 - 1), y0 = std::min(int(std::floor(y)), w.y1 - 1);
  const int x1 = std::min(x0 + 1, w.x1 - 1), y1 = std::min(y0 + 1, w.y1 - 1);
  const double fx = x - x0, fy = y - y0;
  const glm::dvec4 a(color.at(x0, y0)), b(color.at(x1, y0)), c(color.at(x0, y1)), d(color.at(x1, y1));
  const glm::dvec4 top = a + (b - a) * fx, bottom = c + (d - c) * fx;
  return top + (bottom - top) * fy;
}

/// Three taps to each side over half of the vector, and the pixel itself.
glm::dvec4 blurred_along(const Plane<glm::vec4>& color, int x, int y, glm::dvec2 v) {
  const glm::dvec4 own(color.at(x, y));
  glm::dvec4 sum(0.0);
  for (int i = -3; i <= 3; ++i) sum += bilinear(color, x + v.x * i / 6, y + v.y * i / 6) - own;
  return own + sum / 7.0;
}

/// Smooth edges, brought to the pixel centers where the jitter is known: what history does not calm must not wobble.
Plane<glm::vec4> smooth_present(const Present& present, Workers& workers) {
  Plane<glm::vec4> smooth = smooth_edges(present.color, workers);
  if (!present.jitter) return smooth;
  const Window& w = smooth.window();
  Present centered;
  centered.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0.0f));
  for (int y = w.y0; y < w.y1; ++y) std::copy_n(smooth.row(y), w.width(), centered.color.row(y));
  centered.valid = present.valid.clone();
  return unjitter_bilinear(centered, *present.jitter, workers);
}

void mix(glm::vec4& color, const glm::dvec4& with, double share) {
  if (!(share > 0)) return;
  for (int k = 0; k < 4; ++k) color[k] = float(double(color[k]) + (with[k] - double(color[k])) * share);
}

}  // namespace

Plane<glm::vec4> fall_back(const Present& present, const History& resolved, const FallbackParameters& p,
                           Workers& workers) {
  if (!p.any() || resolved.color.empty()) return {};
  const Window& w = resolved.color.window();
  const bool blurs = p.motion_blur != MotionBlur::off && !present.motion.empty();
  const Plane<glm::vec2> around =
      blurs && p.motion_blur == MotionBlur::neighbors ? longest_around(present.motion, workers) : Plane<glm::vec2>();
  const bool smooths = p.young_frames > 0 && p.young_filter == YoungFilter::morphological;
  const Plane<glm::vec4> smoothed = smooths ? smooth_present(present, workers) : Plane<glm::vec4>();
  Plane<glm::vec4> out = resolved.color.clone();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      if (p.young_frames > 0) {
        const double age = double(resolved.total.at(x, y));
        const double share = std::clamp(1 - (age - 1) / p.young_frames, 0.0, 1.0);
        if (share > 0)
          mix(out.at(x, y), smooths ? glm::dvec4(smoothed.at(x, y)) : soft_present(present, x - w.x0, y - w.y0), share);
      }
      if (!blurs) continue;
      const glm::dvec2 v(around.empty() ? present.motion.at(x, y) : around.at((x - w.x0) / kTile, (y - w.y0) / kTile));
      const double speed = std::sqrt(v.x * v.x + v.y * v.y), from = std::min(p.blur_from, p.blur_to);
      if (!(speed > from)) continue;  // a vector that is no number blurs nothing
      const double share = speed >= p.blur_to ? 1 : (speed - from) / (p.blur_to - from);
      mix(out.at(x, y), blurred_along(present.color, x, y, v), share);
    }
  });
  return out;
}

}  // namespace varve
