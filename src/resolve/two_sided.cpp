#include "resolve/two_sided.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "base/held_float.h"
#include "base/reject.h"
#include "resolve/accumulate_row.h"

namespace varve {
namespace {

/// A row of pixels as four doubles each, read from the floats of the kernel.
glm::dvec4 color_at(const float* row, int x) {
  return {double(row[4 * x]), double(row[4 * x + 1]), double(row[4 * x + 2]), double(row[4 * x + 3])};
}

/// Variance of one sample, summed over red, green and blue: that of the 3x3 around a pixel. Not below a millionth of
/// the mean, squared, which is the box's own floor.
double sample_variance(const Present& present, int x, int y) {
  const glm::vec4 pivot = present.color.at(x, y);
  glm::dvec3 sum(0.0), squares(0.0);
  double n = 0;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i) {
      if (!(present.valid.at(i, j) > 0)) continue;
      const glm::dvec3 d = glm::dvec3(glm::dvec4(present.color.at(i, j)) - glm::dvec4(pivot));
      sum += d;
      squares += d * d;
      n += 1;
    }
  if (!(n > 0)) return 0;
  const glm::dvec3 offset = sum / n, variance = glm::max(squares / n - offset * offset, glm::dvec3(0.0));
  const glm::dvec3 mean = glm::abs(glm::dvec3(glm::dvec4(pivot)) + offset);
  const double floor = 1e-6 * std::max({mean.r, mean.g, mean.b});
  return variance.r + variance.g + variance.b + floor * floor;
}

/// Less weight for a side that rectification had to move.
void discount_clipped(const Present& present, const AccumulateView& v, int y, const RowScratch& s,
                      const glm::vec4* fetched) {
  const Window& w = present.color.window();
  for (int x = 0; x < v.width; ++x) {
    if (!(s.total[x] > 0)) continue;
    const glm::dvec4 moved = color_at(s.history, x) - glm::dvec4(fetched[x]);
    const double d2 = moved.r * moved.r + moved.g * moved.g + moved.b * moved.b;
    if (!(d2 > 0)) continue;
    const double r = sample_variance(present, w.x0 + x, w.y0 + y);
    s.total[x] = float(discounted_weight(double(s.total[x]), d2 / r));  // r 0: nothing is left
  }
}

/// Weight of the present's sample: 0 where it has none.
double weight_of_sample(const AccumulateView& v, int x, int y) {
  if (!(v.weight.origin[y * v.weight.stride + x] > 0)) return 0;
  return v.sample_weight.origin ? double(v.sample_weight.origin[y * v.sample_weight.stride + x]) : 1;
}

/// The side with the present in it, as the frame beyond will fetch it.
void blend_into_state(const AccumulateView& v, int y, const RowScratch& s, History& state) {
  const Window& window = state.color.window();
  glm::vec4* color = state.color.row(window.y0 + y);
  float *total = state.total.row(window.y0 + y), *spread = state.spread.row(window.y0 + y);
  bool all_valid = true;
  for (int x = 0; x < v.width; ++x) {
    const glm::dvec4 present = color_at(v.color.origin + y * v.color.stride, x);
    const double w = weight_of_sample(v, x, y), before = std::max(0.0, double(s.total[x]));
    double a = 1;
    glm::dvec4 blended = present;
    if (before > 0) {
      const glm::dvec4 side = color_at(s.history, x);
      a = w / (before + w);
      blended = side + (present - side) * a;
    }
    const double kept =
        v.alpha_rule == AlphaRule::fixed ? (1 - v.alpha) * (before + w) : std::min(before + w, (1 - v.alpha) / v.alpha);
    color[x] = held_color(blended);
    total[x] = float(std::min(kept, 1e6));  // a count beyond this changes nothing that a float can hold
    spread[x] = before > 0 ? float(double(s.spread[x]) * (1 - a) * (1 - a) + a * a) : w > 0 ? 1.0f : 0.0f;
    all_valid = all_valid && total[x] > 0;
  }
  state.rows_valid[std::size_t(y)] = all_valid;
}

void keep_strict(const AccumulateView& v, int y, const RowScratch& s, StrictSide& strict) {
  const Window& window = strict.color.window();
  for (int x = 0; x < v.width; ++x) {
    const bool speaks = s.total[x] > 0;
    strict.color.row(window.y0 + y)[x] = speaks ? held_color(color_at(s.history, x)) : glm::vec4(0.0f);
    strict.total.row(window.y0 + y)[x] = speaks ? s.total[x] : 0.0f;
    strict.spread.row(window.y0 + y)[x] = speaks ? s.spread[x] : 0.0f;
    if (!strict.reject.empty()) strict.reject.row(window.y0 + y)[x] = s.reject[x];
  }
}

/// One side's word on a pixel.
struct Side {
  glm::dvec4 color;
  double total, spread;
};

/// Differences to a middle are weighed, so that equal colors give that color exactly; every sum is one of two sides, so
/// that their order does not matter.
Side merge(const Side& one, const Side& other, const glm::dvec4& present, double w) {
  const double sides = one.total + other.total, total = sides + w;
  if (!(total > 0)) return {present, 0, 0};
  glm::dvec4 middle = present;
  if (!(w > 0))
    middle = !(one.total > 0) ? other.color : !(other.total > 0) ? one.color : one.color * 0.5 + other.color * 0.5;
  const auto pull = [&](const Side& side) {
    return side.total > 0 ? (side.color - middle) * side.total : glm::dvec4(0.0);
  };
  // A side that says nothing has neither a color nor a spread.
  const auto share2 = [&](const Side& side) { return side.total > 0 ? side.total * side.total * side.spread : 0.0; };
  return {middle + (pull(one) + pull(other)) / total, total, ((share2(one) + share2(other)) + w * w) / (total * total)};
}

void merge_row(const AccumulateView& v, int y, const RowScratch& s, const StrictSide& other, Accumulated& out) {
  const int row = out.history.color.window().y0 + y;
  AccumulateDiagnostics& d = out.diagnostics;
  for (int x = 0; x < v.width; ++x) {
    const Side here{color_at(s.history, x), std::max(0.0, double(s.total[x])), double(s.spread[x])};
    const Side there{glm::dvec4(other.color.row(row)[x]), double(other.total.row(row)[x]),
                     double(other.spread.row(row)[x])};
    const double w = weight_of_sample(v, x, y);
    const Side merged = merge(here, there, color_at(v.color.origin + y * v.color.stride, x), w);
    out.history.color.row(row)[x] = held_color(merged.color);
    out.history.total.row(row)[x] = float(merged.total);
    out.history.spread.row(row)[x] = float(merged.spread);
    if (!d.weight.empty()) d.weight.row(row)[x] = merged.total > 0 ? float(1 - w / merged.total) : 0.0f;
    if (!d.clip.empty()) d.clip.row(row)[x] = std::max(d.clip.row(row)[x], other.clip.row(row)[x]);
    if (!d.reject.empty()) d.reject.row(row)[x] = s.reject[x];
    if (!d.count_past.empty()) {
      d.count_past.row(row)[x] = here.total > 0 ? float(1 / here.spread) : 0.0f;
      d.count_future.row(row)[x] = there.total > 0 ? float(1 / there.spread) : 0.0f;
    }
  }
}

History make_state(const Present& present, const RecursiveParameters& recursive) {
  const Window& w = present.color.window();
  History state;
  state.color = Plane<glm::vec4>(w);
  state.total = Plane<float>(w);
  state.spread = Plane<float>(w);
  state.rows_valid.resize(std::size_t(w.height()));
  remember_surfaces(state, present, recursive);
  return state;
}

/// Fetches, rectifies, discounts, moves on; `finish` does with each row what else is to be done.
template <class Finish>
AccumulateCounts walk_rows(const Present& present, const History& beyond, const RecursiveParameters& recursive,
                           const RectifyParameters& rectify, std::optional<glm::dvec2> jitter,
                           std::uint32_t restart_bit, const DiagnosticsWanted& wanted,
                           AccumulateDiagnostics& diagnostics, History& state, Workers& workers, Isa isa,
                           Finish finish) {
  const int width = present.color.window().width();
  std::vector<std::vector<glm::vec4>> fetched(std::size_t(workers.count()), std::vector<glm::vec4>(std::size_t(width)));
  std::vector<std::size_t> bad(std::size_t(workers.count())), alone(bad);
  const bool discounts = rectify.clip_discount && rectify.box != Box::none;
  RectifyParameters undiscounted = rectify;
  undiscounted.clip_discount = false;  // done here, by this accumulator's own weights
  const auto keep = [&](const AccumulateView& v, int, const RowScratch& s, int worker) {
    if (discounts)
      for (int x = 0; x < v.width; ++x)
        fetched[std::size_t(worker)][std::size_t(x)] =
            s.total[x] > 0 ? held_color(color_at(s.history, x)) : glm::vec4(0.0f);
  };
  const auto move_on = [&](const AccumulateView& v, int y, const RowScratch& s, int worker) {
    if (discounts) discount_clipped(present, v, y, s, fetched[std::size_t(worker)].data());
    for (int x = 0; x < v.width; ++x) {
      if (!(v.weight.origin[y * v.weight.stride + x] > 0)) s.reject[x] |= kRejectPresent;
      if (s.total[x] > 0) continue;
      ++alone[std::size_t(worker)];
      if (s.reject[x] & kRejectVector) ++bad[std::size_t(worker)];
    }
    blend_into_state(v, y, s, state);
    finish(v, y, s);
  };
  AccumulateCounts counts = visit_history(present, beyond, recursive, undiscounted, jitter, restart_bit, wanted,
                                          diagnostics, keep, move_on, workers, isa);
  for (const std::size_t n : alone) counts.restarted += n;
  for (const std::size_t n : bad) counts.vectors_bad += n;
  return counts;
}

}  // namespace

