#include "motion/fit_shifts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/median.h"

namespace varve {
namespace {

constexpr int kReach = 3;  // blocks
constexpr int kRounds = 4;
constexpr double kOutlier = 0.5;      // px at which a cell counts half
constexpr double kWholeMisfit = 0.2;  // px, mean distance from a model of the whole surface that is none

/// Normal equations of an affine motion, 6 unknowns: shift x, y, per_x x, y, per_y x, y; positions in blocks.
struct Equations {
  std::array<double, 36> a{};
  std::array<double, 6> b{};

  void add(double x, double y, double weight, const FoundShift& f) {
    const std::array<double, 3> basis = {1, x, y};
    const std::array<double, 4> h = {f.xx + 0.5, f.xy, f.xy, f.yy + 0.5};
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t row = 2 * p + i;
        for (std::size_t q = 0; q < 3; ++q)
          for (std::size_t j = 0; j < 2; ++j) a[6 * row + 2 * q + j] += weight * basis[p] * basis[q] * h[2 * i + j];
        b[row] += weight * basis[p] * (h[2 * i] * f.shift.x + h[2 * i + 1] * f.shift.y);
      }
  }

  /// Gaussian elimination of a symmetric system that the damping keeps positive; false where it is not.
  bool solve(std::array<double, 6>& x) {
    const double mean = (a[0] + a[7]) / 2;
    for (std::size_t i = 0; i < 6; ++i) a[7 * i] += (i < 2 ? 1e-6 : 0.05) * mean;  // rather flat than wild
    for (std::size_t k = 0; k < 6; ++k) {
      if (!(a[7 * k] > 0)) return false;
      for (std::size_t i = k + 1; i < 6; ++i) {
        const double f = a[6 * i + k] / a[7 * k];
        for (std::size_t j = k; j < 6; ++j) a[6 * i + j] -= f * a[6 * k + j];
        b[i] -= f * b[k];
      }
    }
    for (std::size_t k = 6; k-- > 0;) {
      double sum = b[k];
      for (std::size_t j = k + 1; j < 6; ++j) sum -= a[6 * k + j] * x[j];
      x[k] = sum / a[7 * k];
    }
    return std::all_of(x.begin(), x.end(), [](double v) { return v > -1e9 && v < 1e9; });
  }
};

/// A cell that takes part in a fit.
struct Witness {
  const VectorCell* cell;
  const FoundShift* found;
  double weight;  // by distance and size
};

double distance(glm::dvec2 a, glm::dvec2 b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

glm::dvec2 middle_of(const VectorCells& cells, const VectorCell& cell) {
  const Window block = cells.block(cell.column, cell.row);
  return {(block.x0 + block.x1 - 1) / 2.0, (block.y0 + block.y1 - 1) / 2.0};
}

ShiftModel fit(const VectorCells& cells, const VectorCell& centre, const std::vector<Witness>& witnesses) {
  ShiftModel model;
  model.middle = middle_of(cells, centre);
  if (witnesses.empty()) return model;
  std::vector<double> xs, ys;
  for (const Witness& w : witnesses) xs.push_back(w.found->shift.x), ys.push_back(w.found->shift.y);
  model.shift = {upper_median(std::move(xs)), upper_median(std::move(ys))};
  model.known = true;
  double outlier = 3;  // wide at first: a surface that turns is far from its median
  for (int round = 0; round < kRounds; ++round, outlier = std::max(kOutlier, outlier / 2)) {
    Equations equations;
    for (const Witness& w : witnesses) {
      const glm::dvec2 at = middle_of(cells, *w.cell);
      const glm::dvec2 said =
          model.shift + (at.x - model.middle.x) * model.per_x + (at.y - model.middle.y) * model.per_y;
      const double off = distance(said, w.found->shift) / outlier;
      equations.add((at.x - model.middle.x) / kVectorBlock, (at.y - model.middle.y) / kVectorBlock,
                    w.weight / (1 + off * off * off * off), *w.found);
    }
    std::array<double, 6> x{};
    if (!equations.solve(x)) break;
    model.shift = {x[0], x[1]};
    model.per_x = glm::dvec2(x[2], x[3]) / double(kVectorBlock);
    model.per_y = glm::dvec2(x[4], x[5]) / double(kVectorBlock);
  }
  return model;
}

std::vector<Witness> around(const VectorCells& cells, const std::vector<FoundShift>& found, const VectorCell& cell) {
  std::vector<Witness> witnesses;
  for (int j = -kReach; j <= kReach; ++j)
    for (int i = -kReach; i <= kReach; ++i) {
      const VectorCell* other = cells.find(cell.column + i, cell.row + j, cell.label);
      if (!other) continue;
      const FoundShift& f = found[cells.index(*other)];
      if (f.found) witnesses.push_back({other, &f, other->pixels * std::exp(-(i * i + j * j) / 4.5)});
    }
  return witnesses;
}

/// Mean distance, over the sharper half of the cells, from what a model says.
double misfit_of(const ShiftModel& model, const VectorCells& cells, const std::vector<Witness>& witnesses) {
  std::vector<double> offs;
  for (const Witness& w : witnesses) {
    const glm::dvec2 at = middle_of(cells, *w.cell);
    offs.push_back(distance(model.shift + (at.x - model.middle.x) * model.per_x + (at.y - model.middle.y) * model.per_y,
                            w.found->shift));
  }
  return upper_median(std::move(offs));
}

}  // namespace

std::vector<ShiftModel> fit_shifts(const VectorCells& cells, const std::vector<FoundShift>& found, Workers& workers) {
  std::vector<ShiftModel> models(cells.cells.size());
  std::map<std::uint32_t, std::vector<std::size_t>> surfaces;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i].found) surfaces[cells.cells[i].label].push_back(i);
  for (const auto& surface : surfaces) {
    const std::vector<std::size_t>& members = surface.second;
    std::vector<Witness> all;
    for (const std::size_t i : members) all.push_back({&cells.cells[i], &found[i], double(cells.cells[i].pixels)});
    const ShiftModel whole = fit(cells, cells.cells[members[members.size() / 2]], all);
    if (misfit_of(whole, cells, all) <= kWholeMisfit) {
      for (const std::size_t i : members) models[i] = whole;
      continue;
    }
    workers.for_each(members.size(), [&](std::size_t k, int) {
      const VectorCell& cell = cells.cells[members[k]];
      models[members[k]] = fit(cells, cell, around(cells, found, cell));
    });
  }
  return models;
}

}  // namespace varve
