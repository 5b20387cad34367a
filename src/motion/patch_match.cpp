#include "motion/patch_match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace varve {
namespace {

constexpr int kEdge = 2 * kPatchRadius + 1;
constexpr int kReach = 8;            // of the search on each level, pixels of that level
constexpr int kKept = 4;             // candidates handed from level to level
constexpr double kLikeEnough = 0.3;  // a match differs less than that
constexpr double kUnique = 0.6;      // and less than this share of the next best
constexpr double kReturns = 1.0;     // pixels that the way back may miss its start by

using Patch = std::array<float, std::size_t(kEdge) * kEdge>;

bool holds_patch(const Plane<float>& plane, int x, int y) {
  const Window& w = plane.window();
  return x - kPatchRadius >= w.x0 && x + kPatchRadius < w.x1 && y - kPatchRadius >= w.y0 && y + kPatchRadius < w.y1;
}

Patch patch_at(const Plane<float>& plane, int x, int y) {
  Patch patch;
  for (int dy = 0; dy < kEdge; ++dy) {
    const float* row = &plane.at(x - kPatchRadius, y - kPatchRadius + dy);
    std::copy(row, row + kEdge, patch.begin() + dy * kEdge);
  }
  return patch;
}

/// Sums of a patch against the one it is looked for.
struct Sums {
  double b = 0, bb = 0, ab = 0;
};

// Single precision inside a patch of 81 tones below 1, double across.
Sums sums_at(const Patch& a, const Plane<float>& plane, int x, int y) {
  std::array<float, kEdge> b{}, bb{}, ab{};
  for (int dy = 0; dy < kEdge; ++dy) {
    const float* row = &plane.at(x - kPatchRadius, y - kPatchRadius + dy);
    const float* other = a.data() + dy * kEdge;
    for (std::size_t i = 0; i < kEdge; ++i) {
      b[i] += row[i];
      bb[i] += row[i] * row[i];
      ab[i] += row[i] * other[i];
    }
  }
  Sums sums;
  for (std::size_t i = 0; i < kEdge; ++i) sums.b += double(b[i]), sums.bb += double(bb[i]), sums.ab += double(ab[i]);
  return sums;
}

/// A patch with the mean and the energy that every comparison needs.
struct Template {
  Patch patch;
  double mean = 0, energy = 0;

  explicit Template(const Patch& p) : patch(p) {
    double sum = 0, squares = 0;
    for (const float v : p) sum += double(v), squares += double(v) * double(v);
    mean = sum / double(p.size());
    energy = std::max(0.0, squares - sum * mean);
  }

  double difference(const Sums& s) const {
    const double n = double(patch.size());
    const double other = std::max(0.0, s.bb - s.b * s.b / n), cov = s.ab - s.b * mean;
    const double both = energy + other;
    return both > 1e-9 ? std::max(0.0, 1 - 2 * cov / both) : 1.0;
  }
};

struct Candidate {
  int dx = 0, dy = 0;
  double difference = std::numeric_limits<double>::infinity();
};

bool is_near(const Candidate& a, const Candidate& b, int distance) {
  return std::abs(a.dx - b.dx) <= distance && std::abs(a.dy - b.dy) <= distance;
}

/// The best few, no two beside each other.
class Shortlist {
 public:
  void offer(const Candidate& c) {
    for (Candidate& kept : kept_)
      if (is_near(kept, c, 2)) {
        if (c.difference < kept.difference) kept = c, sort();
        return;
      }
    if (c.difference < kept_.back().difference) kept_.back() = c, sort();
  }
  const std::array<Candidate, kKept>& best() const { return kept_; }

 private:
  void sort() {
    std::stable_sort(kept_.begin(), kept_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.difference < b.difference; });
  }
  static constexpr Candidate kFar{std::numeric_limits<int>::max() / 4, std::numeric_limits<int>::max() / 4};
  std::array<Candidate, kKept> kept_ = [] {
    std::array<Candidate, kKept> none{};
    for (int i = 0; i < kKept; ++i) none[std::size_t(i)] = {kFar.dx + 8 * i, kFar.dy};
    return none;
  }();
};

void search(const Template& a, int x, int y, const Plane<float>& to, const Candidate& around, int reach,
            Shortlist& list) {
  for (int dy = around.dy - reach; dy <= around.dy + reach; ++dy)
    for (int dx = around.dx - reach; dx <= around.dx + reach; ++dx)
      if (holds_patch(to, x + dx, y + dy)) list.offer({dx, dy, a.difference(sums_at(a.patch, to, x + dx, y + dy))});
}

