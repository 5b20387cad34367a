#include "diagnose/leave_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/reject.h"
#include "diagnose/row_sums.h"

namespace varve {
namespace {

/// No setting has history where a shot starts.
constexpr unsigned kStart = kRejectFirstFrame | kRejectCut;

double tone_of(double v) { return v > 0 ? v / (1 + v) : 0; }

/// Mean of the up to eight neighbors that are finite; 0 when there are none.
glm::dvec4 neighbor_mean(const Plane<glm::vec4>& sample, const Plane<std::uint8_t>& bad, int x, int y) {
  glm::dvec4 sum(0.0);
  int count = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if ((i == 0 && j == 0) || !sample.window().contains(x + i, y + j) || bad.at(x + i, y + j)) continue;
      sum += glm::dvec4(sample.at(x + i, y + j));
      ++count;
    }
  return count ? sum / double(count) : sum;
}

double decibels(double squares, std::size_t values) {
  return values ? -10 * std::log10(squares / double(values)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

LeaveOut& LeaveOut::operator+=(const LeaveOut& more) {
  values += more.values;
  without_history += more.without_history;
  linear += more.linear;
  tone += more.tone;
  return *this;
}

double LeaveOut::psnr() const { return decibels(linear, values); }
double LeaveOut::psnr_tone() const { return decibels(tone, values); }

LeaveOut leave_out_error(const Plane<glm::vec4>& sample, const Plane<std::uint8_t>& bad,
                         const Plane<glm::vec4>& prediction, const Plane<std::uint32_t>& reject, Workers& workers) {
  const Window window = sample.window();
  return sum_rows<LeaveOut>(window, workers, [&](int y) {
    LeaveOut sums;
    for (int x = window.x0; x < window.x1; ++x) {
      if (bad.at(x, y) || (reject.at(x, y) & kStart) != 0) continue;
      const bool has_history = (reject.at(x, y) & ~unsigned(kRejectPresent)) == 0;
      const glm::dvec4 said = has_history ? glm::dvec4(prediction.at(x, y)) : neighbor_mean(sample, bad, x, y);
      sums.values += 3;
      sums.without_history += has_history ? 0 : 3;
      for (int c = 0; c < 3; ++c) {
        const double s = double(sample.at(x, y)[c]), p = said[c];
        const double linear = std::clamp(p, 0.0, 1.0) - std::clamp(s, 0.0, 1.0), tone = tone_of(p) - tone_of(s);
        sums.linear += linear * linear;
        sums.tone += tone * tone;
      }
    }
    return sums;
  });
}

}  // namespace varve
