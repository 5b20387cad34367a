#include "gather/shading_gain.h"

#include <algorithm>
#include <cmath>

namespace varve {
namespace {

constexpr int kFewestPixels = 9;
constexpr double kSuddenErrors = 6;      // standard errors
constexpr double kSuddenShare = 0.05;    // of the light
constexpr double kHighlight = 1.35;      // ratio that noise of a first picture does not reach
constexpr double kHighlightWidth = 0.1;  // beyond it, as a logarithm, where a sample counts half
constexpr double kMostGain = 1e6;        // light out of nothing: no float overflows by it

/// Sum of luminance and number of pixels.
struct LightSum {
  double sum = 0, squares = 0;
  int count = 0;
  void add(const LightSum& more) { sum += more.sum, squares += more.squares, count += more.count; }
};

bool is_pure(const Present& p, int x, int y, const SurfaceTest& test) {
  const Window& w = p.color.window();
  const SurfaceKey key = surface_at(p, x, y);
  for (int j = std::max(y - 1, w.y0); j <= std::min(y + 1, w.y1 - 1); ++j)
    for (int i = std::max(x - 1, w.x0); i <= std::min(x + 1, w.x1 - 1); ++i)
      if (!(p.valid.at(i, j) > 0) || !test.same(surface_at(p, i, j), key)) return false;
  return true;
}

/// Sums of `value` over windows of the same surface: along rows, then of those along columns. Only pixels whose 3x3
/// neighbors are of one surface take part.
template <class Value>
Plane<LightSum> sum_windows(const Present& present, const SurfaceTest& test, int edge, const Value& value,
                            Workers& workers) {
  const Window& w = present.color.window();
  const int r = edge / 2;
  Plane<float> own(w);  // NaN where a pixel does not take part
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x)
      own.at(x, y) = is_pure(present, x, y, test) ? float(value(x, y)) : std::numeric_limits<float>::quiet_NaN();
  });
  Plane<LightSum> rows(w), sums(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const SurfaceKey key = surface_at(present, x, y);
      LightSum s;
      for (int i = std::max(x - r, w.x0); i <= std::min(x + r, w.x1 - 1); ++i) {
        const double v = double(own.at(i, y));
        if (v == v && test.same(surface_at(present, i, y), key)) s.add({v, v * v, 1});
      }
      rows.at(x, y) = s;
    }
  });
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const SurfaceKey key = surface_at(present, x, y);
      LightSum s;
      for (int j = std::max(y - r, w.y0); j <= std::min(y + r, w.y1 - 1); ++j)
        if (test.same(surface_at(present, x, j), key)) s.add(rows.at(x, j));
      sums.at(x, y) = s;
    }
  });
  return sums;
}

/// Light around the place where a sample arrives: of its pixel, or of the nearest neighbor that shows the same surface.
float light_at(const GatherSource& target, const Plane<float>& light_plane, glm::dvec2 at, SurfaceKey key,
               const SurfaceTest& test) {
  const Window& w = target.window();
  const int cx = int(std::floor(at.x)), cy = int(std::floor(at.y));
  float light = 0;
  double nearest = 1e300;
  const auto look = [&](int x, int y) {
    if (!w.contains(x, y) || !test.same(surface_at(*target.present, x, y), key)) return;
    const float here = light_plane.at(x, y);
    const double dx = x + 0.5 - at.x, dy = y + 0.5 - at.y, distance = dx * dx + dy * dy;
    if (here > 0 && distance < nearest) light = here, nearest = distance;
  };
  look(cx, cy);
  if (light > 0) return light;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) look(cx + i, cy + j);
  return light;
}

}  // namespace

Plane<LightRange> local_range(const Plane<glm::vec4>& color, const Present& present, const SurfaceTest& test,
                              Workers& workers) {
  const Window& w = present.color.window();
  Plane<LightRange> range(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      LightRange& r = range.at(x, y);
      r = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
      if (!is_pure(present, x, y, test)) continue;
      r.own = r.low = r.high = float(luminance(color.at(x, y)));
      for (int j = std::max(y - 1, w.y0); j <= std::min(y + 1, w.y1 - 1); ++j)
        for (int i = std::max(x - 1, w.x0); i <= std::min(x + 1, w.x1 - 1); ++i) {
          const float light = float(luminance(color.at(i, j)));
          r.low = std::min(r.low, light), r.high = std::max(r.high, light);
        }
    }
  });
  return range;
}

Plane<float> local_light(const Plane<glm::vec4>& color, const Present& present, const SurfaceTest& test, int edge,
                         Workers& workers) {
  const Plane<LightSum> sums = sum_windows(
      present, test, edge, [&](int x, int y) { return luminance(color.at(x, y)); }, workers);
  Plane<float> light(sums.window());
  const Window& w = light.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const LightSum& s = sums.at(x, y);
      light.at(x, y) = s.count > 0 ? float(s.sum / s.count) : 0.0f;
    }
  });
  return light;
}

void follow_sudden_light(Plane<float>& light, const Plane<glm::vec4>& pilot, const Present& present,
                         const SurfaceTest& test, int edge, Workers& workers) {
  const Plane<LightSum> sums = sum_windows(
      present, test, edge, [&](int x, int y) { return luminance(present.color.at(x, y)) - luminance(pilot.at(x, y)); },
      workers);
  const Window& w = light.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const LightSum& s = sums.at(x, y);
      if (s.count < kFewestPixels) continue;
      const double mean = s.sum / s.count, variance = std::max(s.squares / s.count - mean * mean, 0.0);
      const double known =
          std::max(kSuddenErrors * std::sqrt(variance / s.count), kSuddenShare * double(light.at(x, y)));
      if (std::fabs(mean) > known && double(light.at(x, y)) + mean > 0) light.at(x, y) += float(mean);
    }
  });
}

ShadingGain shading_gain(const GatherSource& source, int x, int y, const GatherSource& target, glm::dvec2 at,
                         SurfaceKey key, const SurfaceTest& test, double dead_zone, double half_weight) {
  ShadingGain result;
  const float there = source.local_light->at(x, y);
  if (there > 0) {
    const float here = light_at(target, *target.local_light, at, key, test);
    const double change = here > 0 ? double(here) / double(there) - 1 : 0;
    if (std::fabs(change) > dead_zone) {
      const double trusted = dead_zone / change;
      const double gain = std::min(1 + change * (1 - trusted * trusted), kMostGain);
      const double off = std::log(gain) / half_weight;
      result = {float(gain), float(1 / (1 + off * off))};
    }
  }
  if (!source.light_range || !target.light_range) return result;
  const int tx = int(std::floor(at.x)), ty = int(std::floor(at.y));
  if (!target.window().contains(tx, ty)) return result;
  const LightRange& here = target.light_range->at(tx, ty);
  const double own = double(source.light_range->at(x, y).own) * double(result.gain);
  if (!(here.own == here.own) || !test.same(surface_at(*target.present, tx, ty), key)) return result;
  const double over = own / double(here.high), under = double(here.low) / own;
  const double beyond = std::max(over, under);
  if (!(beyond > kHighlight) || !(beyond < 1e30)) return result;
  const double off = std::log(beyond / kHighlight) / kHighlightWidth;
  result.weight *= float(1 / (1 + off * off));
  return result;
}

}  // namespace varve