// From the coarsest level to the finest, each with a search of its own: what is large may move far, what is small is
// seen on the fine levels only.
std::array<Candidate, kKept> search_levels(const TonePyramid& from, const TonePyramid& to, const Place& place) {
  Shortlist list;
  const int levels = int(std::min(from.levels.size(), to.levels.size()));
  for (int level = levels - 1; level >= 0; --level) {
    const Plane<float>& a = from.levels[std::size_t(level)];
    const int x = place.x >> level, y = place.y >> level;  // floor, for negative ones too
    const Shortlist coarser = std::exchange(list, {});
    if (!holds_patch(a, x, y)) continue;
    const Template patch(patch_at(a, x, y));
    const Plane<float>& b = to.levels[std::size_t(level)];
    search(patch, x, y, b, {}, kReach, list);
    for (const Candidate& c : coarser.best())
      if (c.difference < 1) search(patch, x, y, b, {2 * c.dx, 2 * c.dy}, 2, list);
  }
  return list.best();
}

double sample(const Plane<float>& plane, double x, double y) {
  const int ix = int(std::floor(x)), iy = int(std::floor(y));
  const double fx = x - ix, fy = y - iy;
  const double top = double(plane.at(ix, iy)) * (1 - fx) + double(plane.at(ix + 1, iy)) * fx;
  const double low = double(plane.at(ix, iy + 1)) * (1 - fx) + double(plane.at(ix + 1, iy + 1)) * fx;
  return top * (1 - fy) + low * fy;
}

bool holds_between(const Plane<float>& plane, double x, double y) {
  const Window& w = plane.window();
  return x - kPatchRadius >= w.x0 && x + kPatchRadius + 1 < w.x1 && y - kPatchRadius >= w.y0 &&
         y + kPatchRadius + 1 < w.y1;
}

// Gauss-Newton on the difference of the two patches, their means taken out. None where it runs away.
std::optional<glm::dvec2> refine(const Plane<float>& from, const Place& place, const Plane<float>& to,
                                 glm::dvec2 moved) {
  const glm::dvec2 start = moved;
  for (int step = 0; step < 8; ++step) {
    const glm::dvec2 at = glm::dvec2(place.x, place.y) + moved;
    if (!holds_between(to, at.x - 1, at.y - 1) || !holds_between(to, at.x + 1, at.y + 1)) return std::nullopt;
    double sum[6] = {}, gx_sum = 0, gy_sum = 0, e_sum = 0;
    for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy)
      for (int dx = -kPatchRadius; dx <= kPatchRadius; ++dx) {
        const double x = at.x + dx, y = at.y + dy;
        const double gx = (sample(to, x + 0.5, y) - sample(to, x - 0.5, y));
        const double gy = (sample(to, x, y + 0.5) - sample(to, x, y - 0.5));
        const double e = double(from.at(place.x + dx, place.y + dy)) - sample(to, x, y);
        sum[0] += gx * gx, sum[1] += gx * gy, sum[2] += gy * gy, sum[3] += gx * e, sum[4] += gy * e;
        gx_sum += gx, gy_sum += gy, e_sum += e;
      }
    const double n = double(kEdge) * kEdge;
    const double xx = sum[0] - gx_sum * gx_sum / n, xy = sum[1] - gx_sum * gy_sum / n,
                 yy = sum[2] - gy_sum * gy_sum / n, xe = sum[3] - gx_sum * e_sum / n, ye = sum[4] - gy_sum * e_sum / n;
    const double det = xx * yy - xy * xy;
    if (!(det > 1e-6 * xx * yy) || !(xx * yy > 0)) return std::nullopt;
    const glm::dvec2 move((yy * xe - xy * ye) / det, (xx * ye - xy * xe) / det);
    moved += move;
    const glm::dvec2 off = moved - start;
    if (!(off.x * off.x + off.y * off.y < 1.5 * 1.5)) return std::nullopt;
    if (move.x * move.x + move.y * move.y < 1e-4 * 1e-4) break;
  }
  return moved;
}

