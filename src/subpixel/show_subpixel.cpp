#include "subpixel/show_subpixel.h"

#include <algorithm>
#include <cmath>

#include "base/held_float.h"
#include "subpixel/reconstruct.h"

namespace varve {
namespace {

/// One quarter of one pixel as it is shown.
struct Shown {
  bool known = false;
  glm::dvec3 moments{0.0};
  Reconstruction from;  ///< without samples where the history is of the present frame
};

Shown show_quarter(const SubpixelHistory& history, const Present& present, const SubpixelParameters& subpixel,
                   const RecursiveParameters& recursive, std::size_t k, int x, int y) {
  Shown s;
  const SubpixelBuffer& q = history.quadrants[k];
  if (!q.empty() && q.way.empty() && q.total.at(x, y) > 0) {
    s.known = true;
    s.moments = glm::dvec3(q.moments.at(x, y));
    return s;
  }
  s.from = reconstruct(history, present, subpixel, recursive, k, x, y);
  if (!s.from.found) return s;
  s.known = true;
  s.moments = weighed_history(history, s.from).moments;
  return s;
}

using Quarters = std::array<Shown, kQuadrants>;

/// The four quarters of one plane and their mean, written to `to` and, where they are wanted, to `shown[k]`. A quarter
/// of which nothing is known has no part in the mean, and is shown as the mean.
template <class PlaneOf>
void show_plane(const SubpixelHistory& history, const Quarters& quarters, int x, int y, const glm::vec4& otherwise,
                glm::vec4& to, const std::array<glm::vec4*, kQuadrants>& shown, PlaneOf plane) {
  std::array<glm::dvec4, kQuadrants> color;
  glm::dvec4 pivot(0.0), sum(0.0);
  int n = 0;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const Shown& q = quarters[k];
    if (!q.known) continue;
    color[k] = q.from.found ? weighed_color(history, q.from, plane) : glm::dvec4(plane(history.quadrants[k]).at(x, y));
    if (n++ == 0) pivot = color[k];
    sum += color[k] - pivot;
  }
  to = n > 0 ? held_color(pivot + sum / double(n)) : otherwise;
  for (std::size_t k = 0; k < kQuadrants; ++k)
    if (shown[k]) *shown[k] = quarters[k].known ? held_color(color[k]) : to;
}

/// What the picture has seen: samples of different histories are different samples, and a history that stands in for
/// the quarters of others is seen once.
struct Seen {
  double total = 0, spread = 0;
};
Seen seen_by(const SubpixelHistory& history, const Quarters& quarters, int known, int x, int y) {
  std::array<double, kQuadrants> share{}, total{}, spread{};  // of the picture, by history
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const Shown& q = quarters[k];
    if (!q.known) continue;
    const auto add = [&](std::size_t from, int tx, int ty, double weight) {
      share[from] += weight;
      total[from] += weight * double(history.quadrants[from].total.at(tx, ty));
      spread[from] += weight * double(history.quadrants[from].spread.at(tx, ty));
    };
    if (!q.from.found) {
      add(k, x, y, 1);
      continue;
    }
    double tents = 0;
    for (int i = 0; i < q.from.samples.count; ++i) tents += q.from.samples.tent[std::size_t(i)];
    for (int i = 0; i < q.from.samples.count; ++i) {
      const auto& texel = q.from.texel[std::size_t(i)];
      add(texel.quadrant, texel.x, texel.y, q.from.samples.tent[std::size_t(i)] / tents);
    }
  }
  Seen seen;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    if (!(share[k] > 0)) continue;
    seen.total += total[k] / std::max(1.0, share[k]);
    seen.spread += share[k] * spread[k] / (double(known) * known);
  }
  return seen;
}

/// Second moment of the picture's kernel around the pixel center, px^2, mean of both axes.
double second_moment(const Quarters& quarters) {
  double sum = 0;
  int n = 0;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    if (!quarters[k].known) continue;
    const glm::dvec2 m = kQuadrantMiddle[k];
    const glm::dvec3& q = quarters[k].moments;
    sum += q.z + m.x * q.x + m.y * q.y + (m.x * m.x + m.y * m.y) / 2;
    ++n;
  }
  return n > 0 ? sum / n : 0;
}

History make_picture(const Present& present) {
  const Window& w = present.color.window();
  History h;
  h.color = Plane<glm::vec4>(w);
  for (std::size_t i = 0; i < present.companions.size(); ++i) h.companions.emplace_back(w);
  h.total = Plane<float>(w);
  h.spread = Plane<float>(w);
  h.rows_valid.assign(std::size_t(w.height()), 1);
  return h;
}

}  // namespace

void show_subpixel(const Present& present, const SubpixelParameters& subpixel, const RecursiveParameters& recursive,
                   const DiagnosticsWanted& wanted, SubpixelStep& step, Workers& workers) {
  const Window& w = present.color.window();
  const SubpixelHistory& history = step.history;
  History& picture = step.resolved.history = make_picture(present);
  AccumulateDiagnostics& diagnostics = step.resolved.diagnostics;
  if (wanted.blur) diagnostics.blur = Plane<float>(w);
  const bool apart = subpixel.scale > 1;
  for (ShownQuarter& q : step.quarters) {
    if (!apart) break;
    q.color = Plane<glm::vec4>(w);
    for (std::size_t i = 0; i < present.companions.size(); ++i) q.companions.emplace_back(w);
  }
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      Quarters quarters;
      int known = 0;
      for (std::size_t k = 0; k < kQuadrants; ++k) {
        quarters[k] = show_quarter(history, present, subpixel, recursive, k, x, y);
        known += quarters[k].known;
      }
      const Seen seen = known > 0 ? seen_by(history, quarters, known, x, y) : Seen();
      std::array<glm::vec4*, kQuadrants> shown{};
      for (std::size_t k = 0; apart && k < kQuadrants; ++k) shown[k] = &step.quarters[k].color.at(x, y);
      show_plane(history, quarters, x, y, present.color.at(x, y), picture.color.at(x, y), shown,
                 [](const SubpixelBuffer& q) -> const Plane<glm::vec4>& { return q.color; });
      for (std::size_t i = 0; i < picture.companions.size(); ++i) {
        for (std::size_t k = 0; apart && k < kQuadrants; ++k) shown[k] = &step.quarters[k].companions[i].at(x, y);
        show_plane(history, quarters, x, y, present.companions[i].at(x, y), picture.companions[i].at(x, y), shown,
                   [i](const SubpixelBuffer& q) -> const Plane<glm::vec4>& { return q.companions[i]; });
      }
      picture.total.at(x, y) = float(std::min(seen.total, 1e6));
      picture.spread.at(x, y) = float(seen.spread);
      if (!(seen.total > 0)) picture.rows_valid[std::size_t(y - w.y0)] = 0;
      if (!diagnostics.weight.empty() && known > 0)
        diagnostics.weight.at(x, y) = 1 - (1 - diagnostics.weight.at(x, y)) / float(known);
      if (wanted.blur) diagnostics.blur.at(x, y) = float(second_moment(quarters));
    }
  });
}

}  // namespace varve
