// Filters that read history between its pixels. Included by the row kernels only.
#pragma once

#include "resolve/accumulate_row.h"
#include "resolve/lanes.h"
#include "resolve/resampling_kernel.h"

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

/// Least and greatest of the 4x4 pixels that count positively: with B = 0 the four nearest, with B = 1 all.
template <bool scaled>
VARVE_INLINE Float4 held_by_positive(const Taps& t, Float4 wx, Float4 wy, Float4 v) {
  Float4 low = splat(3.40282347e38f), high = -low;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const bool inner = (i == 1 || i == 2) && (j == 1 || j == 2);
      if (!inner && !(wx[i] > 0 && wy[j] > 0)) continue;
      const Float4 c = tap<scaled>(t.corner + (j - 1) * t.stride + 4 * (i - 1));
      low = least(low, c), high = greatest(high, c);
    }
  return least(greatest(v, low), high);
}

/// The cubics of Mitchell and Netravali 1988.
template <bool scaled>
VARVE_INLINE Float4 cubic(const AccumulateView& v, const Taps& t) {
  const CubicWeights x = cubic_weights(v.cubic_b, v.cubic_c, double(t.x.fraction));
  const CubicWeights y = cubic_weights(v.cubic_b, v.cubic_c, double(t.y.fraction));
  const Float4 wx{float(x.w[0]), float(x.w[1]), float(x.w[2]), float(x.w[3])};
  const Float4 wy{float(y.w[0]), float(y.w[1]), float(y.w[2]), float(y.w[3])};
  const Float4 nearest = nearest_tap<scaled>(t);
  Float4 sum = splat(0.0f);
  for (int j = 0; j < 4; ++j) sum += weigh4<scaled>(t.corner + (j - 1) * t.stride - 4, wx, nearest) * wy[j];
  const Float4 result = nearest + sum, held = held_by_positive<scaled>(t, wx, wy, result);
  return v.dering ? held : Float4{result[0], result[1], result[2], held[3]};
}

/// Interpolating B-spline (Unser 1999): the kernel of the degree over coefficients that make it meet the pixels.
template <int degree, bool scaled>
VARVE_INLINE Float4 bspline(const AccumulateView& v, const Taps& t) {
  if (!(t.x.fraction > 0 || t.y.fraction > 0)) return tap<scaled>(t.corner);  // met exactly, not but for rounding
  constexpr int r = degree / 2;
  const BsplineWeights wx = bspline_weights(degree, double(t.x.fraction));
  const BsplineWeights wy = bspline_weights(degree, double(t.y.fraction));
  const Float4 nearest = nearest_tap<scaled>(t);
  const std::ptrdiff_t at = t.y.base * v.history_spline.stride + 4 * t.x.base;
  Float4 sum = splat(0.0f);
  for (int j = -r; j <= r + 1; ++j) {
    const float* p = v.history_spline.origin + at + j * v.history_spline.stride;
    Float4 row = splat(0.0f);
    for (int i = -r; i <= r + 1; ++i) row += (tap<scaled>(p + 4 * i) - nearest) * float(wx.w[i + r]);
    sum += row * float(wy.w[j + r]);
  }
  const Float4 result = nearest + sum, held = held_by_nearest4<scaled>(t, result);
  return v.dering ? held : Float4{result[0], result[1], result[2], held[3]};
}

/// Pixels that a filter reads before the one at or below the position; after it one more.
constexpr int reach(HistoryFilter filter) { return filter == HistoryFilter::bspline5 ? 2 : 1; }

template <HistoryFilter filter, bool scaled>
VARVE_INLINE Float4 filter_history(const AccumulateView& view, const Taps& taps) {
  if constexpr (filter == HistoryFilter::bilinear) return bilinear<scaled>(taps);
  if constexpr (filter == HistoryFilter::cubic) return cubic<scaled>(view, taps);
  if constexpr (filter == HistoryFilter::bspline3) return bspline<3, scaled>(view, taps);
  if constexpr (filter == HistoryFilter::bspline5) return bspline<5, scaled>(view, taps);
  Float4 v;
  if constexpr (filter == HistoryFilter::catmull_rom) v = catmull_rom16<scaled>(taps);
  if constexpr (filter == HistoryFilter::catmull_rom9) v = catmull_rom9<scaled>(taps);
  if constexpr (filter == HistoryFilter::catmull_rom5) v = catmull_rom5<scaled>(taps);
  const Float4 held = held_by_nearest4<scaled>(taps, v);
  if (view.dering) return held;
  return Float4{v[0], v[1], v[2], held[3]};  // coverage never overshoots
}

}  // namespace varve::VARVE_ISA
