// Rectification by any shape, rule and space: the row function for all that the row kernel has no code for.
#pragma once

#include "resolve/accumulate.h"
#include "resolve/accumulate_row.h"
#include "resolve/box_space.h"
#include "resolve/hull.h"
#include "resolve/moments_pyramid.h"
#include "resolve/window_moments.h"

namespace varve {

/// True when rectify_shapes() has to run; false when the row kernel does the same faster.
bool needs_shapes(const RectifyParameters& rectify);

/// What the windows around the pixels of a band of rows hold; empty where the samples are looked at one by one.
struct WindowContents {
  WindowBand<Moments> moments;
  WindowBand<Extremes> extremes;
  MomentsPyramid pyramid;
};

/// One frame's choices.
struct ShapeRules {
  RectifyParameters rectify;
  BoxSpaceMap space;
  double alpha = 0.1;  ///< weight of the present in the steady state: history counts (1-alpha)/alpha at most
  bool present_is_sample = false;  ///< the present is the pixel's own sample, not weighed together from several
};

/// Room of one worker.
struct ShapeScratch {
  Samples samples;
  Hull hull;
  PyramidRow pyramid;
};

/// Most rows of a band: the window - 1 rows that two bands both need must be few against that, and 104 bytes a pixel of
/// it no burden (at most 90 MB for 1920 pixels across, with moments and extremes).
inline constexpr int kWindowBandRows = 384;

/// How many rows go together; what is needed once a frame, and once a band.
int band_rows(const ShapeRules& rules, int height);
void prepare_frame(const AccumulateView& view, const ShapeRules& rules, WindowContents& contents, Workers& workers);
void prepare_band(const AccumulateView& view, const ShapeRules& rules, int begin, int end, WindowContents& contents,
                  Workers& workers);

/// Rectifies the fetched history of row y in place, and its weight with clip discount.
void rectify_shapes(const AccumulateView& view, const ShapeRules& rules, const WindowContents& contents, int y,
                    const RowScratch& row, ShapeScratch& scratch, RowCounts& counts);

}  // namespace varve
