#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "resolve/present.h"

namespace varve {
namespace {

bool finite(const glm::vec4& c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) && std::isfinite(c.a);
}

/// Mean of the valid pixels around (x, y), in double because two values near the end of the float range overflow.
glm::vec4 mean_of_neighbors(const Present& p, int x, int y) {
  double sum[4] = {0, 0, 0, 0};
  int n = 0;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i) {
      if (!(p.valid.at(i, j) > 0)) continue;
      for (int k = 0; k < 4; ++k) sum[k] += double(p.color.at(i, j)[k]);
      ++n;
    }
  if (n == 0) return glm::vec4(0.0f);
  return {float(sum[0] / n), float(sum[1] / n), float(sum[2] / n), float(sum[3] / n)};
}

void clear_border(Plane<glm::vec4>& color) {
  const Window& w = color.window();
  const int b = color.border();
  const std::size_t whole = sizeof(glm::vec4) * std::size_t(w.width() + 2 * b);
  for (int y = w.y0 - b; y < w.y1 + b; ++y) {
    glm::vec4* row = color.row(y);
    if (y < w.y0 || y >= w.y1) {
      std::memset(static_cast<void*>(row - b), 0, whole);
    } else {
      std::fill(row - b, row, glm::vec4(0.0f));
      std::fill(row + w.width(), row + w.width() + b, glm::vec4(0.0f));
    }
  }
}

}  // namespace

void sanitize(Present& p, Workers& workers) {
  const Window& w = p.color.window();
  clear_border(p.color);
  p.valid = Plane<float>(w, kPresentBorder, 0.0f);
  p.rows_valid.assign(std::size_t(w.height()), 1);

  std::atomic<std::size_t> bad = 0;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const glm::vec4* color = p.color.row(y);
    float* valid = p.valid.row(y);
    std::size_t bad_here = 0;
    for (int x = 0; x < w.width(); ++x) {
      const bool good = finite(color[x]);
      valid[x] = good ? 1.0f : 0.0f;
      bad_here += !good;
    }
    p.rows_valid[std::size_t(y - w.y0)] = bad_here == 0;
    bad += bad_here;
  });
  p.not_finite = bad;
  if (p.not_finite == 0) return;

  workers.for_rows(w.y0, w.y1, [&](int y) {
    if (p.rows_valid[std::size_t(y - w.y0)]) return;
    // Only invalid pixels are written, only valid ones are read: rows do not depend on each other.
    for (int x = w.x0; x < w.x1; ++x)
      if (!(p.valid.at(x, y) > 0)) p.color.at(x, y) = mean_of_neighbors(p, x, y);
  });
}

}  // namespace varve
