#include "reference/gather_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "gather/shading_gain.h"
#include "resolve/sample_weights.h"

namespace varve::reference {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Point {
  glm::dvec2 at;
  double weight;
  glm::dvec3 value;
};

/// Least squares of value = constant + slope * at, from the textbook.
struct Fit {
  glm::dvec2 mean{0};
  glm::dvec3 value{0}, x{0}, y{0};  // at the mean, and slopes
  double xx = 0, xy = 0, yy = 0, misfit = 0;
  bool spans = false;
  glm::dvec3 at(glm::dvec2 p) const { return value + x * (p.x - mean.x) + y * (p.y - mean.y); }
  bool around() const {
    return mean.x * mean.x * yy - 2 * mean.x * mean.y * xy + mean.y * mean.y * xx < 4 * (xx * yy - xy * xy);
  }
};

Fit fit(const std::vector<Point>& points) {
  Fit f;
  double sum = 0;
  for (const Point& p : points) sum += p.weight;
  for (const Point& p : points) f.mean += p.at * (p.weight / sum), f.value += p.value * (p.weight / sum);
  glm::dvec3 cx(0), cy(0), vv(0);
  for (const Point& p : points) {
    const glm::dvec2 d = p.at - f.mean;
    const glm::dvec3 v = p.value - f.value;
    const double w = p.weight / sum;
    f.xx += w * d.x * d.x, f.xy += w * d.x * d.y, f.yy += w * d.y * d.y;
    cx += v * (w * d.x), cy += v * (w * d.y), vv += v * v * w;
  }
  f.spans = points.size() >= 5 && f.xx * f.yy - f.xy * f.xy > 0.25 * (f.xx + f.yy);
  const double ridge = (f.spans ? 1e-9 : 1e-3) * (f.xx + f.yy) + 1e-6, a = f.xx + ridge, d = f.yy + ridge,
               det = a * d - f.xy * f.xy;
  f.x = (cx * d - cy * f.xy) / det, f.y = (cy * a - cx * f.xy) / det;
  const glm::dvec3 left = vv - f.x * cx - f.y * cy;
  f.misfit = left.x + left.y;
  return f;
}

glm::dvec3 read(const CarriedSamples& field, const GatherSource& s, glm::dvec2 at, SurfaceKey key,
                const SurfaceTest& test) {
  const Window& w = s.window();
  const glm::dvec2 g = at - glm::dvec2(0.5) - s.jitter;
  if (!(g.x >= w.x0 - 1 && g.y >= w.y0 - 1 && g.x <= w.x1 && g.y <= w.y1)) return glm::dvec3(kNan);
  const int bx = int(std::floor(g.x)), by = int(std::floor(g.y));
  const auto collect = [&](int reach) {
    std::vector<Point> found;
    for (int y = std::max(by + 1 - reach, w.y0); y < std::min(by + 1 + reach, w.y1); ++y)
      for (int x = std::max(bx + 1 - reach, w.x0); x < std::min(bx + 1 + reach, w.x1); ++x) {
        const glm::dvec3 v = field[std::size_t((y - w.y0) * w.width() + x - w.x0)];
        const glm::dvec2 d(x - g.x, y - g.y);
        if (v.x == v.x && test.same(surface_at(*s.present, x, y), key))
          found.push_back({d, 1 / (0.25 + d.x * d.x + d.y * d.y), v});
      }
    return found;
  };
  std::vector<Point> near = collect(1);  // the four corners
  if (near.size() == 4) {
    glm::dvec3 sum(0);
    for (const Point& p : near) sum += p.value * ((1 - std::fabs(p.at.x)) * (1 - std::fabs(p.at.y)));
    return sum;
  }
  for (int reach = 2; reach <= 32; reach *= 2) {
    const std::vector<Point> found = collect(reach);
    if (found.empty()) continue;
    const Fit f = fit(found);
    if (reach == 32 || (f.spans && f.around())) return f.misfit < 0.01 ? f.at({0, 0}) : glm::dvec3(kNan);
  }
  return glm::dvec3(kNan);
}

struct Sample {
  glm::dvec2 at, moved;
  SurfaceKey key;  // in the resolved frame
  double depth_there;
  std::size_t frame;
  glm::dvec4 color;
};

/// Samples that arrive within `edge` pixels from a corner, both half open, frame after frame.
std::vector<Sample> arrivals(std::span<const GatherSource> sources, const std::vector<CarriedSamples>& carried,
                             glm::dvec2 low, glm::dvec2 high) {
  std::vector<Sample> found;
  for (std::size_t f = 0; f < sources.size(); ++f) {
    const Window& w = sources[f].window();
    std::size_t i = 0;
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x, ++i) {
        const glm::dvec2 moved(carried[f][i]), at = sources[f].position(x, y) + moved;
        if (!(at.x >= low.x && at.y >= low.y && at.x < high.x && at.y < high.y)) continue;
        const Present& p = *sources[f].present;
        if (!(p.valid.at(x, y) > 0)) continue;
        const SurfaceKey key = surface_at(p, x, y);
        found.push_back({at,
                         moved,
                         {key.id, float(carried[f][i].z)},
                         double(key.depth),
                         f / samples_of(sources),
                         glm::dvec4(p.color.at(x, y))});
      }
  }
  return found;
}

