#include "diagnose/sub_pixel_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace varve {
namespace {

constexpr int kTile = 16;                   // pixels on the edge of a tile
constexpr double kAgrees = 2;               // a tile that is this many times as far off as the usual one counts half
constexpr float kSameSurface = 0.1f;        // px: vectors of neighbors that differ by more are two surfaces
constexpr float kStill = 1.0f / 64;         // px
constexpr float kStructure = 0.01f;         // tone: less around a pixel is flat
constexpr double kFurthest = 1.5;           // px: two samples of one pixel lie less than 1 apart
constexpr std::size_t kEnough = 2'000'000;  // pixels; of larger pictures only every n-th row is taken
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The equation and its derivative, for one tile or the whole picture.
struct Equation {
  glm::dvec2 sum{0}, by_x{0}, by_y{0};
  double energy = 0;  // squares of the gradient
  void add(const Equation& e, double weight = 1) {
    sum += weight * e.sum, by_x += weight * e.by_x, by_y += weight * e.by_y, energy += weight * e.energy;
  }
};

/// Weights of Catmull and Rom for a place between the second and the third of four values, and their slopes.
struct CubicAxis {
  double weight[4], slope[4];
  explicit CubicAxis(double t) {
    const double t2 = t * t, t3 = t2 * t;
    weight[0] = (-t3 + 2 * t2 - t) / 2, weight[1] = (3 * t3 - 5 * t2 + 2) / 2;
    weight[2] = (-3 * t3 + 4 * t2 + t) / 2, weight[3] = (t3 - t2) / 2;
    slope[0] = (-3 * t2 + 4 * t - 1) / 2, slope[1] = (9 * t2 - 10 * t) / 2;
    slope[2] = (-9 * t2 + 8 * t + 1) / 2, slope[3] = (3 * t2 - 2 * t) / 2;
  }
};

struct Solver {
  const Plane<float>& now;
  const Plane<float>& before;
  const Plane<glm::vec2>& motion;
  Workers& workers;
  int row_step = 1;

  // NaN where a pixel takes no part.
  glm::vec2 motion_at(int x, int y) const {
    if (motion.empty()) return glm::vec2(0);
    const Window& w = motion.window();
    const glm::vec2 m = motion.at(x, y);
    for (int v = std::max(w.y0, y - 1); v < std::min(w.y1, y + 2); ++v)
      for (int u = std::max(w.x0, x - 1); u < std::min(w.x1, x + 2); ++u) {
        const glm::vec2 d = motion.at(u, v) - m;
        if (!(std::abs(d.x) < kSameSurface && std::abs(d.y) < kSameSurface)) return glm::vec2(kNaN);
      }
    return m;
  }

  /// Adds pixel (x, y) at a shift.
  bool add(int x, int y, glm::dvec2 shift, Equation& e) const {
    const Window& w = before.window();
    const glm::vec2 m = motion_at(x, y);
    const double ux = x + double(m.x) + shift.x, uy = y + double(m.y) + shift.y;
    if (!(ux >= w.x0 + 2.0 && uy >= w.y0 + 2.0 && ux < w.x1 - 3.0 && uy < w.y1 - 3.0)) return false;
    const int bx = int(std::floor(ux)), by = int(std::floor(uy));
    const double value = double(now.at(x, y));
    const CubicAxis across(ux - bx), down(uy - by);
    Equation one;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const int qx = bx - 1 + i, qy = by - 1 + j;
        const float* row = before.row(qy) + (qx - w.x0);
        const double gx = double(row[1] - row[-1]) / 2, gy = double(before.at(qx, qy + 1) - before.at(qx, qy - 1)) / 2;
        const glm::dvec2 d = glm::dvec2(gx, gy) * (value - double(row[0]));
        one.add({d * (across.weight[i] * down.weight[j]), d * (across.slope[i] * down.weight[j]),
                 d * (across.weight[i] * down.slope[j]), across.weight[i] * down.weight[j] * (gx * gx + gy * gy)});
      }
    if (!(std::isfinite(one.sum.x) && std::isfinite(one.sum.y))) return false;
    e.add(one);
    return true;
  }

