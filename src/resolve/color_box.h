// What the neighborhood of a pixel allows: the box of its colors. Included by the row kernel only.
#pragma once

#include "resolve/accumulate_row.h"
#include "resolve/lanes.h"

namespace varve::VARVE_ISA {

/// Colors from low to high, per channel of the box's space; `mean` is that of the neighborhood.
struct ColorBox {
  Double4 low, high, mean;
};

/// Statistics of a window: count, mean and centred second moment (Salvi 2016, with the arithmetic changed: the raw
/// m2/N - mu^2 cancels), and the extremes.
struct WindowStatistics {
  double n;
  Double4 mean, m2;
  Double4 low, high;
};

/// Gathers the (2r+1)^2 neighbors, shifted by the centre so that nothing cancels (relative error about N^2 u whatever
/// the data), in double so that squares neither over- nor underflow. Pixels of weight 0 do not count; with
/// `masked` false the caller knows that there are none.
template <int r, bool with_moments, bool with_extremes, bool masked>
VARVE_INLINE WindowStatistics gather_window(const AccumulateView& v, int x, int y) {
  const std::ptrdiff_t stride = v.neighbors.stride;
  const float* centre = v.neighbors.origin + y * stride + 4 * x;
  // A pixel left out must not even leave its rounding: its neighbor takes its place as the shift.
  const Double4 pivot = widen(load(masked && v.leave_present_out ? centre - 4 : centre));
  Double4 sum = splat(0.0), squares = splat(0.0);
  Float4 low = splat(__builtin_inff()), high = splat(-__builtin_inff());
  double n = 0;
#pragma GCC unroll 7
  for (int j = -r; j <= r; ++j) {
    const float* row = centre + j * stride - 4 * r;
    const float* weight = v.weight.origin + (y + j) * v.weight.stride + x - r;
#pragma GCC unroll 7
    for (int i = 0; i <= 2 * r; ++i) {
      const Float4 c = load(row + 4 * i);
      if (masked && (!(weight[i] > 0) || (v.leave_present_out && i == r && j == 0))) continue;
      if constexpr (with_extremes) {
        low = least(c, low);
        high = greatest(c, high);
      }
      if constexpr (with_moments) {
        const Double4 d = widen(c) - pivot;
        sum += d;
        squares += d * d;
      }
      if constexpr (masked) n += 1;
    }
  }
  if constexpr (!masked) n = (2 * r + 1) * (2 * r + 1);
  WindowStatistics s{n, pivot, splat(0.0), widen(low), widen(high)};
  if constexpr (with_moments) {
    const Double4 offset = sum / n;
    s.mean = pivot + offset;
    s.m2 = squares - sum * offset;
  }
  return s;
}

/// The box of a window. It is widened by a millionth of the mean's size, so that a flat patch does not clip history
/// by its rounding noise; the scale is common to the color channels, because chroma of a grey is 0.
template <Box kind, int r, bool masked>
VARVE_INLINE ColorBox color_box(const AccumulateView& v, int x, int y) {
  constexpr bool moments = kind != Box::minmax;
  constexpr bool extremes = kind != Box::variance;
  const WindowStatistics s = gather_window<r, moments, extremes, masked>(v, x, y);
  ColorBox box{s.low, s.high, s.mean};
  if constexpr (moments) {
    const Double4 sigma = square_root(greatest(s.m2 / s.n, splat(0.0)));
    const Double4 low = s.mean - sigma * v.gamma, high = s.mean + sigma * v.gamma;
    box.low = extremes ? greatest(low, s.low) : low;
    box.high = extremes ? least(high, s.high) : high;
  } else {
    box.mean = s.low * 0.5 + s.high * 0.5;
  }
  const Double4 size = magnitude(box.mean);
  const double scale = biggest(size[0], biggest(size[1], size[2]));
  const Double4 floor = Double4{scale, scale, scale, size[3]} * 1e-6;
  box.low -= floor;
  box.high += floor;
  return box;
}

}  // namespace varve::VARVE_ISA
