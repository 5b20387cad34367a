// Moments and extremes of windows of any width, at a cost per pixel that does not grow with the width.
#pragma once

#include <array>
#include <vector>

#include "base/parallel.h"
#include "resolve/accumulate_row.h"
#include "resolve/moments.h"

namespace varve {

/// Widths of the windows that are slid one after the other along each axis; 1: none. One is the plain window; three
/// near a third of it weigh the samples by a quadratic B-spline, the bell that three boxes make of a Gaussian (Salvi
/// 2016: "or some other filter"); it ends exactly at the window's edge.
std::array<int, 3> slid_widths(int window, WindowMoments moments);

/// What the windows of a band of rows hold, row after row, `width` pixels each.
template <class Node>
struct WindowBand {
  int begin = 0, width = 0;
  std::vector<Node> nodes;

  const Node& at(int x, int y) const { return nodes[std::size_t(y - begin) * std::size_t(width) + std::size_t(x)]; }
};

/// Fills the band [begin, end) from view.neighbors, leaving out pixels of weight 0 and everything outside the frame.
/// Holds end - begin + window - 1 rows of nodes (72 bytes a pixel for Moments, 32 for Extremes). Node is one of them.
template <class Node>
void gather_band(const AccumulateView& view, int window, const std::array<int, 3>& widths, int begin, int end,
                 WindowBand<Node>& band, Workers& workers);

extern template void gather_band(const AccumulateView&, int, const std::array<int, 3>&, int, int, WindowBand<Moments>&,
                                 Workers&);
extern template void gather_band(const AccumulateView&, int, const std::array<int, 3>&, int, int, WindowBand<Extremes>&,
                                 Workers&);

}  // namespace varve
