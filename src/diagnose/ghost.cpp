#include "diagnose/ghost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/row_sums.h"

namespace varve {

double Ghost::coefficient() const { return squares > 0 ? product / squares : std::numeric_limits<double>::quiet_NaN(); }

Ghost ghost_of(const ColorPair& now, const Plane<glm::vec4>& stale, const Plane<std::uint8_t>& stale_bad,
               Workers& workers) {
  const Window window = intersect(now.window(), stale.window());
  return sum_rows<Ghost>(window, workers, [&](int y) {
    Ghost sums;
    for (int x = window.x0; x < window.x1; ++x) {
      if (now.bad.at(x, y) || (!stale_bad.empty() && stale_bad.at(x, y))) continue;
      for (int c = 0; c < 3; ++c) {
        const double r = double(now.a.at(x, y)[c]), h = double(stale.at(x, y)[c]), d = h - r;
        // Without it a few highlights would decide. It does not look at the test, so shares stay exact.
        const double weight = 1 / std::pow(1 + std::max(std::abs(r), std::abs(h)), 2);
        sums.product += weight * (double(now.b.at(x, y)[c]) - r) * d;
        sums.squares += weight * d * d;
      }
    }
    return sums;
  });
}

Lag lag_of(std::span<const double> shares) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double sum = 0, product = 0, squares = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (!std::isfinite(shares[i])) return {none, none};
    sum += shares[i];
    if (i == 0) continue;
    product += shares[i] * shares[i - 1];
    squares += shares[i - 1] * shares[i - 1];
  }
  if (shares.size() < 2) return {none, none};
  if (squares == 0) return {0, 0};
  const double q = product / squares;
  if (!(q > 0)) return {sum, 0};
  if (q >= 1) return {INFINITY, INFINITY};
  return {sum + shares.back() * q / (1 - q), std::log(0.5) / std::log(q)};
}

}  // namespace varve
