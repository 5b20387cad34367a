#include "gather/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/held_float.h"
#include "base/reject.h"
#include "gather/arrivals.h"
#include "gather/gather_pixel.h"
#include "gather/round_trip.h"
#include "resolve/sample_weights.h"

namespace varve {
namespace {

const CellKernel* cell_kernel_for(Isa isa) {
#ifdef VARVE_HAVE_AVX2
  if (isa != Isa::baseline && __builtin_cpu_supports("avx2")) return &avx2::cell_kernel;
#endif
  (void)isa;
  return &baseline::cell_kernel;
}

/// Carries every frame to the resolved one, outwards from it on both sides, sample by sample.
std::vector<Carried> carry_all(std::span<const GatherSource> sources, std::size_t present, const SurfaceTest& test,
                               Workers& workers) {
  const std::size_t samples = samples_of(sources), frames = sources.size() / samples;
  std::vector<Carried> fields(sources.size());
  for (std::size_t s = 0; s < samples; ++s) {
    const auto at = [&](std::size_t frame) { return frame * samples + s; };
    // A sample that is not everywhere in both frames moves as the first one does.
    const auto step = [&](std::size_t from, std::size_t frame) {
      const std::size_t to = sources[at(from)].whole && sources[at(frame)].whole ? at(frame) : frame * samples;
      return Followed{&sources[to], &fields[to]};
    };
    fields[at(present)] = carry_present(sources[at(present)], workers);
    for (std::size_t i = present + 1; i < frames; ++i)
      fields[at(i)] =
          carry(sources[at(i)], false, test, step(i, i - 1), i - present > 1 ? step(i, i - 2) : Followed{}, workers);
    for (std::size_t i = present; i-- > 0;)
      fields[at(i)] =
          carry(sources[at(i)], true, test, step(i, i + 1), present - i > 1 ? step(i, i + 2) : Followed{}, workers);
  }
  return fields;
}

/// The filter's area in cells; those where the filter is 0 are left out.
CellAxis cell_axis(SampleFilter filter, int per_pixel) {
  CellAxis axis;
  axis.radius = filter == SampleFilter::none ? 0.5 : reconstruction_radius(filter);
  const int half = std::min(int(std::ceil(axis.radius * per_pixel - 1e-9)), kMaxCells / 2);
  const bool box = filter == SampleFilter::none;
  double sum = 0;
  for (int i = 0; i < (box ? per_pixel : 2 * half); ++i) {
    const double center = (i + 0.5) / per_pixel - (box ? 0.5 : double(half) / per_pixel);
    const double share = box ? 1.0 : reconstruction_kernel(filter, center);
    if (share == 0) continue;
    axis.centers[axis.count] = float(center);
    axis.share[axis.count++] = share;
    sum += share;
  }
  for (int i = 0; i < axis.count; ++i) axis.share[i] /= sum;
  return axis;
}

/// Weights of one side of time.
struct SideWeights {
  double sum = 0, squares = 0;
  void add(double weight) { sum += weight, squares += weight * weight; }
  float count() const { return squares > 0 ? float(sum * sum / squares) : 0; }
};

/// The one linear combination of samples that makes a pixel, for its color and for all that goes with it.
struct PixelSums {
  glm::dvec4 color{0};
  SideWeights all, past, present, future;
  double light = 0, light_squares = 0;  // luminance, centred at the first
  double removed = 0;                   // luminance of fireflies
  double trust = 0;                     // sum of the arrivals' own weights
  int arrivals = 0;
};

glm::dvec4 lit(const glm::vec4& sample, float gain) {
  return glm::dvec4(sample) * glm::dvec4(double(gain), double(gain), double(gain), 1);
}

PixelSums sum_pixel(const PixelContext& c, const PixelWeights& pixel) {
  PixelSums r;
  double shift = 0;
  const std::size_t first = c.present * c.samples, after = first + c.samples;
  for (std::size_t i = 0; i < pixel.weights.size(); ++i) {
    const Arrival* a = pixel.arrivals[i];
    if (!a) continue;
    const double weight = double(pixel.weights[i]);
    const glm::dvec4 color = lit(c.sources[a->source].color(a->pixel), a->gain * pixel.scale[i]);
    r.removed += weight * double(a->light) * (1 - double(pixel.scale[i]));
    r.color += color * weight;
    r.all.add(weight);
    (a->source < first ? r.past : a->source >= after ? r.future : r.present).add(weight);
    if (r.arrivals++ == 0) shift = double(a->light);
    const double light = double(a->light) - shift;
    r.light += weight * light;
    r.light_squares += weight * light * light;
    r.trust += double(a->weight);
  }
  return r;
}

void write_diagnostics(AccumulateDiagnostics& d, const PixelContext& c, const PixelSums& r, const PixelWeights& pixel,
                       int x, int y) {
  if (!d.weight.empty()) d.weight.at(x, y) = float(1 - r.present.sum / r.all.sum);
  if (!d.reject.empty() && !(r.past.sum + r.future.sum > 0)) d.reject.at(x, y) = kRejectEmptyHistory;
  if (!d.count_past.empty()) d.count_past.at(x, y) = r.past.count(), d.count_future.at(x, y) = r.future.count();
  if (d.variance.empty()) return;
  const double mean = r.light / r.all.sum, spread = std::max(r.light_squares / r.all.sum - mean * mean, 0.0);
  const double squares = r.all.squares / (r.all.sum * r.all.sum);
  const double variance = spread * squares, limit = double(std::numeric_limits<float>::max());
  d.variance.at(x, y) = float(variance < limit ? variance : limit);
  d.surfaces.at(x, y) = float(pixel.surfaces);
  d.removed.at(x, y) = float(r.removed / r.all.sum);
  d.gain.at(x, y) = float(r.trust / r.arrivals);
  std::uint64_t seen[kMostGathered / 64 + 1] = {};  // a bit for each frame of the widest window
  int frames = 0;
  for (const Arrival* a : pixel.arrivals)
    if (a) {
      const std::size_t frame = frame_of(*a, c.samples);
      std::uint64_t& word = seen[frame / 64];
      const std::uint64_t bit = std::uint64_t(1) << (frame % 64);
      frames += (word & bit) == 0;
      word |= bit;
    }
  d.frames.at(x, y) = float(frames);
}

bool is_color(const Present& present, std::size_t companion) {
  return companion >= present.companion_is_color.size() || present.companion_is_color[companion] != 0;
}

/// Everything of one pixel. Companions share the color's weights, and its gain where they are light, so that what added
/// up to it still does. Returns the luminance that was held back.
double write_pixel(Accumulated& out, const PixelContext& c, const PixelWeights& pixel, int x, int y) {
  const PixelSums r = sum_pixel(c, pixel);
  out.history.color.at(x, y) = held_color(r.color / r.all.sum);
  const double spread = r.all.squares / (r.all.sum * r.all.sum);
  out.history.total.at(x, y) = float(std::min(1 / spread, 1e6));
  out.history.spread.at(x, y) = float(spread);
  write_diagnostics(out.diagnostics, c, r, pixel, x, y);
  const Present& present = *c.sources[c.present * c.samples].present;
  for (std::size_t k = 0; k < out.history.companions.size(); ++k) {
    glm::dvec4 sum(0);
    for (std::size_t i = 0; i < pixel.weights.size(); ++i)
      if (const Arrival* a = pixel.arrivals[i]) {
        const glm::vec4& sample = c.sources[a->source].companion(k, a->pixel);
        const float gain = a->gain * pixel.scale[i];
        sum += (is_color(present, k) ? lit(sample, gain) : glm::dvec4(sample)) * double(pixel.weights[i]);
      }
    out.history.companions[k].at(x, y) = held_color(sum / r.all.sum);
  }
  return r.removed / r.all.sum;
}

Accumulated make_output(const Present& present, const DiagnosticsWanted& wanted) {
  const Window& w = present.color.window();
  Accumulated out;
  out.history.color = Plane<glm::vec4>(w);
  out.history.total = Plane<float>(w, 0, 0.0f);
  out.history.spread = Plane<float>(w, 0, 0.0f);
  for (std::size_t k = 0; k < present.companions.size(); ++k) out.history.companions.emplace_back(w);
  AccumulateDiagnostics& d = out.diagnostics;
  if (wanted.weight) d.weight = Plane<float>(w, 0, 0.0f);
  if (wanted.reject) d.reject = Plane<std::uint32_t>(w, 0, 0u);
  if (wanted.counts)
    for (Plane<float>* plane : {&d.count_past, &d.count_future}) *plane = Plane<float>(w, 0, 0.0f);
  if (wanted.gather)
    for (Plane<float>* plane : {&d.variance, &d.frames, &d.surfaces, &d.gain, &d.removed, &d.round_trip})
      *plane = Plane<float>(w, 0, 0.0f);
  return out;
}

/// A pixel that no sample reaches: what stands in for its own.
void keep_present(Accumulated& out, std::span<const GatherSource> own, int x, int y) {
  const auto mean = [&](const auto& plane) {
    glm::dvec4 sum(0);
    int count = 0;
    for (const GatherSource& sample : own)
      if (sample.whole) sum += glm::dvec4(plane(*sample.present).at(x, y)), ++count;
    return held_color(sum / double(count));
  };
  out.history.color.at(x, y) = mean([](const Present& p) -> const Plane<glm::vec4>& { return p.color; });
  for (std::size_t k = 0; k < out.history.companions.size(); ++k)
    out.history.companions[k].at(x, y) =
        mean([k](const Present& p) -> const Plane<glm::vec4>& { return p.companions[k]; });
  if (!out.diagnostics.reject.empty()) out.diagnostics.reject.at(x, y) = kRejectEmptyHistory | kRejectPresent;
}

}  // namespace

SurfaceTest surface_test(const Present& present) {
  SurfaceTest test;
  test.ids = !present.id.empty();
  test.depths = !present.depth.empty();
  // Without ids depth alone has to tell things apart.
  test.tolerance = test.ids ? 0.15f : 0.03f;
  return test;
}

Accumulated gather(std::span<const GatherSource> sources, std::size_t present, const GatherParameters& parameters,
                   const SurfaceTest& test, const DiagnosticsWanted& wanted, Workers& workers, Isa isa) {
  const std::size_t samples = samples_of(sources);
  const std::span<const GatherSource> own = sources.subspan(present * samples, samples);
  const Window& w = own.front().window();
  Accumulated out = make_output(*own.front().present, wanted);
  if (w.empty()) return out;

  const std::vector<Carried> fields = carry_all(sources, present, test, workers);
  PixelContext context;
  context.sources = sources;
  context.present = present;
  context.samples = samples;
  context.axis = cell_axis(parameters.filter, parameters.cells);
  context.sigma = parameters.sigma;
  context.change_limit = parameters.change_limit;
  context.firefly_limit = parameters.firefly_limit;
  context.test = test;
  context.kernel = cell_kernel_for(isa);
  // Whole bins, as find_arrivals() reads them: else pixels at a tile's edge would miss samples that others see.
  const TileGrid grid{w, (std::ceil((context.axis.radius - 0.5) * kBinsPerPixel) + 1) / kBinsPerPixel};
  std::vector<BlockLists> lists(sources.size());
  workers.for_each(sources.size(), [&](std::size_t i, int) { lists[i] = list_blocks(sources[i], fields[i], grid); });

  const LightRule light{parameters.gain && own.front().local_light != nullptr, parameters.gain_dead_zone,
                        parameters.gain_weight};
  std::vector<TileArrivals> arrivals(std::size_t(workers.count()));
  std::vector<PixelScratch> scratch(std::size_t(workers.count()));
  std::vector<std::size_t> restarted(std::size_t(workers.count()));
  // Tile by tile: the sum must not hang on which thread had which.
  std::vector<double> removed(std::size_t(grid.columns()) * std::size_t(grid.rows()));
  workers.for_each(removed.size(), [&](std::size_t tile, int worker) {
    TileArrivals& here = arrivals[std::size_t(worker)];
    collect_arrivals(grid, int(tile) % grid.columns(), int(tile) / grid.columns(), sources, present, fields, lists,
                     light, test, here);
    PixelContext c = context;
    c.arrivals = &here;
    for (int y = here.tile.y0; y < here.tile.y1; ++y)
      for (int x = here.tile.x0; x < here.tile.x1; ++x) {
        const PixelWeights pixel = weigh_pixel(c, x, y, scratch[std::size_t(worker)]);
        if (pixel.arrivals.empty()) {
          keep_present(out, own, x, y);
          ++restarted[std::size_t(worker)];
          continue;
        }
        removed[tile] += write_pixel(out, c, pixel, x, y);
      }
  });
  if (wanted.gather && present > 0)
    measure_round_trip(own.front(), sources[(present - 1) * samples], test, out.diagnostics.round_trip, workers);
  for (const std::size_t n : restarted) out.counts.restarted += n;
  for (const double of_tile : removed) out.counts.removed += of_tile;
  return out;
}

}  // namespace varve
