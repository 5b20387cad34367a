// What history held at the previous position of a pixel. Included by the row kernel only.
#pragma once

#include "base/reject.h"
#include "resolve/accumulate_row.h"
#include "resolve/lanes.h"

namespace varve::VARVE_ISA {

/// One axis of the sampling grid: the pixel at or below the position, and the fraction towards the next.
struct Axis {
  int base;
  float fraction;
};

/// `position` is known to fit an int.
VARVE_INLINE Axis axis_at(double position) {
  const int towards_zero = int(position);
  const int base = towards_zero - (double(towards_zero) > position);  // floor, without a call on older processors
  return {base, float(position - base)};
}

/// Catmull-Rom weights (Keys, a = -1/2) of the pixels base-1 .. base+2, as four cubics at once; exact at f = 0.
VARVE_INLINE Float4 catmull_rom_weights(float f) {
  const Float4 cubic{-0.5f, 1.5f, -1.5f, 0.5f}, square{1.0f, -2.5f, 2.0f, -0.5f}, linear{-0.5f, 0.0f, 0.5f, 0.0f};
  const Float4 constant{0.0f, 1.0f, 0.0f, 0.0f};
  return ((cubic * f + square) * f + linear) * f + constant;
}

/// The same by three taps, the middle one a linear blend of two pixels (the form GPUs use: 9 fetches for 16 pixels).
VARVE_INLINE Float4 weigh3(Float4 a, Float4 b, Float4 c, Float4 d, Float4 w) {
  const float middle = w[1] + w[2];
  return a * w[0] + (b + (c - b) * (w[2] / middle)) * middle + d * w[3];
}

/// Weights of history pixels around a position.
struct Taps {
  Axis x, y;
  const float* corner;  // pixel (x.base, y.base)
  std::ptrdiff_t stride;
};

/// A history pixel; a power of two smaller where sums of the values themselves would overflow.
template <bool scaled>
VARVE_INLINE Float4 tap(const float* p) {
  return scaled ? load(p) * 0.0625f : load(p);
}

/// Four pixels of a row, weighed. Differences to the nearest tap are summed, not the taps: a constant stays that
/// constant.
template <bool scaled>
VARVE_INLINE Float4 weigh4(const float* p, Float4 w, Float4 nearest) {
  return (tap<scaled>(p) - nearest) * w[0] + (tap<scaled>(p + 4) - nearest) * w[1] +
         (tap<scaled>(p + 8) - nearest) * w[2] + (tap<scaled>(p + 12) - nearest) * w[3];
}

template <bool scaled>
VARVE_INLINE Float4 nearest_tap(const Taps& t) {
  return tap<scaled>(t.corner + (t.y.fraction < 0.5f ? 0 : t.stride) + (t.x.fraction < 0.5f ? 0 : 4));
}

template <bool scaled>
VARVE_INLINE Float4 bilinear(const Taps& t) {
  const Float4 nearest = nearest_tap<scaled>(t);
  const Float4 a = tap<scaled>(t.corner) - nearest, b = tap<scaled>(t.corner + 4) - nearest;
  const Float4 c = tap<scaled>(t.corner + t.stride) - nearest, d = tap<scaled>(t.corner + t.stride + 4) - nearest;
  const Float4 top = a + (b - a) * t.x.fraction, bottom = c + (d - c) * t.x.fraction;
  return nearest + (top + (bottom - top) * t.y.fraction);
}

template <bool scaled>
VARVE_INLINE Float4 catmull_rom16(const Taps& t) {
  const Float4 wx = catmull_rom_weights(t.x.fraction), wy = catmull_rom_weights(t.y.fraction);
  const Float4 nearest = nearest_tap<scaled>(t);
  const float* p = t.corner - t.stride - 4;
  Float4 sum = weigh4<scaled>(p, wx, nearest) * wy[0];
  for (int j = 1; j < 4; ++j) sum += weigh4<scaled>(p + j * t.stride, wx, nearest) * wy[j];
  return nearest + sum;
}

template <bool scaled>
VARVE_INLINE Float4 catmull_rom9(const Taps& t) {
  const Float4 wx = catmull_rom_weights(t.x.fraction), wy = catmull_rom_weights(t.y.fraction);
  const Float4 nearest = nearest_tap<scaled>(t);
  Float4 row[4];
  for (int j = 0; j < 4; ++j) {
    const float* p = t.corner + (j - 1) * t.stride - 4;
    row[j] = weigh3(tap<scaled>(p) - nearest, tap<scaled>(p + 4) - nearest, tap<scaled>(p + 8) - nearest,
                    tap<scaled>(p + 12) - nearest, wx);
  }
  return nearest + weigh3(row[0], row[1], row[2], row[3], wy);
}

/// Without the four corners, renormalized by what is left (Jimenez; unnormalized it darkens by 1.6 % a pass).
template <bool scaled>
VARVE_INLINE Float4 catmull_rom5(const Taps& t) {
  const Float4 wx = catmull_rom_weights(t.x.fraction), wy = catmull_rom_weights(t.y.fraction);
  const Float4 inner{0.0f, wx[1], wx[2], 0.0f};
  const Float4 nearest = nearest_tap<scaled>(t);
  const float* p = t.corner - t.stride - 4;
  const Float4 sum = weigh4<scaled>(p, inner, nearest) * wy[0] + weigh4<scaled>(p + t.stride, wx, nearest) * wy[1] +
                     weigh4<scaled>(p + 2 * t.stride, wx, nearest) * wy[2] +
                     weigh4<scaled>(p + 3 * t.stride, inner, nearest) * wy[3];
  const float left = 1.0f - (wx[0] + wx[3]) * (wy[0] + wy[3]);
  return nearest + sum / left;
}

/// Between the least and the greatest of the four nearest pixels: no overshoot next to highlights.
template <bool scaled>
VARVE_INLINE Float4 held_by_nearest4(const Taps& t, Float4 v) {
  const Float4 a = tap<scaled>(t.corner), b = tap<scaled>(t.corner + 4);
  const Float4 c = tap<scaled>(t.corner + t.stride), d = tap<scaled>(t.corner + t.stride + 4);
  const Float4 low = least(least(a, b), least(c, d)), high = greatest(greatest(a, b), greatest(c, d));
  return least(greatest(v, low), high);
}

template <HistoryFilter filter, bool scaled>
VARVE_INLINE Float4 filter_history(const Taps& taps, bool dering) {
  if constexpr (filter == HistoryFilter::bilinear) return bilinear<scaled>(taps);
  Float4 v;
  if constexpr (filter == HistoryFilter::catmull_rom) v = catmull_rom16<scaled>(taps);
  if constexpr (filter == HistoryFilter::catmull_rom9) v = catmull_rom9<scaled>(taps);
  if constexpr (filter == HistoryFilter::catmull_rom5) v = catmull_rom5<scaled>(taps);
  const Float4 held = held_by_nearest4<scaled>(taps, v);
  if (dering) return held;
  return Float4{v[0], v[1], v[2], held[3]};  // coverage never overshoots
}

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
  const bool inside = ax.base >= 1 && ay.base >= 1 && ax.base + 2 < v.history_width && ay.base + 2 < v.history_height;
  const std::uint8_t* valid = v.history_rows_valid + ay.base;
  const bool plain = inside && valid[-1] && valid[0] && valid[1] && valid[2];

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
  Float4 color = filter_history<filter, false>(taps, v.dering);
  if (__builtin_expect(!finite(color), 0)) {
    // Sums of values near the end of the float range: once more at 1/16, held to what the pixels hold.
    const Float4 limit = splat(3.40282347e38f * 0.0625f);
    color = least(greatest(filter_history<filter, true>(taps, v.dering), -limit), limit) * 16.0f;
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
