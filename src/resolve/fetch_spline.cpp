// The first step of a row with the cubic and B-spline filters: compiled once (VARVE_ISA is spline), so that the kernels
// stay small.
#include "resolve/fetch_history.h"

namespace varve::spline {
namespace {

template <HistoryFilter filter>
void fetch_row(const AccumulateView& v, int y, const RowScratch& s) {
  for (int x = 0; x < v.width; ++x) fetch_pixel<filter>(v, x, y, s);
}

}  // namespace

void fetch_history(const AccumulateView& v, int y, const RowScratch& s) {
  if (v.history_width == 0) {
    for (int x = 0; x < v.width; ++x) s.total[x] = 0, s.reject[x] = v.restart_bit;
    return;
  }
  for (int x = 0; x < v.width; ++x) s.reject[x] = 0;
  if (v.filter == HistoryFilter::cubic) return fetch_row<HistoryFilter::cubic>(v, y, s);
  if (v.filter == HistoryFilter::bspline3) return fetch_row<HistoryFilter::bspline3>(v, y, s);
  fetch_row<HistoryFilter::bspline5>(v, y, s);
}

}  // namespace varve::spline
