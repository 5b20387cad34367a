#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "resolve/present.h"

namespace varve {
namespace {

constexpr std::uint8_t kAllBad = 15;  // a bit for each channel

void clear_border(Plane<glm::vec4>& plane) {
  const Window& w = plane.window();
  const int b = plane.border();
  for (int y = w.y0 - b; y < w.y1 + b; ++y) {
    glm::vec4* row = plane.row(y);
    const bool beyond = y < w.y0 || y >= w.y1;
    for (int x = -b; x < w.width() + b; ++x)
      if (beyond || x < 0 || x >= w.width()) row[x] = glm::vec4(0.0f);
  }
}

std::uint8_t bad_channels(const glm::vec4& c) {
  std::uint8_t bad = 0;
  for (int k = 0; k < 4; ++k)
    if (!std::isfinite(c[k])) bad = std::uint8_t(bad | (1 << k));
  return bad;
}

/// Mean of one channel over the neighbors that have it; 0 if none has. The sums are those of sanitize(), so that what
/// added up to the color still does.
float mean_of_neighbors(const Plane<glm::vec4>& plane, const Plane<std::uint8_t>& bad, int x, int y, int k) {
  double sum = 0;
  int n = 0;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i) {
      if (bad.at(i, j) & (1 << k)) continue;
      sum += double(plane.at(i, j)[k]);
      ++n;
    }
  return n == 0 ? 0.0f : float(sum / n);
}

/// Returns how many values were not finite.
std::size_t sanitize_plane(Plane<glm::vec4>& plane, const Plane<float>& valid, bool all_valid, Workers& workers) {
  clear_border(plane);
  const Window& w = plane.window();
  Plane<std::uint8_t> bad(w, 1, kAllBad);
  std::atomic<std::size_t> not_finite = 0;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    std::size_t here = 0;
    for (int x = w.x0; x < w.x1; ++x) {
      const std::uint8_t channels = bad_channels(plane.at(x, y));
      for (int k = 0; k < 4; ++k) here += (channels >> k) & 1u;
      bad.at(x, y) = valid.at(x, y) > 0 ? channels : kAllBad;
    }
    not_finite += here;
  });
  if (not_finite == 0 && all_valid) return 0;
  // Only bad values are written, only good ones are read: rows do not depend on each other.
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x)
      for (int k = 0; k < 4; ++k)
        if (bad.at(x, y) & (1 << k)) plane.at(x, y)[k] = mean_of_neighbors(plane, bad, x, y, k);
  });
  return not_finite;
}

}  // namespace

void sanitize_companions(Present& present, Workers& workers) {
  present.companions_not_finite = 0;
  for (Plane<glm::vec4>& plane : present.companions)
    present.companions_not_finite += sanitize_plane(plane, present.valid, present.not_finite == 0, workers);
}

}  // namespace varve
