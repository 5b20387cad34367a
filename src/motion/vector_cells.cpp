#include "motion/vector_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace varve {
namespace {

constexpr int kMostSurfaces = 4;  // told apart in a block
constexpr int kFewestPixels = 4;  // of a surface in a block that makes a cell
constexpr double kSlightMisfit = 0.004, kShareOfContrast = 0.12;

/// Joins what hangs together; the least pixel of a set names it.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool depths_meet(float a, float b) {
  if (a == b) return true;
  return a < b ? b - a <= 0.05f * a : a - b <= 0.05f * b;
}

bool vectors_meet(glm::vec2 a, glm::vec2 b) {
  const float dx = a.x - b.x, dy = a.y - b.y, length = std::fabs(a.x) + std::fabs(a.y);
  if (!(dx == dx && dy == dy)) return (a.x == a.x) == (b.x == b.x);
  return std::fabs(dx) + std::fabs(dy) <= 0.25f + 0.03f * length;
}

/// One cell, and what it is summed from.
struct Tally {
  VectorCell cell;
  double light = 0, squares = 0;
};

/// The surfaces of one block with the most pixels, by label.
std::vector<VectorCell> cells_of_block(const SeenPair& pair, const Plane<glm::vec2>& vectors,
                                       const Plane<std::uint32_t>& labels, const Window& block) {
  std::vector<Tally> found;
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; ++x) {
      const std::uint32_t label = labels.at(x, y);
      auto tally = std::find_if(found.begin(), found.end(), [&](const Tally& t) { return t.cell.label == label; });
      if (tally == found.end()) {
        found.emplace_back();
        tally = found.end() - 1;
        tally->cell.label = label;
      }
      VectorCell& cell = tally->cell;
      const double light = double(pair.light(x, y));
      ++cell.pixels;
      tally->light += light, tally->squares += light * light;
      const glm::vec2 v = vectors.at(x, y);
      if (!(v.x == v.x)) continue;
      ++cell.usable, cell.stored += glm::dvec2(v);
      const float m = misfit(pair, x, y, glm::dvec2(v));
      if (m >= 0) ++cell.tested, cell.cost += double(m);
    }
  std::erase_if(found, [](const Tally& t) { return t.cell.pixels < kFewestPixels; });
  std::stable_sort(found.begin(), found.end(),
                   [](const Tally& a, const Tally& b) { return a.cell.pixels > b.cell.pixels; });
  if (found.size() > kMostSurfaces) found.resize(kMostSurfaces);
  std::vector<VectorCell> cells;
  for (Tally& t : found) {
    const double n = t.cell.pixels, mean = t.light / n;
    t.cell.contrast = std::sqrt(std::max(0.0, t.squares / n - mean * mean));
    if (t.cell.tested > 0) t.cell.cost /= t.cell.tested;
    if (t.cell.usable > 0) t.cell.stored /= double(t.cell.usable);
    cells.push_back(t.cell);
  }
  return cells;
}

/// A cell says something of its vectors where enough of its pixels could be compared.
bool is_tested(const VectorCell& cell) { return 2 * cell.tested >= cell.pixels && cell.tested >= kFewestPixels; }

void mark_suspicious(VectorCells& cells, double limit) {
  std::vector<double> costs;
  for (const VectorCell& cell : cells.cells)
    if (is_tested(cell)) costs.push_back(cell.cost);
  if (costs.empty()) return;
  // Of the better half the middle: what misfit right vectors have here, even where half of the picture is wrong.
  const auto quarter = costs.begin() + std::ptrdiff_t(costs.size() / 4);
  std::nth_element(costs.begin(), quarter, costs.end());
  for (VectorCell& cell : cells.cells)
    cell.suspicious =
        is_tested(cell) && cell.cost > std::max({kSlightMisfit, limit * *quarter, kShareOfContrast * cell.contrast});
}

}  // namespace

const VectorCell* VectorCells::find(int column, int row, std::uint32_t label) const {
  if (column < 0 || row < 0 || column >= columns || row >= rows) return nullptr;
  const std::size_t block = std::size_t(row) * std::size_t(columns) + std::size_t(column);
  for (std::size_t i = first[block]; i < first[block + 1]; ++i)
    if (cells[i].label == label) return &cells[i];
  return nullptr;
}

Window VectorCells::block(int column, int row) const {
  const int x = window.x0 + column * kVectorBlock, y = window.y0 + row * kVectorBlock;
  return {x, y, std::min(x + kVectorBlock, window.x1), std::min(y + kVectorBlock, window.y1)};
}

Plane<std::uint32_t> label_surfaces(const SeenPair& pair, const Plane<glm::vec2>& vectors, Workers& workers) {
  const Window& w = pair.here();
  Plane<std::uint32_t> labels(w);
  if (pair.has_ids()) {
    workers.for_rows(w.y0, w.y1, [&](int y) {
      for (int x = w.x0; x < w.x1; ++x) labels.at(x, y) = pair.id(x, y);
    });
    return labels;
  }
  Sets sets(w.pixels());
  const auto place = [&](int x, int y) {
    return std::uint32_t(std::size_t(y - w.y0) * std::size_t(w.width()) + std::size_t(x - w.x0));
  };
  const auto meet = [&](int x, int y, int u, int v) {
    return (!pair.has_depths() || depths_meet(pair.depth(x, y), pair.depth(u, v))) &&
           vectors_meet(vectors.at(x, y), vectors.at(u, v));
  };
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      if (x > w.x0 && meet(x, y, x - 1, y)) sets.join(place(x, y), place(x - 1, y));
      if (y > w.y0 && meet(x, y, x, y - 1)) sets.join(place(x, y), place(x, y - 1));
    }
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) labels.at(x, y) = sets.find(place(x, y));
  return labels;
}

VectorCells measure_cells(const SeenPair& pair, const Plane<glm::vec2>& vectors, const Plane<std::uint32_t>& labels,
                          double limit, Workers& workers) {
  VectorCells cells;
  cells.window = pair.here();
  cells.columns = (cells.window.width() + kVectorBlock - 1) / kVectorBlock;
  cells.rows = (cells.window.height() + kVectorBlock - 1) / kVectorBlock;
  std::vector<std::vector<VectorCell>> blocks(std::size_t(cells.columns) * std::size_t(cells.rows));
  workers.for_rows(0, cells.rows, [&](int row) {
    for (int column = 0; column < cells.columns; ++column) {
      std::vector<VectorCell>& here = blocks[std::size_t(row) * std::size_t(cells.columns) + std::size_t(column)];
      here = cells_of_block(pair, vectors, labels, cells.block(column, row));
      for (VectorCell& cell : here) cell.column = column, cell.row = row;
    }
  });
  cells.first.push_back(0);
  for (const std::vector<VectorCell>& block : blocks) {
    cells.cells.insert(cells.cells.end(), block.begin(), block.end());
    cells.first.push_back(cells.cells.size());
  }
  mark_suspicious(cells, limit);
  return cells;
}

}  // namespace varve