/// Brings samples of one surface together, nearest surface first. Meant for surfaces of one depth each.
std::vector<std::vector<Sample>> layers(const std::vector<Sample>& samples, const SurfaceTest& test) {
  if (!test.depths) return {samples};
  std::vector<std::vector<Sample>> found;
  for (const Sample& s : samples) {
    std::size_t k = 0;
    while (k < found.size() && !test.same(found[k].front().key, s.key)) ++k;
    if (k == found.size()) found.emplace_back();
    found[k].push_back(s);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.front().key.depth < b.front().key.depth; });
  return found;
}

struct Cells {
  std::vector<double> center, share;
  double radius = 0.5, reach = 0.75;  // of the filter around the middle; beyond the pixel's edge
};

Cells cells_of(const GatherParameters& p) {
  Cells c;
  if (p.filter != SampleFilter::none) c.radius = reconstruction_radius(p.filter);
  c.reach = std::ceil(4 * (c.radius - 0.5) + 1) / 4;
  const bool box = p.filter == SampleFilter::none;
  const int half = std::min(int(std::ceil(c.radius * p.cells - 1e-9)), 16);
  double sum = 0;
  for (int i = 0; i < (box ? p.cells : 2 * half); ++i) {
    const double at = (i + 0.5) / p.cells - (box ? 0.5 : double(half) / p.cells),
                 share = box ? 1 : reconstruction_kernel(p.filter, at);
    if (share != 0) c.center.push_back(at), c.share.push_back(share), sum += share;
  }
  for (double& s : c.share) s /= sum;
  return c;
}

/// Sum of squared distances from the mean.
double spread(const std::vector<double>& values) {
  double mean = 0, sum = 0;
  for (const double v : values) mean += v / double(values.size());
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum;
}

/// Variance within quarter pixels over the variance of all; quarters are told apart in float, as the program does.
double noise_of(const std::vector<Sample>& layer, glm::dvec2 tile) {
  std::map<std::pair<float, float>, std::vector<double>> quarters;
  std::vector<double> all;
  for (const Sample& s : layer) {
    const double light = double(float(luminance(glm::vec4(s.color))));
    all.push_back(light);
    quarters[{std::floor(float(s.at.x - tile.x) * 4), std::floor(float(s.at.y - tile.y) * 4)}].push_back(light);
  }
  double within = 0, freedom = 0;
  for (const auto& [place, values] : quarters) within += spread(values), freedom += double(values.size()) - 1;
  const double total = spread(all) / (double(all.size()) - 1);
  return freedom >= 8 && total > 0 ? within / freedom / total : 0;
}

double sigma_of(const Cells& c, const GatherParameters& p, const std::vector<double>& weights, double spacing,
                double noise) {
  double sum = 0, squares = 0;
  for (const double w : weights) sum += w, squares += w * w;
  const double edge = 2 * c.radius + 0.5, per_pixel = squares > 0 ? sum * sum / squares / (edge * edge) : 0;
  const double widened = p.sigma + std::max(0.2 - p.sigma, 0.0) * std::clamp(2.5 * (noise - 0.5), 0.0, 1.0);
  return std::max(widened, spacing / std::sqrt(std::max(per_pixel, 0.25)));
}

double bell(glm::dvec2 d, double sigma) {
  const double scale = 0.5 / (sigma * sigma);
  return std::exp(std::max(-d.x * d.x * scale, -40.0)) * std::exp(std::max(-d.y * d.y * scale, -40.0));
}

/// How a surface moved here from each frame, and how far its outline there is trusted.
struct Track {
  bool known = false;
  glm::dvec2 moved{0};
  double depth = 0, weight = 1;
};

