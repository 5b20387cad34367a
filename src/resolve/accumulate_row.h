// What the row kernel of the recursive accumulator sees: plain pointers and numbers, nothing else.
// The kernel is compiled for the baseline processor and for AVX2; both give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "resolve/choices.h"

namespace varve {

/// First pixel of a plane's window, and the distance between rows in elements.
template <class T>
struct PixelRows {
  T* origin;
  std::ptrdiff_t stride;
};

/// One frame of one subject. Coordinates inside are relative to the window's corner; `shift` leads from there to the
/// corner of the history's window. Color planes are RGBA, four floats a pixel.
struct AccumulateView {
  int width, height;

  // The present. `weight` is 1 where the color is valid and 0 elsewhere, also in the border, which is at least `radius`
  // wide.
  PixelRows<const float> color;      // reconstructed present, what is blended in
  PixelRows<const float> neighbors;  // raw samples in the space of the box
  PixelRows<const float> weight;
  PixelRows<const float> motion;         // two floats: previous position minus this one, pixels; NaN where unusable
  PixelRows<const float> depth;          // null without the depth test
  PixelRows<const float> sample_weight;  // null: 1 everywhere
  const std::uint8_t* rows_valid;        // 1 for each row, `radius` more at both ends: every pixel of it valid
  int radius;                            // of the neighborhood

  // The history; width 0 when there is none.
  int history_width, history_height;
  double shift_x, shift_y;  // window corner of the present minus that of the history
  PixelRows<const float> history_color;
  PixelRows<const float> history_total;   // sum of sample weights so far, 0: no data
  PixelRows<const float> history_spread;  // sum of squared normalized weights
  PixelRows<const float> history_depth;
  PixelRows<const float> history_spline;  // coefficients of a B-spline through the colors; null with other filters
  const std::uint8_t* history_rows_valid;

  // What goes out.
  PixelRows<float> out_color, out_total, out_spread;
  PixelRows<float> out_clip, out_weight;  // null if not wanted
  PixelRows<std::uint32_t> out_reject;    // null if not wanted
  std::uint8_t* out_rows_valid;
  std::uint32_t restart_bit;  // what to note where there is no history at all

  // Choices.
  HistoryFilter filter;
  double cubic_b, cubic_c;  // of the filter cubic
  bool dering;
  Box box;
  BoxRule rule;
  BoxAnchor anchor;
  BoxSpace space;
  double gamma;
  AlphaRule alpha_rule;
  double alpha;
  double depth_tolerance;
  double max_motion;
  bool leave_present_out;  // the pixel itself is no part of its neighborhood and is not blended in
};

/// Sums over a row, added up by the caller.
struct RowCounts {
  std::size_t restarted, clipped, vectors_bad;
};

/// Working space of one row: width pixels of four floats, and one flag a pixel.
struct RowScratch {
  float* history;  // fetched history color
  float* total;    // its weight sum; 0 where there is none
  float* spread;
  std::uint32_t* reject;
  const double* present_weight = nullptr;  // of each pixel with a history; null: by alpha and its rule
};

// The three steps of a row, in running order. Between them stand row passes that need no processor of their own.
namespace baseline {
void fetch_history(const AccumulateView& view, int y, const RowScratch& scratch);
void rectify_history(const AccumulateView& view, int y, const RowScratch& scratch, RowCounts& counts);
void blend_present(const AccumulateView& view, int y, const RowScratch& scratch, RowCounts& counts);
}  // namespace baseline
namespace avx2 {
void fetch_history(const AccumulateView& view, int y, const RowScratch& scratch);
void rectify_history(const AccumulateView& view, int y, const RowScratch& scratch, RowCounts& counts);
void blend_present(const AccumulateView& view, int y, const RowScratch& scratch, RowCounts& counts);
}  // namespace avx2
// The first step with the filters that are not worth a processor of their own.
namespace spline {
void fetch_history(const AccumulateView& view, int y, const RowScratch& scratch);
}  // namespace spline

}  // namespace varve
