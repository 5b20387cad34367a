#include "motion/find_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace varve {
namespace {

constexpr int kMargin = 4;          // px around a block that belong to its window
constexpr int kNear = 8;            // px, every whole shift up to here is tried
constexpr int kCoarse = 4;          // px, edge of a pixel of the small picture
constexpr int kCoarseHalf = 4;      // small pixels on each side of a cell that are compared
constexpr double kPerPixel = 0.03;  // of the stored vectors' misfit, for each pixel that a shift is further off
constexpr double kExplained = 0.4;  // of the stored vectors' misfit: below this the search ends

struct Pixel {
  int x, y;
};

/// Means of 4x4 pixels.
Plane<float> small_picture(const Plane<float>& light, Workers& workers) {
  const Window& w = light.window();
  Plane<float> small(Window{0, 0, w.width() / kCoarse, w.height() / kCoarse});
  workers.for_rows(0, small.window().y1, [&](int y) {
    for (int x = 0; x < small.window().x1; ++x) {
      float sum = 0;
      for (int j = 0; j < kCoarse; ++j)
        for (int i = 0; i < kCoarse; ++i) sum += light.row(w.y0 + kCoarse * y + j)[kCoarse * x + i];
      small.row(y)[x] = sum / (kCoarse * kCoarse);
    }
  });
  return small;
}

/// Weights 1 2 1 in both directions: less aliasing for the fractions of a pixel.
Plane<float> softened(const Plane<float>& light, Workers& workers) {
  const Window& w = light.window();
  Plane<float> soft(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const float *up = light.row(std::max(y - 1, w.y0)), *own = light.row(y),
                *down = light.row(std::min(y + 1, w.y1 - 1));
    const auto column = [&](int x) { return up[x] + 2 * own[x] + down[x]; };
    for (int x = 0; x < w.width(); ++x)
      soft.row(y)[x] = (column(std::max(x - 1, 0)) + 2 * column(x) + column(std::min(x + 1, w.width() - 1))) / 16;
  });
  return soft;
}

/// Middle of each object here and there.
struct Middles {
  struct Sum {
    double x = 0, y = 0;
    std::size_t count = 0;
  };
  std::map<std::uint32_t, std::array<Sum, 2>> of;
};

class Search {
 public:
  Search(const SeenPair& pair, const VectorCells& cells, const Plane<std::uint32_t>& labels,
         const Plane<glm::vec2>& camera, int reach, Workers& workers)
      : pair_(pair),
        cells_(cells),
        labels_(labels),
        camera_(camera),
        reach_(reach),
        small_here_(small_picture(pair.light_here(), workers)),
        small_there_(small_picture(pair.light_there(), workers)),
        soft_here_(softened(pair.light_here(), workers)),
        soft_there_(softened(pair.light_there(), workers)) {}

  std::vector<Pixel> pixels_of(const VectorCell& cell) const {
    const Window block = cells_.block(cell.column, cell.row);
    const Window around =
        intersect({block.x0 - kMargin, block.y0 - kMargin, block.x1 + kMargin, block.y1 + kMargin}, cells_.window);
    std::vector<Pixel> pixels;
    for (int y = around.y0; y < around.y1; ++y)
      for (int x = around.x0; x < around.x1; ++x)
        if (labels_.at(x, y) == cell.label && (block.contains(x, y) || ((x + y) & 1) == 0)) pixels.push_back({x, y});
    return pixels;
  }

  /// Mean misfit with one vector for all; worst where less than half can be compared.
  double cost(const std::vector<Pixel>& pixels, glm::dvec2 shift) const {
    const LandsOn step = land(pair_, 0, 0, shift);
    if (!step.known) return double(kWorstMisfit);
    double sum = 0;
    std::size_t count = 0;
    for (const Pixel& p : pixels) {
      const float m = misfit_at(pair_, p.x, p.y, p.x + step.u, p.y + step.v);
      if (m >= 0) sum += double(m), ++count;
    }
    return 2 * count >= pixels.size() && count > 0 ? sum / double(count) : double(kWorstMisfit);
  }

  /// A shift must explain more by `handicap` than what was found before.
  void try_shift(const std::vector<Pixel>& pixels, glm::dvec2 shift, FoundShift& best, double handicap = 0) const {
    const double c = cost(pixels, shift);
    if (c + handicap < best.cost) best.cost = c + handicap, best.shift = shift, best.found = true;
  }

  FoundShift start(const VectorCell& cell, const Middles& middles) const {
    const std::vector<Pixel> pixels = pixels_of(cell);
    FoundShift best;
    const glm::dvec2 centre = cell.usable > 0 ? cell.stored : glm::dvec2(0);
    try_shift(pixels, centre, best);
    const double stored = best.cost;
    // Of what repeats, the nearest copy.
    for (int ring = 1; ring <= kNear; ++ring) try_ring(pixels, centre, ring, best, kPerPixel * stored * ring);
    const auto explained = [&] { return best.cost <= kExplained * stored; };
    if (const auto m = middles.of.find(cell.label); !explained() && m != middles.of.end()) {
      const Middles::Sum &a = m->second[0], &b = m->second[1];
      if (a.count > 0 && b.count > 0 && a.count < 2 * b.count && b.count < 2 * a.count)
        try_around(pixels,
                   {b.x / double(b.count) - a.x / double(a.count), b.y / double(b.count) - a.y / double(a.count)}, 3,
                   best);
    }
    if (!explained())
      for (const glm::dvec2 coarse : coarse_shifts(cell)) try_around(pixels, coarse, 3, best);
    return best;
  }