std::vector<Track> follow(const std::vector<Sample>& layer, const std::vector<Sample>& in_tile, glm::dvec2 tile,
                          glm::dvec2 middle, std::size_t frames, std::size_t present, const SurfaceTest& test) {
  std::vector<Track> tracks(frames);
  std::vector<double> nearest(frames, 1e300);
  for (const Sample& s : layer) {
    const glm::dvec2 d = s.at - middle;
    if (d.x * d.x + d.y * d.y < nearest[s.frame])
      nearest[s.frame] = d.x * d.x + d.y * d.y, tracks.at(s.frame) = {true, s.moved, s.depth_there, 1};
  }
  if (!tracks.at(present).known) tracks.at(present) = {true, glm::dvec2(0), double(layer.front().key.depth), 1};
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<Point> points;
    for (const Sample& s : in_tile)
      if (s.frame == f && test.same(s.key, layer.front().key))
        points.push_back({s.at - tile - glm::dvec2(8), 1, {s.moved, s.depth_there}});
    if (points.empty()) continue;
    const Fit motion = fit(points);
    if (!tracks[f].known) {
      const glm::dvec3 v = motion.at(middle - tile - glm::dvec2(8));
      tracks[f] = {true, glm::dvec2(v), v.z, 1};
    }
    // F = 1 - slope; strain (F^T F - 1) / 2, without its trace.
    const double fxx = 1 - motion.x.x, fxy = -motion.y.x, fyx = -motion.x.y, fyy = 1 - motion.y.y;
    const double exx = (fxx * fxx + fyx * fyx - 1) / 2, eyy = (fxy * fxy + fyy * fyy - 1) / 2,
                 exy = (fxx * fxy + fyx * fyy) / 2;
    tracks[f].weight = 1 / (1 + ((exx - eyy) * (exx - eyy) / 2 + 2 * exy * exy) / 0.0025 + motion.misfit / 0.0225);
  }
  const std::vector<Track> seen = tracks;
  for (int f = 0; f < int(frames); ++f) {
    if (seen[std::size_t(f)].known) continue;
    std::vector<int> before, after;
    for (int i = f; i-- > 0;)
      if (seen[std::size_t(i)].known) before.push_back(i);
    for (int i = f + 1; i < int(frames); ++i)
      if (seen[std::size_t(i)].known) after.push_back(i);
    int a = 0, b = -1;
    if (!before.empty() && !after.empty())
      a = before.at(0), b = after.at(0);
    else if (before.empty())
      a = after.at(0), b = after.size() > 1 ? after.at(1) : -1;
    else
      a = before.size() > 1 ? before.at(1) : before.at(0), b = before.size() > 1 ? before.at(0) : -1;
    tracks[std::size_t(f)] = seen[std::size_t(a)];
    if (b >= 0)
      tracks[std::size_t(f)].moved +=
          (seen[std::size_t(b)].moved - seen[std::size_t(a)].moved) * (double(f - a) / double(b - a));
  }
  for (std::size_t f = present + 1; f < frames; ++f)
    tracks[f].weight = std::min(tracks[f].weight, tracks[f - 1].weight);
  for (std::size_t f = present; f-- > 0;) tracks[f].weight = std::min(tracks[f].weight, tracks[f + 1].weight);
  return tracks;
}

/// Samples that show a surface (1) or what is behind it (0), where they would be if they moved with it.
struct Look {
  glm::dvec2 at;
  double weight;
  bool hit;
};

std::vector<Look> look(std::span<const GatherSource> sources, const std::vector<Track>& tracks, std::uint32_t id,
                       glm::dvec2 corner, double reach, const SurfaceTest& test) {
  std::vector<Look> seen;
  for (std::size_t f = 0; f < sources.size(); ++f) {
    const Window& w = sources[f].window();
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const Track& track = tracks[f / samples_of(sources)];
        const glm::dvec2 at = sources[f].position(x, y) + track.moved - corner;
        if (!(at.x >= -reach && at.y >= -reach && at.x < 1 + reach && at.y < 1 + reach)) continue;
        if (!(sources[f].present->valid.at(x, y) > 0)) continue;
        const SurfaceKey key = surface_at(*sources[f].present, x, y);
        const bool hit = test.same(key, {id, float(track.depth)});
        if (hit || double(key.depth) > track.depth) seen.push_back({at - glm::dvec2(0.5), track.weight, hit});
      }
  }
  return seen;
}

}  // namespace

