#include "resolve/companion_move.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "resolve/companion_taps.h"

namespace varve {
namespace {

constexpr double kRounding = 2e-7;  // of a float, relative: less than this is no move
constexpr double kSlack = 1e-6;     // by which the box is widened; a target may lie that much beside its segment
constexpr double kMostRest = 1e3;   // beyond this the color has cancelled, and says nothing of its parts
constexpr int kMostRadius = 3;      // of the mean: the border that companions have

/// R G B to Y Co Cg, as the box has it.
glm::dvec4 rotate(BoxSpace space, const glm::dvec4& c) {
  if (space != BoxSpace::ycocg) return c;
  const double rb = c.r * 0.25 + c.b * 0.25;
  return {rb + c.g * 0.5, c.r * 0.5 - c.b * 0.5, c.g * 0.5 - rb, c.a};
}

glm::dvec4 rotate_back(BoxSpace space, const glm::dvec4& c) {
  if (space != BoxSpace::ycocg) return c;
  const double t = c[0] - c[2];
  return {t + c[1], c[0] + c[2], t - c[1], c[3]};
}

/// Mean of the color's valid samples around, or of what another plane holds there; the present where none is valid.
glm::dvec4 mean_around(const AccumulateView& v, const CompanionRows& plane, int x, int y, const glm::dvec4& present) {
  const int r = std::clamp(v.radius, 1, kMostRadius);
  const glm::dvec4 centre = pixel_of(plane.neighbors, x, y);
  glm::dvec4 sum(0.0);
  double n = 0;
  for (int j = -r; j <= r; ++j) {
    const float* weight = v.weight.origin + (y + j) * v.weight.stride + x;
    for (int i = -r; i <= r; ++i) {
      const double w = weight[i] > 0 ? 1 : 0;
      sum += (pixel_of(plane.neighbors, x + i, y + j) - centre) * w;
      n += w;
    }
  }
  return n > 0 ? centre + sum / n : present;
}

/// The history of a plane. Lights are held where the color was, as far as it was, since only that keeps their sum;
/// what has no sum to keep (values that stand alone, alpha) is held between its own nearest pixels.
glm::dvec4 fetched(const AccumulateView& v, const CompanionMove& move, const CompanionRows& plane, int x, int y) {
  const CompanionTaps& t = move.taps;
  if (!t.found || !plane.history.origin) return pixel_of(plane.present, x, y);
  if (!t.wide) return inner_mean(t, plane);
  glm::dvec4 value = wide_mean(t, plane);
  const glm::dvec4 held = held_by_nearest4(t, plane, value);
  if (!plane.color) return v.dering ? held : value;
  if (t.holds) value += (inner_mean(t, plane) - value) * glm::dvec4(t.hold, 0.0);
  value.a = held.a;
  return value;
}

/// The color before and after, and what it may have been moved towards; all in the space of the box.
struct Before {
  glm::dvec4 from, to, present, mean;
  double size(int k) const {
    return std::max({std::abs(from[k]), std::abs(to[k]), std::abs(present[k]), std::abs(mean[k])});
  }
};

bool is_rounding(const Before& b, int k) {
  return std::abs(b.to[k] - b.from[k]) <= kRounding * std::max(std::abs(b.from[k]), std::abs(b.to[k]));
}

/// A clip: every channel went the same part of the way, to a target that lies between present and mean in each. Finds
/// the part; false when there is none.
bool find_common(const Before& b, BoxAnchor anchor, CompanionMove& move) {
  // In 1/part the conditions are intervals.
  double least = 1, most = std::numeric_limits<double>::infinity();
  double along = 0, length = 0;
  double scale = 0;
  for (int k = 0; k < 3; ++k) scale = std::max(scale, b.size(k));
  if (!(scale > 0)) return false;
  for (int k = 0; k < 3; ++k) {
    const double slack = kSlack * scale;
    const double low = std::min(b.present[k], b.mean[k]) - slack, high = std::max(b.present[k], b.mean[k]) + slack;
    const double step = b.to[k] - b.from[k], anchored = anchor == BoxAnchor::mean ? b.mean[k] : b.present[k];
    along += step / scale * ((anchored - b.from[k]) / scale);
    length += (anchored - b.from[k]) / scale * ((anchored - b.from[k]) / scale);
    if (is_rounding(b, k)) {
      if (!(b.from[k] >= low && b.from[k] <= high)) return false;
      continue;
    }
    const double at_low = (low - b.from[k]) / step, at_high = (high - b.from[k]) / step;
    // Far beyond a short step, the step's own rounding is what counts.
    const double give = kRounding * std::max(std::abs(b.from[k]), std::abs(b.to[k])) / std::abs(step);
    least = std::max(least, std::min(at_low, at_high) * (1 - give));
    most = std::min(most, std::max(at_low, at_high) * (1 + give));
  }
  if (!(least <= most) || !std::isfinite(least)) return false;
  const double wanted = along > 0 ? length / along : most;  // away from the anchor: as short a way as will do
  const double stretch = std::clamp(wanted, least, most);
  if (!std::isfinite(stretch)) return false;
  for (int k = 0; k < 3; ++k) {
    const double target = b.from[k] + (b.to[k] - b.from[k]) * stretch, span = b.mean[k] - b.present[k];
    move.toward[k] = 1 / stretch;
    const bool apart = std::abs(span) > kSlack * b.size(k);
    move.of_mean[k] = apart && !is_rounding(b, k) ? std::clamp((target - b.present[k]) / span, 0.0, 1.0) : 0;
    // A channel that stood still goes where the anchor is.
    if (is_rounding(b, k) && anchor == BoxAnchor::mean) move.of_mean[k] = 1;
  }
  return true;
}

/// One channel by itself: a part of the way to the mean, else to the present, else all the way to the nearer of both.
void find_single(const Before& b, int k, CompanionMove& move) {
  move.toward[k] = move.of_mean[k] = 0;
  if (is_rounding(b, k)) return;
  const double step = b.to[k] - b.from[k];
  for (const double of_mean : {1.0, 0.0}) {
    const double way = (of_mean > 0 ? b.mean[k] : b.present[k]) - b.from[k];
    if (!(step / way > 0 && step / way <= 1 + kSlack)) continue;
    move.toward[k] = std::min(1.0, step / way);
    move.of_mean[k] = of_mean;
    return;
  }
  const double missed_mean = std::abs(b.mean[k] - b.to[k]), missed_present = std::abs(b.present[k] - b.to[k]);
  if (!(std::min(missed_mean, missed_present) < std::abs(step))) return;
  move.toward[k] = 1;
  move.of_mean[k] = missed_mean <= missed_present ? 1 : 0;
}

void find_direction(const AccumulateView& v, const Before& b, CompanionMove& move) {
  bool still = true;
  for (int k = 0; k < 3; ++k) still = still && is_rounding(b, k);
  const bool common = !still && v.rule == BoxRule::clip && find_common(b, v.anchor, move);
  for (int k = common ? 3 : 0; k < 4; ++k) find_single(b, k, move);
  for (int k = 0; k < 4; ++k) {
    move.moved = move.moved || move.toward[k] > 0;
    move.needs_mean = move.needs_mean || (move.toward[k] > 0 && move.of_mean[k] > 0);
  }
}

/// From the history to where the color's history was moved; `mean` is looked at only where it is needed.
glm::dvec4 moved(const AccumulateView& v, const CompanionMove& move, bool color, const glm::dvec4& history,
                 const glm::dvec4& present, const glm::dvec4& mean) {
  if (!move.moved) return history;
  if (color) {
    const glm::dvec4 from = rotate(v.space, history), now = rotate(v.space, present);
    const glm::dvec4 target = now + move.of_mean * (rotate(v.space, mean) - now);
    return rotate_back(v.space, from + move.toward * (target - from));
  }
  // Luma, or the mean of the three: a value that stands alone has no hue.
  const bool luma = v.space == BoxSpace::ycocg;
  const auto of = [&](const glm::dvec4& c) { return luma ? c[0] : (c[0] + c[1] + c[2]) / 3; };
  return history + of(move.toward) * (present + of(move.of_mean) * (mean - present) - history);
}

}  // namespace

glm::dvec4 apply_move(const AccumulateView& v, const CompanionMove& move, const CompanionRows& plane, int x, int y) {
  const glm::dvec4 history = fetched(v, move, plane, x, y), present = pixel_of(plane.present, x, y);
  const glm::dvec4 mean = move.needs_mean ? mean_around(v, plane, x, y, present) : present;
  const glm::dvec4 value = moved(v, move, plane.color, history, present, mean);
  return plane.color ? value + value * move.rest : value;
}

CompanionMove find_move(const AccumulateView& v, const CompanionRows& color, int x, int y, bool has_history,
                        const float* result, unsigned standing) {
  CompanionMove move;
  if (has_history && color.history.origin) move.taps = find_taps(v, x, y, standing);
  const glm::dvec4 present = pixel_of(color.present, x, y), to(result[0], result[1], result[2], result[3]);
  const glm::dvec4 from = move.taps.wide    ? held_as_color(v, move.taps, color)
                          : move.taps.found ? inner_mean(move.taps, color)
                                            : present;
  glm::dvec4 mean = present;
  Before b{from, to, present, present};
  bool still = true;
  for (int k = 0; k < 4; ++k) still = still && is_rounding(b, k);
  if (!still) {
    mean = mean_around(v, color, x, y, present);
    b = {rotate(v.space, from), rotate(v.space, to), rotate(v.space, present), rotate(v.space, mean)};
    find_direction(v, b, move);
  }
  const glm::dvec4 value = moved(v, move, true, from, present, mean);
  for (int k = 0; k < 4; ++k) {
    const double rest = value[k] != 0 ? (to[k] - value[k]) / value[k] : 0;
    if (std::abs(rest) <= kMostRest) move.rest[k] = rest;
  }
  move.value = value + value * move.rest;
  return move;
}

}  // namespace varve