  void try_ring(const std::vector<Pixel>& pixels, glm::dvec2 centre, int ring, FoundShift& best,
                double handicap = 0) const {
    for (int j = -ring; j <= ring; ++j)
      for (int i = -ring; i <= ring; i += std::abs(j) == ring ? 1 : 2 * ring)
        try_shift(pixels, centre + glm::dvec2(i, j), best, handicap);
  }
  void try_around(const std::vector<Pixel>& pixels, glm::dvec2 centre, int radius, FoundShift& best) const {
    try_shift(pixels, centre, best);
    for (int ring = 1; ring <= radius; ++ring) try_ring(pixels, centre, ring, best);
  }

  /// The best places of a cell in the small picture, as vectors.
  std::vector<glm::dvec2> coarse_shifts(const VectorCell& cell) const {
    const Window& w = cells_.window;
    const int middle_x = (cell.column * kVectorBlock + kVectorBlock / 2) / kCoarse,
              middle_y = (cell.row * kVectorBlock + kVectorBlock / 2) / kCoarse;
    std::vector<Pixel> own;
    for (int y = middle_y - kCoarseHalf; y < middle_y + kCoarseHalf; ++y)
      for (int x = middle_x - kCoarseHalf; x < middle_x + kCoarseHalf; ++x)
        if (small_here_.window().contains(x, y) &&
            labels_.at(w.x0 + kCoarse * x + kCoarse / 2, w.y0 + kCoarse * y + kCoarse / 2) == cell.label)
          own.push_back({x, y});
    struct Place {
      double cost;
      int i, j;
    };
    std::array<Place, 3> best;
    best.fill({1e30, 0, 0});
    const int steps = reach_ / kCoarse;
    // The small pictures begin at the corners of their windows.
    const int corner_x = (pair_.there().x0 - w.x0) / kCoarse, corner_y = (pair_.there().y0 - w.y0) / kCoarse;
    for (int j = -steps; j <= steps; ++j)
      for (int i = -steps; i <= steps; ++i) {
        double sum = 0;
        std::size_t count = 0;
        for (const Pixel& p : own) {
          const int u = p.x + i - corner_x, v = p.y + j - corner_y;
          if (!small_there_.window().contains(u, v)) continue;
          sum += double(std::fabs(small_here_.at(p.x, p.y) - small_there_.at(u, v)));
          ++count;
        }
        if (count == 0 || 2 * count < own.size()) continue;
        Place place{sum / double(count), i, j};
        for (Place& b : best)
          if (place.cost < b.cost) std::swap(place, b);
      }
    std::vector<glm::dvec2> shifts;
    for (const Place& b : best)
      if (b.cost < 1e30) shifts.emplace_back(kCoarse * b.i, kCoarse * b.j);
    return shifts;
  }

