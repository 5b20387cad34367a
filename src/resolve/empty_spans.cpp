#include "resolve/empty_spans.h"

#include <algorithm>
#include <cstring>

namespace varve {
namespace {

constexpr float kNothing[4] = {0, 0, 0, 0};

bool is_empty(const AccumulateView& v, int x, int y) {
  return std::memcmp(v.neighbors.origin + y * v.neighbors.stride + 4 * x, kNothing, sizeof kNothing) == 0 &&
         std::memcmp(v.color.origin + y * v.color.stride + 4 * x, kNothing, sizeof kNothing) == 0 &&
         v.weight.origin[y * v.weight.stride + x] == 1 &&
         std::memcmp(v.motion.origin + y * v.motion.stride + 2 * x, kNothing, 2 * sizeof(float)) == 0;
}

bool blocks_are_empty(const AccumulateView& v, const EmptyBlocks& blocks, int column, int y) {
  // A block is wider than any neighborhood.
  for (int j = std::max(0, y - v.radius); j <= std::min(v.height - 1, y + v.radius); ++j)
    for (int i = std::max(0, column - 1); i <= std::min(blocks.columns - 1, column + 1); ++i)
      if (!blocks.empty[std::size_t(j) * std::size_t(blocks.columns) + std::size_t(i)]) return false;
  return true;
}

/// What the first pixel of a span has met; all others must have met the same.
struct Met {
  float total, spread, sample_weight;
  bool operator==(const Met&) const = default;
};

Met met_at(const AccumulateView& v, int x, int y) {
  const int hx = x + int(v.shift_x), hy = y + int(v.shift_y);
  return {v.history_total.origin[hy * v.history_total.stride + hx],
          v.history_spread.origin[hy * v.history_spread.stride + hx],
          v.sample_weight.origin ? v.sample_weight.origin[y * v.sample_weight.stride + x] : 1.0f};
}

bool history_is_empty(const AccumulateView& v, int begin, int end, int y, const Met& met) {
  const float* color =
      v.history_color.origin + (y + int(v.shift_y)) * v.history_color.stride + 4 * (begin + int(v.shift_x));
  for (int x = begin; x < end; ++x, color += 4)
    if (std::memcmp(color, kNothing, sizeof kNothing) != 0 || !(met_at(v, x, y) == met)) return false;
  return true;
}

template <class T>
void advance(PixelRows<T>& rows, int floats) {
  if (rows.origin) rows.origin += floats;
}

template <class T>
void spread(const PixelRows<T>& rows, int y, const Span& span) {
  if (!rows.origin) return;
  T* row = rows.origin + y * rows.stride;
  std::fill(row + span.begin, row + span.end, row[span.begin]);
}

}  // namespace

EmptyBlocks find_empty_blocks(const AccumulateView& v, Workers& workers) {
  EmptyBlocks blocks;
  blocks.columns = (v.width + kEmptyBlock - 1) / kEmptyBlock;
  blocks.empty.assign(std::size_t(blocks.columns) * std::size_t(v.height), 0);
  workers.for_rows(0, v.height, [&](int y) {
    for (int column = 0; column < blocks.columns; ++column) {
      const int end = std::min(v.width, (column + 1) * kEmptyBlock);
      int x = column * kEmptyBlock;
      while (x < end && is_empty(v, x, y)) ++x;
      blocks.empty[std::size_t(y) * std::size_t(blocks.columns) + std::size_t(column)] = x == end;
    }
  });
  if (std::find(blocks.empty.begin(), blocks.empty.end(), 1) == blocks.empty.end()) blocks.empty.clear();
  return blocks;
}

void find_spans(const AccumulateView& v, const EmptyBlocks& blocks, int y, std::vector<Span>& spans) {
  spans.clear();
  const int hy = y + int(v.shift_y);
  const bool any = !blocks.empty.empty() && hy >= 0 && hy < v.history_height;
  Met met{};  // of the last span, where that is empty
  for (int column = 0; any && column < blocks.columns; ++column) {
    const int begin = column * kEmptyBlock, end = std::min(v.width, begin + kEmptyBlock);
    const bool inside = begin + int(v.shift_x) >= 0 && end + int(v.shift_x) <= v.history_width;
    bool empty = inside && blocks_are_empty(v, blocks, column, y);
    const bool goes_on = empty && !spans.empty() && spans.back().empty && met_at(v, begin, y) == met;
    if (empty && !goes_on) met = met_at(v, begin, y);
    empty = empty && met.total > 0 && history_is_empty(v, begin, end, y, met);
    if (!spans.empty() && spans.back().empty == empty && (!empty || goes_on))
      spans.back().end = end;
    else
      spans.push_back({begin, end, empty});
  }
  if (spans.empty()) spans.push_back({0, v.width, false});
}

AccumulateView view_span(const AccumulateView& view, const Span& span) {
  AccumulateView v = view;
  const int x = span.begin;
  v.width = span.empty ? 1 : span.end - span.begin;
  v.shift_x += x;
  advance(v.color, 4 * x);
  advance(v.neighbors, 4 * x);
  advance(v.weight, x);
  advance(v.motion, 2 * x);
  advance(v.depth, x);
  advance(v.sample_weight, x);
  advance(v.out_color, 4 * x);
  advance(v.out_total, x);
  advance(v.out_spread, x);
  advance(v.out_clip, x);
  advance(v.out_weight, x);
  advance(v.out_reject, x);
  return v;
}

void spread_first(const AccumulateView& v, int y, const Span& span) {
  float* color = v.out_color.origin + y * v.out_color.stride;
  for (int x = span.begin + 1; x < span.end; ++x) std::memcpy(color + 4 * x, color + 4 * span.begin, 4 * sizeof(float));
  spread(v.out_total, y, span);
  spread(v.out_spread, y, span);
  spread(v.out_clip, y, span);
  spread(v.out_weight, y, span);
  spread(v.out_reject, y, span);
}

}  // namespace varve
