// The steps of one row of the recursive accumulator: fetch, rectify, blend. Compiled once per processor (VARVE_ISA).
#include "resolve/accumulate_row.h"

#include "resolve/fetch_history.h"
#include "resolve/rectify.h"

namespace varve::VARVE_ISA {
namespace {

template <HistoryFilter filter>
void fetch_row(const AccumulateView& v, int y, const RowScratch& s) {
  for (int x = 0; x < v.width; ++x) fetch_pixel<filter>(v, x, y, s);
}

template <Box kind, int r, bool masked>
void rectify_span(const AccumulateView& v, int y, int begin, int end, const RowScratch& s, RowCounts& counts) {
  float* distances = v.out_clip.origin ? v.out_clip.origin + y * v.out_clip.stride : nullptr;
  for (int x = begin; x < end; ++x) {
    float* distance = distances ? distances + x : nullptr;
    if (distance) *distance = 0;
    if (s.total[x] > 0) counts.clipped += rectify_pixel<kind, r, masked>(v, x, y, s.history + 4 * x, distance);
  }
}

template <Box kind, int r>
void rectify_row(const AccumulateView& v, int y, const RowScratch& s, RowCounts& counts) {
  bool valid = !v.leave_present_out;
  for (int j = -r; j <= r; ++j) valid = valid && v.rows_valid[y + j];
  // Where every neighbor is known to count, the test for it is left out; the result is the same.
  const int begin = valid ? (r < v.width ? r : v.width) : v.width;
  const int end = valid ? (v.width - r > begin ? v.width - r : begin) : v.width;
  rectify_span<kind, r, true>(v, y, 0, begin, s, counts);
  rectify_span<kind, r, false>(v, y, begin, end, s, counts);
  rectify_span<kind, r, true>(v, y, end, v.width, s, counts);
}

template <Box kind>
void rectify_row(const AccumulateView& v, int y, const RowScratch& s, RowCounts& counts) {
  if (v.radius == 1) return rectify_row<kind, 1>(v, y, s, counts);
  if (v.radius == 2) return rectify_row<kind, 2>(v, y, s, counts);
  rectify_row<kind, 3>(v, y, s, counts);
}

/// Weight of the present, in (0, 1]. `total` is the weight of all samples before, `w` that of this one (1 on average).
VARVE_INLINE double present_weight(const AccumulateView& v, double total, double w) {
  // alpha is meant for a sample of weight 1; others move it in proportion, seen from the steady state.
  const double steady = w == 1 ? v.alpha : v.alpha * w / (1 - v.alpha + v.alpha * w);
  return v.alpha_rule == AlphaRule::fixed ? steady : biggest(steady, w / (total + w));
}

/// The rectified history alone; 0 where there is none.
void copy_history(const AccumulateView& v, int y, const RowScratch& s) {
  for (int x = 0; x < v.width; ++x) {
    const bool has_history = s.total[x] > 0;
    store(v.out_color.origin + y * v.out_color.stride + 4 * x, has_history ? load(s.history + 4 * x) : splat(0.0f));
    v.out_total.origin[y * v.out_total.stride + x] = s.total[x];
    v.out_spread.origin[y * v.out_spread.stride + x] = has_history ? s.spread[x] : 0;
  }
}

template <bool weighed>
void blend_row(const AccumulateView& v, int y, const RowScratch& s, RowCounts& counts) {
  const float* weight = v.weight.origin + y * v.weight.stride;
  bool all_valid = true;
  for (int x = 0; x < v.width; ++x) {
    const Float4 present = load(v.color.origin + y * v.color.stride + 4 * x);
    const bool has_present = weight[x] > 0, has_history = s.total[x] > 0;
    const double w = !has_present             ? 0.0
                     : v.sample_weight.origin ? double(v.sample_weight.origin[y * v.sample_weight.stride + x])
                                              : 1.0;
    Float4 color = present;
    double a = 1, total = w, spread = has_present ? 1 : 0;
    if (has_history) {
      const Float4 history = load(s.history + 4 * x);
      a = w <= 0 ? 0.0 : weighed ? s.present_weight[x] : present_weight(v, double(s.total[x]), w);
      color = narrow(widen(history) + (widen(present) - widen(history)) * a);
      total = double(s.total[x]) + w;
      spread = double(s.spread[x]) * (1 - a) * (1 - a) + a * a;
    } else {
      ++counts.restarted;
      if (s.reject[x] & kRejectVector) ++counts.vectors_bad;
    }
    if (!has_present) s.reject[x] |= kRejectPresent;
    all_valid = all_valid && total > 0;
    store(v.out_color.origin + y * v.out_color.stride + 4 * x, color);
    // A count beyond this changes nothing that a float can hold.
    v.out_total.origin[y * v.out_total.stride + x] = float(smallest(total, 1e6));
    v.out_spread.origin[y * v.out_spread.stride + x] = float(spread);
    if (v.out_weight.origin) v.out_weight.origin[y * v.out_weight.stride + x] = float(1 - a);
    if (v.out_reject.origin) v.out_reject.origin[y * v.out_reject.stride + x] = s.reject[x];
  }
  v.out_rows_valid[y] = all_valid;
}

}  // namespace

void fetch_history(const AccumulateView& v, int y, const RowScratch& s) {
  if (v.history_width == 0) {
    for (int x = 0; x < v.width; ++x) s.total[x] = 0, s.reject[x] = v.restart_bit;
    return;
  }
  for (int x = 0; x < v.width; ++x) s.reject[x] = 0;
  switch (v.filter) {
    case HistoryFilter::bilinear:
      return fetch_row<HistoryFilter::bilinear>(v, y, s);
    case HistoryFilter::catmull_rom:
      return fetch_row<HistoryFilter::catmull_rom>(v, y, s);
    case HistoryFilter::catmull_rom9:
      return fetch_row<HistoryFilter::catmull_rom9>(v, y, s);
    case HistoryFilter::catmull_rom5:
      return fetch_row<HistoryFilter::catmull_rom5>(v, y, s);
    case HistoryFilter::cubic:
    case HistoryFilter::bspline3:
    case HistoryFilter::bspline5:
      return;  // fetched by spline::fetch_history
  }
}

void rectify_history(const AccumulateView& v, int y, const RowScratch& s, RowCounts& counts) {
  switch (v.box) {
    case Box::none:
      if (v.out_clip.origin)
        for (int x = 0; x < v.width; ++x) v.out_clip.origin[y * v.out_clip.stride + x] = 0;
      return;
    case Box::minmax:
      return rectify_row<Box::minmax>(v, y, s, counts);
    case Box::variance:
      return rectify_row<Box::variance>(v, y, s, counts);
    case Box::variance_minmax:
      return rectify_row<Box::variance_minmax>(v, y, s, counts);
    case Box::rounded:
    case Box::dynamic4:
    case Box::kdop7:
    case Box::kdop13:
    case Box::pca:
    case Box::ellipsoid:
    case Box::hull:
      return;  // rectify_shapes() runs instead of this step
  }
}

void blend_present(const AccumulateView& view, int y, const RowScratch& scratch, RowCounts& counts) {
  if (view.leave_present_out)
    copy_history(view, y, scratch);
  else if (scratch.present_weight)
    blend_row<true>(view, y, scratch, counts);
  else
    blend_row<false>(view, y, scratch, counts);
}

}  // namespace varve::VARVE_ISA