  /// What neighbors found may explain this cell as well, and agreeing with them counts: what repeats is told by its
  /// surroundings.
  FoundShift ask_neighbors(std::size_t index, const std::vector<FoundShift>& before) const {
    const VectorCell& cell = cells_.cells[index];
    std::array<glm::dvec2, 10> candidates;
    std::size_t count = 0;
    if (before[index].found) candidates[count++] = before[index].shift;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const VectorCell* neighbor = cells_.find(cell.column + i, cell.row + j, cell.label);
        if (!neighbor || neighbor == &cell) continue;
        if (const FoundShift& theirs = before[cells_.index(*neighbor)]; theirs.found)
          candidates[count++] = theirs.shift;
      }
    const std::size_t neighbors = count;
    if (!camera_.empty()) {
      const Window block = cells_.block(cell.column, cell.row);
      const glm::vec2 v = camera_.at((block.x0 + block.x1) / 2, (block.y0 + block.y1) / 2);
      if (v.x == v.x) candidates[count++] = glm::dvec2(v);
    }
    const std::vector<Pixel> pixels = pixels_of(cell);
    FoundShift best;
    double least = 1e30;
    for (std::size_t k = 0; k < count; ++k) {
      const glm::dvec2 shift = candidates[k];
      double apart = 0;
      for (std::size_t n = 0; n < neighbors; ++n)
        apart += std::min(std::fabs(shift.x - candidates[n].x) + std::fabs(shift.y - candidates[n].y), double(kNear));
      const double c = cost(pixels, shift),
                   score = c + kPerPixel * cell.cost * apart / double(std::max<std::size_t>(1, neighbors));
      if (score < least) least = score, best = {shift, c, 0, 0, 0, true};
    }
    return best;
  }

  /// Fractions of a pixel, and how sure they are.
  void refine(const VectorCell& cell, FoundShift& found) const {
    constexpr int kSteps = 5;
    const std::vector<Pixel> pixels = pixels_of(cell);
    const glm::dvec2 start = found.shift;
    double spread = 0;
    for (int step = 0; step < kSteps; ++step) {
      double xx = 0, xy = 0, yy = 0, bx = 0, by = 0, squares = 0, weights = 0;
      for (const Pixel& p : pixels) {
        const glm::dvec2 at = glm::dvec2(p.x, p.y) + found.shift + pair_.jitter_step();
        const int u = int(std::floor(at.x)), v = int(std::floor(at.y));
        const Window& t = pair_.there();
        if (!(u > t.x0 && v > t.y0 && u + 2 < t.x1 && v + 2 < t.y1)) continue;
        if (pair_.meet(p.x, p.y, int(std::floor(at.x + 0.5)), int(std::floor(at.y + 0.5))) != Meeting::same) continue;
        const double fx = at.x - u, fy = at.y - v;
        const auto read = [&](int i, int j) {
          const float *a = soft_there_.row(v + j) + (u + i - t.x0), *b = soft_there_.row(v + j + 1) + (u + i - t.x0);
          return (1 - fy) * ((1 - fx) * double(a[0]) + fx * double(a[1])) +
                 fy * ((1 - fx) * double(b[0]) + fx * double(b[1]));
        };
        const double off = double(soft_here_.at(p.x, p.y)) - read(0, 0);
        const double gx = (read(1, 0) - read(-1, 0)) / 2, gy = (read(0, 1) - read(0, -1)) / 2;
        const double weight = spread > 0 ? 1 / (1 + off * off / (4 * spread)) : 1;
        xx += weight * gx * gx, xy += weight * gx * gy, yy += weight * gy * gy;
        bx += weight * gx * off, by += weight * gy * off;
        squares += weight * off * off, weights += weight;
      }
      if (!(weights > 0)) return;
      spread = squares / weights + 1e-6;
      const double damp = 1e-3 * (xx + yy) + 1e-9, det = (xx + damp) * (yy + damp) - xy * xy;
      glm::dvec2 move(((yy + damp) * bx - xy * by) / det, ((xx + damp) * by - xy * bx) / det);
      const double length = std::sqrt(move.x * move.x + move.y * move.y);
      if (!(length < 1e6)) return;
      if (length > 0.7) move *= 0.7 / length;
      const glm::dvec2 to = found.shift + move;
      if (std::fabs(to.x - start.x) > 1.5 || std::fabs(to.y - start.y) > 1.5) break;
      found.shift = to;
      found.xx = xx / spread, found.xy = xy / spread, found.yy = yy / spread;
    }
    found.cost = cost(pixels, found.shift);
  }

 private:
  const SeenPair& pair_;
  const VectorCells& cells_;
  const Plane<std::uint32_t>& labels_;
  const Plane<glm::vec2>& camera_;
  int reach_;
  Plane<float> small_here_, small_there_, soft_here_, soft_there_;
};

Middles middles_of(const SeenPair& pair, const VectorCells& cells, const std::vector<char>& asked) {
  Middles middles;
  if (!pair.has_ids()) return middles;
  for (std::size_t i = 0; i < cells.cells.size(); ++i)
    if (asked[i]) middles.of[cells.cells[i].label];
  const auto add = [&](const Plane<std::uint32_t>& ids, std::size_t frame) {
    const Window& w = ids.window();
    auto last = middles.of.end();
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const std::uint32_t id = ids.at(x, y);
        if (last == middles.of.end() || last->first != id) last = middles.of.find(id);
        if (last == middles.of.end()) continue;
        Middles::Sum& sum = last->second[frame];
        sum.x += x, sum.y += y, ++sum.count;
      }
  };
  add(pair.ids_here(), 0);
  add(pair.ids_there(), 1);
  return middles;
}

}  // namespace

std::vector<FoundShift> find_shifts(const SeenPair& pair, const VectorCells& cells, const std::vector<char>& asked,
                                    const Plane<std::uint32_t>& labels, const Plane<glm::vec2>& camera, int reach,
                                    Workers& workers) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (asked[i]) list.push_back(i);
  std::vector<FoundShift> found(cells.cells.size());
  if (list.empty()) return found;
  const Search search(pair, cells, labels, camera, reach, workers);
  const Middles middles = middles_of(pair, cells, asked);
  workers.for_each(list.size(),
                   [&](std::size_t k, int) { found[list[k]] = search.start(cells.cells[list[k]], middles); });
  for (int round = 0; round < 3; ++round) {
    std::vector<FoundShift> next = found;
    workers.for_each(list.size(), [&](std::size_t k, int) { next[list[k]] = search.ask_neighbors(list[k], found); });
    found = std::move(next);
  }
  workers.for_each(list.size(), [&](std::size_t k, int) { search.refine(cells.cells[list[k]], found[list[k]]); });
  return found;
}

}  // namespace varve