int look_ahead_frames(const TwoSidedParameters& two_sided, double alpha) {
  if (two_sided.look_ahead > 0) return two_sided.look_ahead;
  if (!(alpha < 1)) return 1;
  return int(std::clamp(std::ceil(std::log(0.01) / std::log(1 - alpha)), 1.0, 10000.0));
}

double discounted_weight(double total, double d2_over_r) { return total / (1 + total * d2_over_r); }

SideStep accumulate_side(const Present& present, const History& beyond, const RecursiveParameters& recursive,
                         const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, std::uint32_t restart_bit,
                         const DiagnosticsWanted& wanted, Workers& workers, Isa isa) {
  const Window& w = present.color.window();
  SideStep step{make_state(present, recursive), {Plane<glm::vec4>(w), Plane<float>(w), Plane<float>(w), {}, {}, {}}};
  if (w.empty()) return step;
  if (wanted.reject) step.strict.reject = Plane<std::uint32_t>(w);
  AccumulateDiagnostics diagnostics;
  step.strict.counts = walk_rows(
      present, beyond, recursive, rectify, jitter, restart_bit, {wanted.clip, false, false}, diagnostics, step.state,
      workers, isa, [&](const AccumulateView& v, int y, const RowScratch& s) { keep_strict(v, y, s, step.strict); });
  step.strict.clip = std::move(diagnostics.clip);
  return step;
}