std::optional<MatchedPlace> match_place(const TonePyramid& from, const TonePyramid& to, const Place& place) {
  if (!holds_patch(from.fine(), place.x, place.y)) return std::nullopt;
  const std::array<Candidate, kKept> found = search_levels(from, to, place);
  const Candidate& best = found[0];
  if (!(best.difference < kLikeEnough) || !(best.difference < kUnique * found[1].difference)) return std::nullopt;
  const Place there{place.x + best.dx, place.y + best.dy};
  Shortlist back;
  search(Template(patch_at(to.fine(), there.x, there.y)), there.x, there.y, from.fine(), {-best.dx, -best.dy}, kReach,
         back);
  if (!is_near(back.best()[0], {-best.dx, -best.dy}, int(kReturns))) return std::nullopt;
  const std::optional<glm::dvec2> moved = refine(from.fine(), place, to.fine(), glm::dvec2(best.dx, best.dy));
  if (!moved) return std::nullopt;
  const std::optional<double> difference = patch_difference(from.fine(), place.x, place.y, to.fine(), *moved);
  if (!difference || !(*difference < kLikeEnough)) return std::nullopt;
  return MatchedPlace{place, *moved, *difference};
}

}  // namespace

std::optional<double> patch_difference(const Plane<float>& from, int x, int y, const Plane<float>& to,
                                       const glm::dvec2& moved) {
  const glm::dvec2 at = glm::dvec2(x, y) + moved;
  if (!holds_patch(from, x, y) || !holds_between(to, at.x, at.y)) return std::nullopt;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy)
    for (int dx = -kPatchRadius; dx <= kPatchRadius; ++dx) {
      const double here = double(from.at(x + dx, y + dy)), there = sample(to, at.x + dx, at.y + dy);
      a += here, b += there, aa += here * here, bb += there * there, ab += here * there;
    }
  const double n = double(kEdge) * kEdge, cov = ab - a * b / n;
  const double both = std::max(0.0, aa - a * a / n) + std::max(0.0, bb - b * b / n);
  return both > 1e-9 ? std::max(0.0, 1 - 2 * cov / both) : 1.0;
}

double texture_at(const Plane<float>& tone, int x, int y) {
  double xx = 0, xy = 0, yy = 0;
  for (int dy = -kPatchRadius + 1; dy < kPatchRadius; ++dy)
    for (int dx = -kPatchRadius + 1; dx < kPatchRadius; ++dx) {
      const double gx = double(tone.at(x + dx + 1, y + dy)) - double(tone.at(x + dx - 1, y + dy));
      const double gy = double(tone.at(x + dx, y + dy + 1)) - double(tone.at(x + dx, y + dy - 1));
      xx += gx * gx, xy += gx * gy, yy += gy * gy;
    }
  const double half = (xx - yy) / 2, n = double(kEdge - 2) * (kEdge - 2);
  return ((xx + yy) / 2 - std::sqrt(half * half + xy * xy)) / (4 * n);
}

std::vector<Place> textured_places(const Plane<float>& tone, int count, Workers& workers) {
  const Window& w = tone.window();
  const int margin = kPatchRadius + 1;
  const Window inner{w.x0 + margin, w.y0 + margin, w.x1 - margin, w.y1 - margin};
  if (inner.empty()) return {};
  const int cell = std::max(5, int(std::sqrt(double(inner.pixels()) / std::max(count, 1))));
  const int columns = (inner.width() + cell - 1) / cell, rows = (inner.height() + cell - 1) / cell;
  const int step = std::max(1, cell / 8);
  std::vector<std::optional<Place>> best(std::size_t(columns) * std::size_t(rows));
  workers.for_each(best.size(), [&](std::size_t i, int) {
    const int x0 = inner.x0 + int(i) % columns * cell, y0 = inner.y0 + int(i) / columns * cell;
    double most = kLeastTexture;
    for (int y = y0; y < std::min(y0 + cell, inner.y1); y += step)
      for (int x = x0; x < std::min(x0 + cell, inner.x1); x += step)
        if (const double here = texture_at(tone, x, y); here > most) most = here, best[i] = Place{x, y};
  });
  std::vector<Place> places;
  for (const std::optional<Place>& place : best)
    if (place) places.push_back(*place);
  return places;
}

std::vector<MatchedPlace> match_places(const TonePyramid& from, const TonePyramid& to, const std::vector<Place>& places,
                                       Workers& workers) {
  std::vector<std::optional<MatchedPlace>> found(places.size());
  workers.for_each(places.size(), [&](std::size_t i, int) { found[i] = match_place(from, to, places[i]); });
  std::vector<MatchedPlace> matched;
  for (const std::optional<MatchedPlace>& place : found)
    if (place) matched.push_back(*place);
  return matched;
}

}  // namespace varve
