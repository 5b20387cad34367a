#include "gather/gather.h"

#include <algorithm>
#include <cmath>

#include "gather/arrivals.h"
#include "gather/gather_pixel.h"
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

/// Carries every frame to the resolved one, outwards from it on both sides.
std::vector<Carried> carry_all(std::span<const GatherSource> sources, std::size_t present, const SurfaceTest& test,
                               Workers& workers) {
  std::vector<Carried> fields(sources.size());
  fields[present] = carry_present(sources[present], workers);
  const auto followed = [&](std::size_t i) { return Followed{&sources[i], &fields[i]}; };
  for (std::size_t i = present + 1; i < sources.size(); ++i)
    fields[i] = carry(sources[i], false, test, followed(i - 1), i - present > 1 ? followed(i - 2) : Followed{}, workers);
  for (std::size_t i = present; i-- > 0;)
    fields[i] = carry(sources[i], true, test, followed(i + 1), present - i > 1 ? followed(i + 2) : Followed{}, workers);
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

/// With few frames the cells must look further for a sample. In a still picture n samples are n^-1/2 pixels apart.
double cell_sigma(const GatherParameters& parameters, std::size_t frames) {
  return std::max(parameters.sigma, 0.43 / std::sqrt(double(frames)));
}

/// Sums over the arrivals of a pixel.
struct PixelResult {
  glm::dvec4 color{0};
  double weights = 0, squares = 0;              // of all weights; they sum to 1
  double past = 0, past_squares = 0, future = 0, future_squares = 0;
  double light = 0, light_squares = 0;          // luminance, centred at the first
};

double luminance(const glm::dvec4& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

PixelResult sum_pixel(const PixelContext& c, const PixelWeights& pixel) {
  PixelResult r;
  bool first = true;
  double shift = 0;
  for (std::size_t i = 0; i < pixel.weights.size(); ++i) {
    const Arrival* a = pixel.arrivals[i];
    if (!a) continue;
    const GatherSource& source = c.sources[a->frame];
    const Window& w = source.window();
    glm::dvec4 color(source.present->color.at(w.x0 + int(a->pixel & 0xFFFF), w.y0 + int(a->pixel >> 16)));
    const double gain = double(a->gain), weight = double(pixel.weights[i]);
    color.r *= gain, color.g *= gain, color.b *= gain;
    r.color += color * weight;
    r.weights += weight;
    r.squares += weight * weight;
    if (a->frame < c.present) r.past += weight, r.past_squares += weight * weight;
    if (a->frame > c.present) r.future += weight, r.future_squares += weight * weight;
    if (first) shift = luminance(color), first = false;
    const double light = luminance(color) - shift;
    r.light += weight * light;
    r.light_squares += weight * light * light;
  }
  r.color /= r.weights;
  return r;
}

void write_pixel(Accumulated& out, const PixelResult& r, int x, int y) {
  const double limit = double(std::numeric_limits<float>::max());
  glm::dvec4 color = r.color;
  for (int k = 0; k < 4; ++k) color[k] = std::clamp(color[k], -limit, limit);
  out.history.color.at(x, y) = glm::vec4(color);
  const double spread = r.squares / (r.weights * r.weights);
  out.history.total.at(x, y) = float(std::min(1 / spread, 1e6));
  out.history.spread.at(x, y) = float(spread);
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
  const Window& w = sources[present].window();
  Accumulated out;
  out.history.color = Plane<glm::vec4>(w);
  out.history.total = Plane<float>(w, 0, 0.0f);
  out.history.spread = Plane<float>(w, 0, 0.0f);
  if (wanted.weight) out.diagnostics.weight = Plane<float>(w, 0, 0.0f);
  if (wanted.clip) out.diagnostics.clip = Plane<float>(w, 0, 0.0f);
  if (wanted.reject) out.diagnostics.reject = Plane<std::uint32_t>(w, 0, 0u);
  if (w.empty()) return out;

  const std::vector<Carried> fields = carry_all(sources, present, test, workers);
  PixelContext context;
  context.sources = sources;
  context.present = present;
  context.axis = cell_axis(parameters.filter, parameters.cells);
  context.sigma = cell_sigma(parameters, sources.size());
  context.test = test;
  context.kernel = cell_kernel_for(isa);
  const TileGrid grid{w, context.axis.radius - 0.5 + 1.0 / kBinsPerPixel};
  std::vector<BlockLists> lists(sources.size());
  workers.for_each(sources.size(), [&](std::size_t i, int) { lists[i] = list_blocks(sources[i], fields[i], grid); });

  const LightRule light{parameters.gain && sources[present].local_light != nullptr, parameters.gain_dead_zone,
                        parameters.gain_weight};
  std::vector<TileArrivals> arrivals(std::size_t(workers.count()));
  std::vector<PixelScratch> scratch(std::size_t(workers.count()));
  std::vector<std::size_t> restarted(std::size_t(workers.count()));
  workers.for_each(std::size_t(grid.columns()) * std::size_t(grid.rows()), [&](std::size_t tile, int worker) {
    TileArrivals& here = arrivals[std::size_t(worker)];
    collect_arrivals(grid, int(tile) % grid.columns(), int(tile) / grid.columns(), sources, present, fields, lists,
                     light, test, here);
    PixelContext c = context;
    c.arrivals = &here;
    for (int y = here.tile.y0; y < here.tile.y1; ++y)
      for (int x = here.tile.x0; x < here.tile.x1; ++x) {
        const PixelWeights pixel = weigh_pixel(c, x, y, scratch[std::size_t(worker)]);
        if (pixel.arrivals.empty()) {
          out.history.color.at(x, y) = sources[present].present->color.at(x, y);
          ++restarted[std::size_t(worker)];
          continue;
        }
        write_pixel(out, sum_pixel(c, pixel), x, y);
      }
  });
  for (const std::size_t n : restarted) out.counts.restarted += n;
  return out;
}

}  // namespace varve