MergedStep accumulate_both(const Present& present, const History& beyond, const StrictSide& other,
                           const RecursiveParameters& recursive, const RectifyParameters& rectify,
                           std::optional<glm::dvec2> jitter, std::uint32_t restart_bit, const DiagnosticsWanted& wanted,
                           Workers& workers, Isa isa) {
  const Window& w = present.color.window();
  MergedStep step{make_state(present, recursive), {}};
  if (w.empty()) return step;
  History& result = step.resolved.history;
  result.color = Plane<glm::vec4>(w);
  result.total = Plane<float>(w);
  result.spread = Plane<float>(w);
  AccumulateDiagnostics& diagnostics = step.resolved.diagnostics;
  if (wanted.counts) {
    diagnostics.count_past = Plane<float>(w);
    diagnostics.count_future = Plane<float>(w);
  }
  if (wanted.reject) diagnostics.reject_future = other.reject.clone();
  step.resolved.counts =
      walk_rows(present, beyond, recursive, rectify, jitter, restart_bit, wanted, diagnostics, step.state, workers, isa,
                [&](const AccumulateView& v, int y, const RowScratch& s) { merge_row(v, y, s, other, step.resolved); });
  step.resolved.counts.clipped += other.counts.clipped;
  return step;
}

}  // namespace varve
