// Bringing history into the box: clip along the segment, or clamp per channel. Included by the row kernel only.
#pragma once

#include "resolve/color_box.h"

namespace varve::VARVE_ISA {

/// Moves `h` to where the segment from h to the anchor enters the box. The anchor is the present held inside the box,
/// or the mean: the present itself lies outside a variance box in every fourth pixel, and a segment that ends outside
/// need not meet the box at all (math, 3.6). All four channels share one t, so alpha follows its color.
VARVE_INLINE Double4 clip(const ColorBox& box, Double4 h, Double4 present, BoxAnchor anchor) {
  const Double4 target = anchor == BoxAnchor::mean ? box.mean : present;
  const Double4 g = least(greatest(target, box.low), box.high);
  // Where the segment crosses each face that h lies beyond; g is inside, so nothing is divided by 0 there.
  const Double4 beyond = h > box.high ? box.high : box.low;
  const Mask4 outside = (h > box.high) | (h < box.low);
  const Double4 crossing = outside ? (beyond - g) / (h - g) : splat(1.0);
  const double t = smallest(1.0, least_lane(crossing));
  return g + (h - g) * t;
}

VARVE_INLINE Double4 clamp(const ColorBox& box, Double4 h) { return least(greatest(h, box.low), box.high); }

VARVE_INLINE double length3(Double4 v) {
  return __builtin_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);  // squares of floats fit a double
}

/// True when no pixel of the neighborhood has a say: history stands as it is.
template <int r>
VARVE_INLINE bool alone(const AccumulateView& v, int x, int y) {
  for (int j = -r; j <= r; ++j)
    for (int i = -r; i <= r; ++i)
      if (v.weight.origin[(y + j) * v.weight.stride + x + i] > 0 && !(v.leave_present_out && i == 0 && j == 0))
        return false;
  return true;
}

/// Rectifies one pixel of fetched history in place; true when it was moved, `distance` (may be null) says how far.
template <Box kind, int r, bool masked>
VARVE_INLINE bool rectify_pixel(const AccumulateView& v, int x, int y, float* history, float* distance) {
  if (masked && alone<r>(v, x, y)) return false;
  const Float4 rgb = load(history);
  const bool rotate = v.space == BoxSpace::ycocg;
  const Double4 h = widen(rotate ? ycocg_from_rgb(rgb) : rgb);
  const ColorBox box = color_box<kind, r, masked>(v, x, y);
  if (all_true((h >= box.low) & (h <= box.high))) return false;

  const Float4 present = load(v.color.origin + y * v.color.stride + 4 * x);
  const Double4 moved = v.rule == BoxRule::clip
                            ? clip(box, h, widen(rotate ? ycocg_from_rgb(present) : present), v.anchor)
                            : clamp(box, h);
  const Double4 limit = splat(3.4028234663852886e38);
  const Double4 result = least(greatest(rotate ? rgb_from_ycocg(moved) : moved, -limit), limit);
  store(history, narrow(result));
  if (distance) {
    const double scale = biggest(length3(widen(rgb)), length3(result));
    *distance = scale > 0 ? float(length3(result - widen(rgb)) / scale) : 0;
  }
  return true;
}

}  // namespace varve::VARVE_ISA
