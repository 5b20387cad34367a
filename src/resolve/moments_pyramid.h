// Moments of ever larger squares by repeated halving (Salvi 2016: "repeatedly downsample").
#pragma once

#include <vector>

#include "base/parallel.h"
#include "resolve/accumulate_row.h"
#include "resolve/moments.h"

namespace varve {

/// Level l holds squares of 2^l pixels counted from the corner of the window; level 0 is the view itself.
struct MomentsPyramid {
  struct Level {
    int width = 0, height = 0;
    std::vector<Moments> nodes;
  };
  std::vector<Level> levels;  // from 1 on
  int lower = 0;              // the two levels that are mixed are lower and lower + 1
  double upper_share = 0;
};

/// For a blur of the variance of a box `window` pixels wide. About 24 bytes a pixel.
MomentsPyramid make_pyramid(const AccumulateView& view, int window, Workers& workers);

/// The two levels, mixed along y for one row of pixels; empty where a level has no share.
struct PyramidRow {
  std::vector<Moments> lower, upper;
};
void mix_pyramid_row(const MomentsPyramid& pyramid, const AccumulateView& view, int y, PyramidRow& row);

/// Around a pixel of that row: bilinear in two levels, linear between them. Distributions are mixed, not their moments,
/// so the variance between the squares counts too. The blur is wide and soft, and varies a little with the pixel's
/// place in its square: less exact than sliding windows.
Moments sample_pyramid(const MomentsPyramid& pyramid, const PyramidRow& row, int x);

}  // namespace varve
