// Bringing history into the box: clip along the segment, or clamp per channel. Included by the row kernel only.
#pragma once

#include "resolve/color_box.h"

namespace varve::VARVE_ISA {

/// Moves `h` to where the segment from h to the anchor enters the box. The anchor is the present held inside the box, or
/// the mean: the present itself lies outside a variance box in every fourth pixel, and a segment that ends outside need
/// not meet the box at all (math, 3.6). All four channels share one t, so alpha follows its color.
VARVE_INLINE Double4 clip(const ColorBox& box, Double4 h, Double4 present, BoxAnchor anchor) {
  const Double4 target = anchor == BoxAnchor::mean ? box.mean : present;
  const Double4 g = least(greatest(target, box.low), box.high);
  double t = 1;
  for (int k = 0; k < 4; ++k) {
    if (h[k] > box.high[k]) t = smallest(t, (box.high[k] - g[k]) / (h[k] - g[k]));
    if (h[k] < box.low[k]) t = smallest(t, (box.low[k] - g[k]) / (h[k] - g[k]));
  }
  return g + (h - g) * t;
}

VARVE_INLINE Double4 clamp(const ColorBox& box, Double4 h) { return least(greatest(h, box.low), box.high); }

VARVE_INLINE double length3(Double4 v) {
  // Scaled by the largest part: squares of float-range values fit a double, tiny ones must not vanish either.
  return square_root(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// Rectifies one pixel of fetched history in place; returns the clip distance (0: inside the box, nothing changed).
template <Box kind, bool masked>
VARVE_INLINE double rectify_pixel(const AccumulateView& v, int x, int y, float* history) {
  const Float4 rgb = load(history);
  const bool rotate = v.space == BoxSpace::ycocg;
  const Double4 h = widen(rotate ? ycocg_from_rgb(rgb) : rgb);
  if (masked && !(v.weight.origin[y * v.weight.stride + x] > 0)) {
    // Without a valid present, the neighbors may be few or none; without any, history stands as it is.
    bool any = false;
    for (int j = -v.radius; j <= v.radius && !any; ++j)
      for (int i = -v.radius; i <= v.radius && !any; ++i)
        any = v.weight.origin[(y + j) * v.weight.stride + x + i] > 0;
    if (!any) return 0;
  }
  const ColorBox box = color_box<kind, masked>(v, x, y);
  if (all_true(h >= box.low) && all_true(h <= box.high)) return 0;

  const Float4 present = load(v.color.origin + y * v.color.stride + 4 * x);
  const Double4 moved = v.rule == BoxRule::clip
                            ? clip(box, h, widen(rotate ? ycocg_from_rgb(present) : present), v.anchor)
                            : clamp(box, h);
  const Double4 limit = splat(3.4028234663852886e38);
  const Double4 result = least(greatest(rotate ? rgb_from_ycocg(moved) : moved, -limit), limit);
  store(history, narrow(result));
  const double scale = biggest(length3(widen(rgb)), length3(result));
  return scale > 0 ? length3(result - widen(rgb)) / scale : 0;
}

}  // namespace varve::VARVE_ISA
