#include "diagnose/warped_residual.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/vec3.hpp>

#include "diagnose/row_sums.h"

namespace varve {
namespace {

/// The error b - a between pixel centers; none outside the window or beside a bad pixel. `x`, `y`: pixel indices that
/// may have a fraction.
std::optional<glm::dvec3> fetch_error(const ColorPair& pair, double x, double y) {
  const Window& w = pair.window();
  if (!(x >= w.x0 && x <= w.x1 - 1 && y >= w.y0 && y <= w.y1 - 1)) return std::nullopt;
  const int x0 = std::min(int(std::floor(x)), w.x1 - 1), y0 = std::min(int(std::floor(y)), w.y1 - 1);
  const double fx = x - x0, fy = y - y0;
  glm::dvec3 sum(0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
      if (weight == 0) continue;
      if (pair.bad.at(x0 + i, y0 + j)) return std::nullopt;
      sum += weight * (glm::dvec3(pair.b.at(x0 + i, y0 + j)) - glm::dvec3(pair.a.at(x0 + i, y0 + j)));
    }
  return sum;
}

}  // namespace

double WarpedResidual::mean() const {
  return values ? squares / double(values) : std::numeric_limits<double>::quiet_NaN();
}

WarpedResidual warped_residual(const ColorPair& now, const ColorPair& before, const Plane<glm::vec2>& motion,
                               Workers& workers) {
  const Window window = now.window();
  return sum_rows<WarpedResidual>(window, workers, [&](int y) {
    WarpedResidual sums;
    for (int x = window.x0; x < window.x1; ++x) {
      if (now.bad.at(x, y)) continue;
      const glm::vec2 b = motion.empty() ? glm::vec2(0) : motion.at(x, y);
      const auto then = fetch_error(before, double(x) + double(b.x), double(y) + double(b.y));
      if (!then) continue;
      const glm::dvec3 d = glm::dvec3(now.b.at(x, y)) - glm::dvec3(now.a.at(x, y)) - *then;
      sums.squares += d.x * d.x + d.y * d.y + d.z * d.z;
      sums.values += 3;
    }
    return sums;
  });
}

}  // namespace varve