  std::vector<Equation> tiles(glm::dvec2 shift, std::size_t& pixels) const {
    const Window w = now.window();
    const int across = (w.width() + kTile - 1) / kTile, down = (w.height() + kTile - 1) / kTile;
    std::vector<Equation> all(std::size_t(across) * std::size_t(down));
    std::vector<std::size_t> counts(std::size_t(std::max(down, 0)));
    workers.for_rows(0, down, [&](int band) {
      for (int y = w.y0 + band * kTile; y < std::min(w.y1, w.y0 + (band + 1) * kTile); ++y) {
        if ((y - w.y0) % row_step != 0) continue;
        for (int x = w.x0; x < w.x1; ++x)
          counts[std::size_t(band)] += add(x, y, shift, all[std::size_t(band * across + (x - w.x0) / kTile)]);
      }
    });
    pixels = 0;
    for (const std::size_t n : counts) pixels += n;
    return all;
  }
};

/// How far a tile is from solving the equation, in tone: what its pixels differ by along the gradient.
double distance_of(const Equation& tile) {
  return tile.energy > 0 ? glm::length(tile.sum) / std::sqrt(tile.energy) : 0;
}

/// Shadows move otherwise than the surfaces they fall on, and so do mirrored things. Tiles that are much further off
/// than most of the structure weigh less (Cauchy's weights).
std::vector<double> weights_of(const std::vector<Equation>& tiles) {
  std::vector<std::pair<double, double>> distances;  // and the structure there
  double structure = 0;
  for (const Equation& tile : tiles) {
    if (!(tile.energy > 0)) continue;
    distances.emplace_back(distance_of(tile), tile.energy);
    structure += tile.energy;
  }
  std::sort(distances.begin(), distances.end());
  double usual = 0, below = 0;
  for (std::size_t i = 0; i < distances.size() && !(below >= structure / 2); ++i)
    usual = distances[i].first, below += distances[i].second;
  std::vector<double> weights;
  for (const Equation& tile : tiles) {
    const double ratio = distance_of(tile) / (kAgrees * usual);
    weights.push_back(ratio > 0 ? 1 / (1 + ratio * ratio) : 1);
  }
  return weights;
}

Equation sum_of(const std::vector<Equation>& tiles, const std::vector<double>& weights) {
  Equation e;
  for (std::size_t i = 0; i < tiles.size(); ++i) e.add(tiles[i], weights[i]);
  return e;
}

/// The step that solves the linear equation; false where it falls no way down.
bool newton_step(const Equation& e, glm::dvec2& step) {
  const double det = e.by_x.x * e.by_y.y - e.by_y.x * e.by_x.y, size = e.by_x.x + e.by_y.y;
  // At the true shift the derivative is minus the mean square of the gradient.
  if (!(size < 0 && det > 1e-9 * size * size)) return false;
  step = glm::dvec2(e.sum.x * e.by_y.y - e.sum.y * e.by_y.x, e.sum.y * e.by_x.x - e.sum.x * e.by_x.y) / -det;
  return true;
}

/// Standard error: the tiles disagree by chance.
glm::dvec2 error_of(const std::vector<Equation>& tiles, const std::vector<double>& weights) {
  const Equation all = sum_of(tiles, weights);
  glm::dvec2 squares(0);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    Equation e = all;
    e.sum = weights[i] * tiles[i].sum;
    glm::dvec2 step;
    if (!newton_step(e, step)) return glm::dvec2(1e9);
    squares += step * step;
  }
  return {std::sqrt(squares.x), std::sqrt(squares.y)};
}

/// What can be seen without a solution: pixels with structure, at rest, and bit for bit the same.
void survey(const Solver& s, SubPixelShift& result) {
  const Window w = intersect(s.now.window(), s.before.window());
  std::vector<std::array<std::size_t, 4>> rows(std::size_t(w.height()));
  s.workers.for_rows(w.y0, w.y1, [&](int y) {
    auto& [all, still, textured, identical] = rows[std::size_t(y - w.y0)];
    for (int x = w.x0; x < w.x1; ++x) {
      ++all;
      const glm::vec2 m = s.motion.empty() ? glm::vec2(0) : s.motion.at(x, y);
      if (!(std::abs(m.x) < kStill && std::abs(m.y) < kStill)) continue;
      ++still;
      if (x <= w.x0 || y <= w.y0 || x + 1 >= w.x1 || y + 1 >= w.y1) continue;
      const float center = s.now.at(x, y);
      const float around = std::max(std::abs(s.now.at(x + 1, y) - s.now.at(x - 1, y)),
                                    std::abs(s.now.at(x, y + 1) - s.now.at(x, y - 1)));
      if (!(around > kStructure)) continue;
      ++textured;
      identical += center == s.before.at(x, y);
    }
  });
  std::array<std::size_t, 4> sum{};
  for (const auto& row : rows)
    for (std::size_t k = 0; k < 4; ++k) sum[k] += row[k];
  if (sum[0] > 0) result.still = double(sum[1]) / double(sum[0]), result.textured = double(sum[2]) / double(sum[0]);
  if (sum[2] > 0) result.identical = double(sum[3]) / double(sum[2]);
}

