#include "diagnose/leave_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/row_sums.h"

namespace varve {
namespace {

constexpr int kSlopeReach = 3;  ///< pixels around a sample whose mean decides its weight

/// Prediction minus sample in R, G, B; A is 1 where there is one.
Plane<glm::dvec4> differences(const Plane<glm::vec4>& sample, const Plane<std::uint8_t>& bad,
                              const Plane<glm::vec4>& before, const Plane<glm::vec2>& motion, Workers& workers) {
  const Window window = sample.window(), source = before.window();
  Plane<glm::dvec4> out(window, 0, glm::dvec4(0.0));
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const glm::dvec2 way = motion.empty() ? glm::dvec2(0.0) : glm::dvec2(motion.at(x, y));
      const double px = x + way.x, py = y + way.y;
      const bool inside = px >= source.x0 && py >= source.y0 && px <= source.x1 - 1 && py <= source.y1 - 1;
      if (bad.at(x, y) || !inside) continue;
      const int ix = int(px) - (px < int(px)), iy = int(py) - (py < int(py));
      const int nx = std::min(ix + 1, source.x1 - 1), ny = std::min(iy + 1, source.y1 - 1);
      const double u = px - ix, v = py - iy;
      const auto at = [&](int i, int j) { return glm::dvec4(before.at(i, j)); };
      const glm::dvec4 said =
          (1 - v) * ((1 - u) * at(ix, iy) + u * at(nx, iy)) + v * ((1 - u) * at(ix, ny) + u * at(nx, ny));
      out.at(x, y) = said - glm::dvec4(sample.at(x, y));
      out.at(x, y).a = 1;
    }
  });
  return out;
}

/// Mean over a square around a pixel of the planes' pixels for which `count(x, y)` is above 0; 0 when there are none.
template <class Value, class Count>
glm::dvec4 mean_around(const Window& window, int x, int y, int reach, const Value& value, const Count& count) {
  glm::dvec4 sum(0.0);
  double n = 0;
  for (int j = std::max(window.y0, y - reach); j <= std::min(window.y1 - 1, y + reach); ++j)
    for (int i = std::max(window.x0, x - reach); i <= std::min(window.x1 - 1, x + reach); ++i) {
      if (!(count(i, j) > 0)) continue;
      sum += value(i, j);
      n += 1;
    }
  return n > 0 ? sum / n : sum;
}

}  // namespace

LeaveOut& LeaveOut::operator+=(const LeaveOut& more) {
  values += more.values;
  squares += more.squares;
  return *this;
}

double LeaveOut::mean() const { return values ? squares / double(values) : std::numeric_limits<double>::quiet_NaN(); }
double LeaveOut::decibels() const { return -10 * std::log10(mean()); }

LeaveOut leave_out_error(const Plane<glm::vec4>& sample, const Plane<std::uint8_t>& bad, const Plane<glm::vec4>& before,
                         const Plane<glm::vec2>& motion, Workers& workers) {
  const Window window = sample.window();
  const Plane<glm::dvec4> difference = differences(sample, bad, before, motion, workers);
  const auto counted = [&](int x, int y) { return difference.at(x, y).a; };
  const auto value = [&](int x, int y) { return difference.at(x, y); };
  return sum_rows<LeaveOut>(window, workers, [&](int y) {
    LeaveOut sums;
    for (int x = window.x0; x < window.x1; ++x) {
      if (!(counted(x, y) > 0)) continue;
      const glm::dvec4 one = value(x, y), three = mean_around(window, x, y, 1, value, counted),
                       five = mean_around(window, x, y, 2, value, counted);
      // Without the sample itself: a weight that knows the noise would favor dark predictions.
      const glm::dvec4 level = mean_around(
          window, x, y, kSlopeReach, [&](int i, int j) { return glm::dvec4(sample.at(i, j)); },
          [&](int i, int j) { return (i == x && j == y) || bad.at(i, j) ? 0 : 1; });
      sums.values += 3;
      for (int c = 0; c < 3; ++c) {
        const double slope = 1 / std::pow(1 + std::max(0.0, level[c]), 2);
        // Noise falls with the number of pixels averaged; 9 keeps that of single pixels from deciding.
        sums.squares += slope * slope * (one[c] * one[c] / 9 + three[c] * three[c] + five[c] * five[c]);
      }
    }
    return sums;
  });
}

}  // namespace varve
