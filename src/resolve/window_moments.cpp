#include "resolve/window_moments.h"

#include "resolve/sliding_window.h"

namespace varve {
namespace {

void set_node(Moments& node, const float* color) {
  node.n = 1;
  for (int k = 0; k < 4; ++k) node.mean[k] = double(color[k]), node.m2[k] = 0;
}
void set_node(Extremes& node, const float* color) {
  for (int k = 0; k < 4; ++k) node.low[k] = node.high[k] = color[k];
}

/// The windows of one row; `line` is room for width + window - 1 nodes.
template <class Node>
void slide_row(const AccumulateView& v, int y, int window, const std::array<int, 3>& widths, Node* line) {
  const int r = window / 2, length = v.width + window - 1;
  std::fill(line, line + length, Node{});
  if (y < 0 || y >= v.height) return;
  const float* color = v.neighbors.origin + y * v.neighbors.stride;
  const float* weight = v.weight.origin + y * v.weight.stride;
  for (int x = 0; x < v.width; ++x)
    if (weight[x] > 0) set_node(line[x + r], color + 4 * x);
  int left = length;
  for (const int width : widths) {
    slide(line, 1, left, width, 1);
    left -= width - 1;
  }
}

}  // namespace

std::array<int, 3> slid_widths(int window, WindowMoments moments) {
  if (moments != WindowMoments::gaussian) return {window, 1, 1};
  // The three add up to window + 2; equal halves of what the first leaves, so two even widths cancel their half pixels.
  int first = (window + 2) / 3;
  if (first % 2 == 0) ++first;
  return {first, (window + 2 - first) / 2, (window + 2 - first) / 2};
}

template <class Node>
void gather_band(const AccumulateView& view, int window, const std::array<int, 3>& widths, int begin, int end,
                 WindowBand<Node>& band, Workers& workers) {
  const int r = window / 2, rows = end - begin + 2 * r;
  const std::size_t width = std::size_t(view.width);
  band.begin = begin;
  band.width = view.width;
  band.nodes.resize(std::size_t(rows) * width);
  std::vector<std::vector<Node>> lines(std::size_t(workers.count()));
  workers.for_each(std::size_t(rows), [&](std::size_t row, int worker) {
    std::vector<Node>& line = lines[std::size_t(worker)];
    line.resize(width + 2 * std::size_t(r));
    slide_row(view, begin - r + int(row), window, widths, line.data());
    std::copy(line.begin(), line.begin() + view.width, band.nodes.begin() + std::ptrdiff_t(row * width));
  });
  const std::size_t strips = (width + kMostLanes - 1) / kMostLanes;
  workers.for_each(strips, [&](std::size_t strip, int) {
    const int x = int(strip) * kMostLanes, lanes = std::min(kMostLanes, view.width - x);
    int left = rows;
    for (const int slid : widths) {
      slide(band.nodes.data() + x, view.width, left, slid, lanes);
      left -= slid - 1;
    }
  });
}

template void gather_band(const AccumulateView&, int, const std::array<int, 3>&, int, int, WindowBand<Moments>&,
                          Workers&);
template void gather_band(const AccumulateView&, int, const std::array<int, 3>&, int, int, WindowBand<Extremes>&,
                          Workers&);

}  // namespace varve
