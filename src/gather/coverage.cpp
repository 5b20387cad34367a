#include "gather/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace varve {
namespace {

Track track_of(const PixelContext& c, const Arrival& a, double distance) {
  const GatherSource& source = c.sources[a.source];
  const Window& w = source.window();
  const int x = w.x0 + int(a.pixel & 0xFFFF), y = w.y0 + int(a.pixel >> 16);
  const glm::dvec2 to(double(a.x) + c.arrivals->tile.x0, double(a.y) + c.arrivals->tile.y0);
  return {to - source.position(x, y), source.present->depth.at(x, y), distance};
}

constexpr double kOutlineSpacing = 0.43;  // px
constexpr double kShear = 0.05;
constexpr double kBend = 0.15;  // px

/// A surface that is stretched or turned away on its way here has another outline there: the rim of a ball that spins
/// is not made of the same points in any two frames. Strain is that of Green and Lagrange, 0 for shifts and rotations
/// of the picture; growing alike in all directions, as in a zoom, does no harm either.
double outline_weight(const AffineFit<glm::dvec3>& motion) {
  const auto [gx, gy] = motion.slope();
  // Where a sample came from is here minus its displacement; so the picture's map there has the slope of minus that.
  const double a = gx.x, b = gy.x, c = gx.y, d = gy.y;
  const double xx = -a + 0.5 * (a * a + c * c), yy = -d + 0.5 * (b * b + d * d), xy = 0.5 * (-b - c + a * b + c * d);
  const double shear = ((xx - yy) * (xx - yy) / 2 + 2 * xy * xy) / (kShear * kShear),
               bend = motion.misfit() / (kBend * kBend);
  return 1 / (1 + shear + bend);
}

/// Frames that do not show it: along a straight line between, and beyond, those that do.
void fill_gaps(std::vector<Track>& tracks) {
  const int n = int(tracks.size());
  int before = -1, earlier = -1;  // the last two known
  for (int i = 0; i < n; ++i) {
    Track& t = tracks[std::size_t(i)];
    if (t.known()) {
      earlier = before, before = i;
      continue;
    }
    int after = i + 1;
    while (after < n && !tracks[std::size_t(after)].known()) ++after;
    int a = before, b = after;
    if (before < 0) {
      a = after, b = after + 1;
      while (b < n && !tracks[std::size_t(b)].known()) ++b;
    } else if (after >= n) {
      a = earlier, b = before;
    }
    const bool two = a >= 0 && b < n && a != b;
    const Track& p = tracks[std::size_t(a >= 0 && a < n ? a : b)];
    t.displacement = p.displacement;
    t.depth = p.depth;
    t.weight = p.weight;
    if (two) {
      const Track& q = tracks[std::size_t(b)];
      const double f = double(i - a) / (b - a);
      t.displacement += (q.displacement - p.displacement) * f;
    }
  }
}

/// The first pixel at or beyond a position; absurd ones stay in the range of an int.
int first_pixel_at(double position) {
  constexpr double most = std::numeric_limits<int>::max();
  return int(std::clamp(std::ceil(position), -most, most));
}

/// Where the surface of `arrivals` is in each frame.
void track_surface(const PixelContext& c, std::span<const Arrival* const> arrivals, int x, int y,
                   std::vector<Track>& tracks) {
  const std::size_t frames = c.sources.size() / c.samples;
  tracks.assign(frames, {});
  const double mx = x - c.arrivals->tile.x0 + 0.5, my = y - c.arrivals->tile.y0 + 0.5;
  for (const Arrival* a : arrivals) {
    const double dx = double(a->x) - mx, dy = double(a->y) - my, distance = dx * dx + dy * dy;
    Track& track = tracks[frame_of(*a, c.samples)];
    if (distance < track.distance) track = track_of(c, *a, distance);
  }
  // In the resolved frame itself it lies where it lies.
  Track& here = tracks[c.present];
  if (!here.known()) here = {glm::dvec2(0), arrivals.front()->depth, 0};
  // Frames whose samples miss it here: as it moves elsewhere in the tile.
  for (const TileSurface& s : c.arrivals->surfaces) {
    if (!belongs(s.id, s.near, s.far, *arrivals.front(), c.test)) continue;
    for (std::size_t f = 0; f < frames; ++f) {
      if (s.motion[f].count() == 0) continue;
      if (!tracks[f].known()) {
        const glm::dvec3 v = s.motion[f].value(glm::dvec2(mx, my) - glm::dvec2(kTile / 2));
        // Infinitely far there as here: a fit of infinities is no number.
        tracks[f] = {glm::dvec2(v), std::isfinite(v.z) ? float(v.z) : arrivals.front()->depth, 0};
      }
      tracks[f].weight = outline_weight(s.motion[f]);
    }
    break;
  }
  fill_gaps(tracks);
  // A few samples tell no strain: trust in the outline never grows with distance.
  for (std::size_t f = c.present + 1; f < frames; ++f)
    tracks[f].weight = std::min(tracks[f].weight, tracks[f - 1].weight);
  for (std::size_t f = c.present; f-- > 0;) tracks[f].weight = std::min(tracks[f].weight, tracks[f + 1].weight);
}

/// Samples of source `f` that would arrive around the pixel if they moved with the surface.
void look_along(const PixelContext& c, std::size_t f, const Track& t, std::uint32_t id, int x, int y,
                PixelScratch& scratch) {
  const GatherSource& source = c.sources[f];
  const Window& w = source.window();
  const double reach = double(c.arrivals->around) / kBinsPerPixel;  // beyond the pixel's edge
  const glm::dvec2 shift = t.displacement + source.jitter + glm::dvec2(0.5);
  const int x0 = std::max(first_pixel_at(x - reach - shift.x), w.x0),
            y0 = std::max(first_pixel_at(y - reach - shift.y), w.y0);
  const int x1 = std::min(first_pixel_at(x + 1 + reach - shift.x), w.x1),
            y1 = std::min(first_pixel_at(y + 1 + reach - shift.y), w.y1);
  for (int v = y0; v < y1; ++v)
    for (int u = x0; u < x1; ++u) {
      if (!(source.present->valid.at(u, v) > 0)) continue;
      const SurfaceKey key = surface_at(*source.present, u, v);
      const bool hit = c.test.same(key, {id, t.depth});
      if (!hit && !(key.depth > t.depth)) continue;
      scratch.px.push_back(float(u + shift.x - x - 0.5));
      scratch.py.push_back(float(v + shift.y - y - 0.5));
      scratch.is_hit.push_back(hit);
      scratch.pw.push_back(float(t.weight));
    }
}

/// Sums of the hits and of the misses over the cells.
void sum_coverage(const PixelContext& c, PixelScratch& scratch) {
  lift_weights(scratch.pw);
  const std::size_t cells = std::size_t(c.axis.count);
  const std::size_t size = (scratch.px.size() + kCellLanes - 1) / kCellLanes * kCellLanes;
  scratch.is_hit.resize(size, 2);
  scratch.px.resize(size, 0), scratch.py.resize(size, 0), scratch.pw.resize(size, 0);
  scratch.cx.resize(size * cells), scratch.cy.resize(size * cells), scratch.masked.resize(size * cells);
  const float scale = gaussian_scale(c, scratch.pw, kOutlineSpacing, 0);
  const auto stride = std::ptrdiff_t(size);
  c.kernel->axis_weights(scratch.px.data(), int(size), c.axis.centers, c.axis.count, scale, scratch.cx.data(), stride);
  c.kernel->axis_weights(scratch.py.data(), int(size), c.axis.centers, c.axis.count, scale, scratch.cy.data(), stride);
  for (const std::uint8_t wanted : {1, 0}) {
    for (std::size_t j = 0; j < cells; ++j)
      for (std::size_t i = 0; i < size; ++i)
        scratch.masked[j * size + i] = scratch.is_hit[i] == wanted ? scratch.cy[j * size + i] * scratch.pw[i] : 0;
    c.kernel->cell_sums(scratch.cx.data(), scratch.masked.data(), stride, int(size), c.axis.count,
                        wanted == 1 ? scratch.hits.data() : scratch.misses.data());
  }
}

}  // namespace

void measure_coverage(const PixelContext& c, std::span<const Arrival* const> arrivals, int x, int y,
                      PixelScratch& scratch) {
  track_surface(c, arrivals, x, y, scratch.tracks);
  scratch.px.clear(), scratch.py.clear(), scratch.pw.clear(), scratch.is_hit.clear();
  for (std::size_t f = 0; f < c.sources.size(); ++f)
    look_along(c, f, scratch.tracks[f / c.samples], arrivals.front()->id, x, y, scratch);
  const std::size_t area = std::size_t(c.axis.count) * std::size_t(c.axis.count);
  scratch.hits.assign(area, 1);
  scratch.misses.assign(area, 0);
  if (!scratch.px.empty()) sum_coverage(c, scratch);
}

}  // namespace varve
