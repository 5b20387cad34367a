// What history held at the previous position of a pixel. Included by the row kernel only.
#pragma once

#include "base/reject.h"
#include "resolve/history_filters.h"

namespace varve::VARVE_ISA {

/// The four pixels around a position, each tested: inside the history, valid, and of the same surface.
/// The bilinear mean of those that pass; `share` is their part of the weight, before normalization.
struct TestedTaps {
  Float4 color;
  float share, total, spread;
  bool depth_failed, all_passed;
};

VARVE_INLINE bool same_depth(float a, float b, double tolerance) {
  if (a == b) return true;  // both background included
  const double difference = __builtin_fabs(double(a) - double(b));
  return difference <= tolerance * smallest(a, b);
}

[[gnu::noinline]] static TestedTaps test_taps(const AccumulateView& v, Axis ax, Axis ay, const float* depth) {
  TestedTaps r{splat(0.0f), 0, 0, 0, false, true};
  Double4 sum = splat(0.0);
  double weights = 0;
  float heaviest = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const float w = (i ? ax.fraction : 1 - ax.fraction) * (j ? ay.fraction : 1 - ay.fraction);
      if (!(w > 0)) continue;
      const int x = ax.base + i, y = ay.base + j;
      const bool inside = x >= 0 && y >= 0 && x < v.history_width && y < v.history_height;
      const float total = inside ? v.history_total.origin[y * v.history_total.stride + x] : 0.0f;
      bool passed = total > 0;
      if (passed && depth &&
          !same_depth(v.history_depth.origin[y * v.history_depth.stride + x], *depth, v.depth_tolerance)) {
        passed = false;
        r.depth_failed = true;
      }
      if (!passed) {
        r.all_passed = false;
        continue;
      }
      sum += widen(load(v.history_color.origin + y * v.history_color.stride + 4 * x)) * double(w);
      weights += double(w);
      // Counts are those of the youngest pixel used; the spread that of the one that counts most.
      r.total = r.share == 0 ? total : (total < r.total ? total : r.total);
      r.share += w;
      if (w > heaviest) heaviest = w, r.spread = v.history_spread.origin[y * v.history_spread.stride + x];
    }
  if (weights > 0) r.color = narrow(sum / weights);
  return r;
}

/// Whether every pixel that a filter of this reach reads has data; all lie inside the history.
[[gnu::noinline]] static bool have_data(const AccumulateView& v, Axis ax, Axis ay, int reach) {
  for (int y = ay.base - reach; y <= ay.base + reach + 1; ++y)
    for (int x = ax.base - reach; x <= ax.base + reach + 1; ++x)
      if (!(v.history_total.origin[y * v.history_total.stride + x] > 0)) return false;
  return true;
}

/// Fetches one pixel's history; total 0 and a reject bit where it has none.
template <HistoryFilter filter>
VARVE_INLINE void fetch_pixel(const AccumulateView& v, int x, int y, const RowScratch& out) {
  const float* motion = v.motion.origin + y * v.motion.stride + 2 * x;
  const double mx = double(motion[0]), my = double(motion[1]);
  out.total[x] = 0;
  if (!(mx * mx + my * my <= v.max_motion * v.max_motion)) {
    out.reject[x] = kRejectVector;
    return;
  }
  // Pixel centres are integers on this grid; half a pixel beyond the outer centres is the window's edge.
  const double hx = x + v.shift_x + mx, hy = y + v.shift_y + my;
  if (!(hx >= -0.5 && hy >= -0.5 && hx <= v.history_width - 0.5 && hy <= v.history_height - 0.5)) {
    out.reject[x] = kRejectWindow;
    return;
  }
  const Axis ax = axis_at(hx), ay = axis_at(hy);
  const float* depth = v.depth.origin ? v.depth.origin + y * v.depth.stride + x : nullptr;
  constexpr int r = reach(filter);
  bool plain = ax.base >= r && ay.base >= r && ax.base + r + 1 < v.history_width && ay.base + r + 1 < v.history_height;
  if (plain) {
    const std::uint8_t* valid = v.history_rows_valid + ay.base;
    bool rows = true;
    for (int j = -r; j <= r + 1; ++j) rows = rows && valid[j];
    // A pixel without data somewhere in the row is no matter of those that do not read it.
    plain = rows || have_data(v, ax, ay, r);
  }

  if (!plain || depth) {
    const TestedTaps tested = test_taps(v, ax, ay, depth);
    if (!(tested.share >= 0.25f)) {
      out.reject[x] = tested.depth_failed ? kRejectDepth : kRejectEmptyHistory;
      return;
    }
    if (!plain || !tested.all_passed) {
      store(out.history + 4 * x, tested.color);
      out.total[x] = tested.total;
      out.spread[x] = tested.spread;
      return;
    }
  }
  const Taps taps{ax, ay, v.history_color.origin + ay.base * v.history_color.stride + 4 * ax.base,
                  v.history_color.stride};
  Float4 color = filter_history<filter, false>(v, taps);
  if (__builtin_expect(!finite(color), 0)) {
    // Sums of values near the end of the float range: once more at 1/16, held to what the pixels hold.
    const Float4 limit = splat(3.40282347e38f * 0.0625f);
    color = least(greatest(filter_history<filter, true>(v, taps), -limit), limit) * 16.0f;
  }
  const float* total = v.history_total.origin + ay.base * v.history_total.stride + ax.base;
  const float* spread = v.history_spread.origin + (ay.base + (ay.fraction >= 0.5f)) * v.history_spread.stride + ax.base;
  // The youngest of the pixels that have a say.
  float age = total[0];
  if (ax.fraction > 0 && total[1] < age) age = total[1];
  if (ay.fraction > 0) {
    const float* below = total + v.history_total.stride;
    if (below[0] < age) age = below[0];
    if (ax.fraction > 0 && below[1] < age) age = below[1];
  }
  store(out.history + 4 * x, color);
  out.total[x] = age;
  out.spread[x] = spread[ax.fraction >= 0.5f];
}

}  // namespace varve::VARVE_ISA