/// Binomial weights 1 2 1 in both directions: less of the noise, and of what is too fine for the pixels. NaN beside NaN
/// and on the rim.
Plane<float> smooth(const Plane<float>& in, Workers& workers) {
  const Window& w = in.window();
  Plane<float> out(w, 0, kNaN);
  if (w.width() < 3) return out;
  workers.for_rows(w.y0 + 1, w.y1 - 1, [&](int y) {
    const float *above = in.row(y - 1), *row = in.row(y), *below = in.row(y + 1);
    const auto column = [&](int x) { return above[x] * 0.25f + row[x] * 0.5f + below[x] * 0.25f; };
    for (int x = 1; x + 1 < w.width(); ++x)
      out.row(y)[x] = column(x - 1) * 0.25f + column(x) * 0.5f + column(x + 1) * 0.25f;
  });
  return out;
}

}  // namespace

Plane<float> tone_plane(const Plane<glm::vec4>& color, const Plane<float>& valid, double middle, Workers& workers) {
  const Window& w = color.window();
  Plane<float> tone(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::dvec4 c(color.at(x, y));
      const double luma = std::max(0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b, 0.0);
      tone.at(x, y) = !(valid.at(x, y) > 0) ? kNaN : middle > 0 ? float(luma / (luma + middle)) : 0.0f;
    }
  });
  return tone;
}

double middle_luma(const Plane<glm::vec4>& color, const Plane<float>& valid) {
  const Window& w = color.window();
  std::vector<double> lumas;
  for (int y = w.y0; y < w.y1; y += 4)
    for (int x = w.x0; x < w.x1; x += 4) {
      const glm::dvec4 c(color.at(x, y));
      const double luma = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
      if (valid.at(x, y) > 0 && luma > 0 && std::isfinite(luma)) lumas.push_back(luma);
    }
  if (lumas.empty()) return 0;
  const auto half = lumas.begin() + std::ptrdiff_t(lumas.size() / 2);
  std::nth_element(lumas.begin(), half, lumas.end());
  return *half;
}

SubPixelShift measure_shift(const Plane<float>& now, const Plane<float>& before, const Plane<glm::vec2>& motion,
                            Workers& workers) {
  SubPixelShift result;
  if (now.empty() || before.empty()) return result;
  survey({now, before, motion, workers}, result);
  const Plane<float> smooth_now = smooth(now, workers), smooth_before = smooth(before, workers);
  Solver solver{smooth_now, smooth_before, motion, workers};
  solver.row_step = int(1 + now.window().pixels() / kEnough);
  std::vector<Equation> tiles = solver.tiles(result.shift, result.pixels);
  std::vector<double> weights = weights_of(tiles);
  for (int i = 0; i < 20; ++i) {
    glm::dvec2 step;
    if (!newton_step(sum_of(tiles, weights), step)) return result;
    const double length = std::max(std::abs(step.x), std::abs(step.y));
    if (length > 0.5) step *= 0.5 / length;
    result.shift += step;
    if (!(std::max(std::abs(result.shift.x), std::abs(result.shift.y)) <= kFurthest)) return result;
    tiles = solver.tiles(result.shift, result.pixels);
    weights = weights_of(tiles);
    if (length < 1e-4) break;
  }
  result.sigma = error_of(tiles, weights);
  result.found = std::isfinite(result.sigma.x) && std::isfinite(result.sigma.y) && result.sigma.x < 1e8;
  return result;
}

}  // namespace varve
