// Where a frame is black, covers nothing and rests, as nearly all of a sparse layer does: there one pixel stands for
// all.
#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "resolve/accumulate_row.h"

namespace varve {

inline constexpr int kEmptyBlock = 64;  ///< pixels of a row that are looked at together

/// Blocks of the present without color, without coverage and at rest, every pixel of them valid.
struct EmptyBlocks {
  int columns = 0;
  std::vector<std::uint8_t> empty;  ///< row by row; no rows where there is none
};
EmptyBlocks find_empty_blocks(const AccumulateView& view, Workers& workers);

/// Pixels of a row, relative to the window's corner.
struct Span {
  int begin, end;
  bool empty;  ///< all of it becomes what its first pixel becomes
};

/// The whole row as spans, left to right. A span is empty where its blocks are, with those around, as far as the
/// neighborhood reaches, and where the history holds nothing there either and has seen as much in every pixel.
void find_spans(const AccumulateView& view, const EmptyBlocks& blocks, int y, std::vector<Span>& spans);

/// The view of a span alone.
AccumulateView view_span(const AccumulateView& view, const Span& span);

/// Gives all pixels of an empty span what its first one has become.
void spread_first(const AccumulateView& view, int y, const Span& span);

}  // namespace varve