std::vector<CarriedSamples> carry_samples(std::span<const GatherSource> sources, std::size_t present,
                                          const SurfaceTest& test) {
  std::vector<CarriedSamples> carried(sources.size());
  const std::size_t samples = samples_of(sources), first = present * samples, last = first + samples - 1;
  const auto carry = [&](std::size_t f, const Plane<glm::vec2>* vectors, int toward) {
    const GatherSource& s = sources[f];
    const Window& w = s.window();
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const SurfaceKey key = surface_at(*s.present, x, y);
        if (f >= first && f <= last) {
          carried[f].push_back({0, 0, double(key.depth)});
          continue;
        }
        const glm::dvec2 v = vectors ? glm::dvec2(vectors->at(x, y)) : glm::dvec2(0);
        glm::dvec3 found(kNan);
        for (int steps = 1; steps <= 2 && !(found.x == found.x); ++steps) {
          const int to = int(f) + toward * steps * int(samples);
          if (toward > 0 ? to > int(last) : to < int(first)) continue;
          const glm::dvec2 way = v * double(steps);
          found = glm::dvec3(way, 0) +
                  read(carried[std::size_t(to)], sources[std::size_t(to)], s.position(x, y) + way, key, test);
        }
        carried[f].push_back(found);
      }
  };
  for (std::size_t f = first; f <= last; ++f) carry(f, nullptr, 0);
  for (std::size_t f = last + 1; f < sources.size(); ++f) carry(f, sources[f].backward, -1);
  for (std::size_t f = first; f-- > 0;) carry(f, sources[f].forward, 1);
  return carried;
}

glm::dvec4 gathered_pixel(std::span<const GatherSource> sources, std::size_t present,
                          const std::vector<CarriedSamples>& carried, const GatherParameters& parameters,
                          const SurfaceTest& test, int x, int y) {
  const Cells cells = cells_of(parameters);
  const std::size_t samples = samples_of(sources);
  const Window& w = sources[present * samples].window();
  const glm::dvec2 corner(x, y), middle(x + 0.5, y + 0.5), reach(cells.reach);
  const glm::dvec2 tile(w.x0 + (x - w.x0) / 16 * 16, w.y0 + (y - w.y0) / 16 * 16);
  std::vector<Sample> in_tile = arrivals(sources, carried, tile - reach, tile + glm::dvec2(16) + reach);
  const std::vector<Sample> found = arrivals(sources, carried, corner - reach, corner + glm::dvec2(1) + reach);
  if (found.empty()) {
    glm::dvec4 mean(0);
    for (std::size_t s = 0; s < samples; ++s)
      mean += glm::dvec4(sources[present * samples + s].present->color.at(x, y)) / double(samples);
    return mean;
  }
  if (layers(in_tile, test).size() < 2) in_tile.clear();
  const std::vector<std::vector<Sample>> list = layers(found, test);
  const std::size_t n = cells.center.size();
  std::vector<double> through(n * n, 1);
  glm::dvec4 color(0);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const bool last = k + 1 == list.size();
    std::vector<Look> seen;
    if (!last)
      seen = look(sources, follow(list[k], in_tile, tile, middle, sources.size() / samples, present, test),
                  list[k].front().key.id, corner, cells.reach, test);
    std::vector<double> weights;
    for (const Look& l : seen) weights.push_back(l.weight);
    const double outline = sigma_of(cells, parameters, weights, 0.43, 0),
                 blur =
                     sigma_of(cells, parameters, std::vector<double>(list[k].size(), 1), 0.3, noise_of(list[k], tile));
    for (std::size_t cell = 0; cell < n * n; ++cell) {
      const glm::dvec2 at(cells.center[cell % n], cells.center[cell / n]);
      double hits = seen.empty() ? 1 : 0, all = hits;
      for (const Look& l : seen) {
        const double g = l.weight * bell(l.at - at, outline);
        all += g, hits += l.hit ? g : 0;
      }
      const double covered = last ? 1 : hits / all;
      glm::dvec4 sum(0);
      double total = 0;
      for (const Sample& s : list[k]) {
        const double g = bell(s.at - middle - at, blur);
        sum += s.color * g, total += g;
      }
      color += sum / total * (cells.share[cell % n] * cells.share[cell / n] * through[cell] * covered);
      through[cell] *= 1 - covered;
    }
  }
  return color;
}

}  // namespace varve::reference
