// Sums over a window that come out the same for any number of threads.
#pragma once

#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "base/window.h"

namespace varve {

/// `row(y)` gives the sums of one row; rows run in parallel and are added with += from top to bottom.
template <class Sums, class Row>
Sums sum_rows(const Window& window, Workers& workers, const Row& row) {
  std::vector<Sums> rows(static_cast<std::size_t>(window.height()));
  workers.for_rows(window.y0, window.y1, [&](int y) { rows[std::size_t(y - window.y0)] = row(y); });
  Sums total{};
  for (const Sums& sums : rows) total += sums;
  return total;
}

}  // namespace varve
