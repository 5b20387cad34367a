#include "motion/vector_census.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace varve {
namespace {

constexpr std::size_t kOthers = 32;

bool finite(const Plane<float>& x, const Plane<float>& y, int px, int py) {
  return std::isfinite(x.at(px, py)) && std::isfinite(y.at(px, py));
}

// The ends of one channel in one frame, and how full they are.
std::array<Pile, 2> piles_of(const Plane<float>& of, const Plane<float>& other) {
  const Window& w = of.window();
  std::array<Pile, 2> piles{};
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (finite(of, other, x, y)) {
        least = std::min(least, double(of.at(x, y)));
        greatest = std::max(greatest, double(of.at(x, y)));
      }
  if (!(greatest > least)) return piles;
  const double edge = (greatest - least) / 100;
  std::array<std::set<float>, 2> others;
  piles[0].value = least;
  piles[1].value = greatest;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      if (!finite(of, other, x, y)) continue;
      const double v = double(of.at(x, y));
      for (const std::size_t end : {0u, 1u}) {
        const double off = std::abs(v - piles[end].value);
        if (off == 0) {
          ++piles[end].at;
          if (others[end].size() < kOthers) others[end].insert(other.at(x, y));
        } else if (off <= edge) {
          ++piles[end].beside;
        }
      }
    }
  for (const std::size_t end : {0u, 1u}) piles[end].others = others[end].size();
  return piles;
}

void merge(Pile& into, const Pile& frame, bool further) {
  if (into.at == 0 || further)
    into = frame;
  else if (into.value == frame.value) {
    into.at += frame.at;
    into.beside += frame.beside;
    into.others = std::max(into.others, frame.others);
  }
}

// A partly covered pixel against a covered one beside it that moves.
void judge_alpha(VectorCensus& census, const Plane<float>& x, const Plane<float>& y, const Plane<float>& alpha, int px,
                 int py) {
  const double a = double(alpha.at(px, py));
  if (!(a > 0.1 && a < 0.85)) return;
  constexpr int kAround[][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}};
  for (const auto& [dx, dy] : kAround) {
    const int qx = px + dx, qy = py + dy;
    if (!alpha.window().contains(qx, qy) || !(double(alpha.at(qx, qy)) > 0.999) || !finite(x, y, qx, qy)) continue;
    const double nx = double(x.at(qx, qy)), ny = double(y.at(qx, qy)), length = nx * nx + ny * ny;
    if (!(length > 0)) continue;
    const double share = (double(x.at(px, py)) * nx + double(y.at(px, py)) * ny) / length;
    census.weighed_by_alpha += std::abs(share - a) < 0.1;
    census.not_weighed += std::abs(share - 1) < 0.05;
    return;
  }
}

// Seven pixels in a line: two flat sides, and what lies between.
void judge_edge(VectorCensus& census, const std::array<double, 7>& v, double least_step) {
  const double low = v[1], high = v[5], step = high - low;
  if (!(std::abs(step) > least_step) || !(std::abs(v[0] - low) < 0.1 * std::abs(step)) ||
      !(std::abs(v[6] - high) < 0.1 * std::abs(step)))
    return;
  bool between = false;
  for (const std::size_t i : {2u, 3u, 4u}) {
    const double share = (v[i] - low) / step;
    if (!(share > -0.1 && share < 1.1)) return;  // a third thing
    between = between || (share > 0.15 && share < 0.85);
  }
  ++(between ? census.mixed_edges : census.sharp_edges);
}

void judge_edges(VectorCensus& census, const Plane<float>& plane) {
  const Window& w = plane.window();
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (std::isfinite(plane.at(x, y))) {
        least = std::min(least, double(plane.at(x, y)));
        greatest = std::max(greatest, double(plane.at(x, y)));
      }
  const double step = 0.1 * (greatest - least);
  if (!(step > 0)) return;
  std::array<double, 7> v{};
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      if (x + 7 <= w.x1) {
        for (int i = 0; i < 7; ++i) v[std::size_t(i)] = double(plane.at(x + i, y));
        judge_edge(census, v, step);
      }
      if (y + 7 <= w.y1) {
        for (int i = 0; i < 7; ++i) v[std::size_t(i)] = double(plane.at(x, y + i));
        judge_edge(census, v, step);
      }
    }
}

}  // namespace

bool VectorCensus::constant(int channel) const {
  const std::size_t c = std::size_t(channel);
  return pixels > not_finite && least[c] == greatest[c] && least[c] != 0;
}

bool VectorCensus::clamped(int channel) const {
  const auto full = [&](const Pile& pile) {
    return pile.value != 0 && pile.at >= 24 && double(pile.at) > 0.002 * double(pixels) && pile.others >= 12 &&
           pile.at > 4 * pile.beside;
  };
  const auto& ends = piles[std::size_t(channel)];
  return full(ends[0]) || full(ends[1]);
}

void add_frame(VectorCensus& census, const Plane<float>& x, const Plane<float>& y, const Plane<float>& alpha) {
  const Window& w = x.window();
  ++census.frames;
  const std::array<std::array<Pile, 2>, 2> piles = {piles_of(x, y), piles_of(y, x)};
  for (const std::size_t c : {0u, 1u})
    if (piles[c][0].at > 0) {
      merge(census.piles[c][0], piles[c][0], piles[c][0].value < census.least[c]);
      merge(census.piles[c][1], piles[c][1], piles[c][1].value > census.greatest[c]);
    }
  for (int py = w.y0; py < w.y1; ++py)
    for (int px = w.x0; px < w.x1; ++px) {
      ++census.pixels;
      if (!finite(x, y, px, py)) {
        ++census.not_finite;
        continue;
      }
      const double vx = double(x.at(px, py)), vy = double(y.at(px, py));
      census.zero += vx == 0 && vy == 0;
      census.least = {std::min(census.least[0], vx), std::min(census.least[1], vy)};
      census.greatest = {std::max(census.greatest[0], vx), std::max(census.greatest[1], vy)};
      if (!alpha.empty()) judge_alpha(census, x, y, alpha, px, py);
    }
  judge_edges(census, x);
  judge_edges(census, y);
}

}  // namespace varve
