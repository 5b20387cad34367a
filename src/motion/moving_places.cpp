#include "motion/moving_places.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include <glm/vec2.hpp>

#include "base/median.h"

namespace varve {
namespace {

constexpr double kLooked = 40000;  // pixels of a picture that are looked at, about
constexpr int kOctaves = 8;        // shorter than 1/256 of the longest is noise of half floats
constexpr double kEven = 0.1;      // of the longest difference, over a patch
constexpr double kEvenOwn = 0.3;   // of its own, so that slow things end where they do

using Stored = std::optional<glm::dvec2>;

struct Vectors {
  const Plane<float>& x;
  const Plane<float>& y;
  Stored at(int px, int py) const {
    if (!x.window().contains(px, py) || !y.window().contains(px, py)) return std::nullopt;
    const glm::dvec2 v(double(x.at(px, py)), double(y.at(px, py)));
    // Longer ones are no motion, and their squares would overflow.
    if (!(std::abs(v.x) < 1e30 && std::abs(v.y) < 1e30)) return std::nullopt;
    return v;
  }
};

double length(const glm::dvec2& v) { return std::hypot(v.x, v.y); }

/// What most of the picture holds, and how far the rest is from it: all but the last thousandth, unless nothing else
/// differs.
struct Common {
  glm::dvec2 middle{0};
  double longest = 0;
};

std::optional<Common> common_of(const Vectors& vectors, int step) {
  const Window& w = vectors.x.window();
  std::vector<double> xs, ys, far;
  std::vector<glm::dvec2> all;
  for (int y = w.y0; y < w.y1; y += step)
    for (int x = w.x0; x < w.x1; x += step)
      if (const Stored v = vectors.at(x, y)) xs.push_back(v->x), ys.push_back(v->y), all.push_back(*v);
  if (all.empty()) return std::nullopt;
  Common common{{upper_median(std::move(xs)), upper_median(std::move(ys))}, 0};
  for (const glm::dvec2& v : all) far.push_back(length(v - common.middle));
  std::sort(far.begin(), far.end());
  common.longest = far[far.size() - 1 - far.size() / 1000];
  if (!(common.longest > 0)) common.longest = far.back();
  if (!(common.longest > 0)) return std::nullopt;
  return common;
}

bool even_around(const Vectors& vectors, const glm::dvec2& middle, int x, int y, int radius, double most) {
  for (const int dy : {-radius, 0, radius})
    for (const int dx : {-radius, 0, radius}) {
      const Stored v = vectors.at(x + dx, y + dy);
      if (!v || !(length(*v - middle) <= most)) return false;
    }
  return true;
}

struct Candidate {
  Place place;
  double texture = 0;
};

bool is_taken(const std::vector<Place>& taken, int x, int y) {
  return std::any_of(taken.begin(), taken.end(), [&](const Place& other) {
    return std::abs(other.x - x) < kPatchRadius && std::abs(other.y - y) < kPatchRadius;
  });
}

}  // namespace

std::vector<Place> moving_places(const Plane<float>& tone, int pixel, const Plane<float>& x, const Plane<float>& y,
                                 int count, const std::vector<Place>& taken, Workers& workers) {
  const Window& w = tone.window();
  const int margin = kPatchRadius + 1;
  const Window inner{w.x0 + margin, w.y0 + margin, w.x1 - margin, w.y1 - margin};
  const Vectors vectors{x, y};
  if (inner.empty() || x.window().empty() || y.window().empty()) return {};
  const std::optional<Common> common =
      common_of(vectors, std::max(1, int(std::sqrt(double(x.window().pixels()) / kLooked))));
  if (!common) return {};

  const int step = std::max(kPatchRadius, int(std::sqrt(double(inner.pixels()) / kLooked)));
  const int rows = (inner.height() + step - 1) / step;
  // By direction (eight) and by octave of the length.
  std::vector<std::vector<std::pair<int, Candidate>>> found;
  found.resize(std::size_t(rows));
  workers.for_each(found.size(), [&](std::size_t row, int) {
    const int py = inner.y0 + int(row) * step;
    for (int px = inner.x0; px < inner.x1; px += step) {
      const int vx = px * pixel + pixel / 2, vy = py * pixel + pixel / 2;
      const Stored v = vectors.at(vx, vy);
      if (!v) continue;
      const glm::dvec2 apart = *v - common->middle;
      const double octaves = std::log2(common->longest / length(apart));  // infinite for what is common
      if (!(octaves < kOctaves) || is_taken(taken, px, py)) continue;
      if (!even_around(vectors, *v, vx, vy, kPatchRadius * pixel,
                       std::min(kEven * common->longest, kEvenOwn * length(apart))))
        continue;
      const double texture = texture_at(tone, px, py);
      if (!(texture > kLeastTexture)) continue;
      const int octave = std::clamp(int(octaves), 0, kOctaves - 1);
      const int direction =
          (apart.x < 0 ? 1 : 0) + (apart.y < 0 ? 2 : 0) + (std::abs(apart.x) < std::abs(apart.y) ? 4 : 0);
      found[row].push_back({8 * octave + direction, {{px, py}, texture}});
    }
  });
  std::map<int, std::vector<Candidate>> kinds;
  for (const auto& row : found)
    for (const auto& [kind, candidate] : row) kinds[kind].push_back(candidate);

  std::vector<Place> places;
  const std::size_t quota =
      std::max<std::size_t>(4, std::size_t(std::max(count, 0)) / std::max<std::size_t>(kinds.size(), 1));
  for (const auto& [kind, candidates] : kinds) {
    const std::size_t n = std::min(quota, candidates.size());
    // The most textured one of each run, so that they are spread over the picture.
    for (std::size_t i = 0; i < n; ++i)
      places.push_back(std::max_element(candidates.begin() + std::ptrdiff_t(i * candidates.size() / n),
                                        candidates.begin() + std::ptrdiff_t((i + 1) * candidates.size() / n),
                                        [](const Candidate& a, const Candidate& b) { return a.texture < b.texture; })
                           ->place);
  }
  return places;
}

}  // namespace varve
