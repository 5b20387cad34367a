#include "gather/gather_pixel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "gather/coverage.h"
#include "gather/fireflies.h"
#include "gather/noise_share.h"
#include "gather/temporal_change.h"

namespace varve {
namespace {

constexpr int kMaxSurfaces = 8;
constexpr double kColorSpacing = 0.3;  // pixels

/// A surface as it arrives in a pixel.
struct Surface {
  std::uint32_t id = 0;
  float near = 0, far = 0;
  double depth_sum = 0;
  int count = 0, begin = 0, padded = 0;  // arrivals, and where they stand in the ordered list
  double depth() const { return depth_sum / count; }
};

struct Surfaces {
  std::array<Surface, kMaxSurfaces> list;
  std::array<int, kMaxSurfaces> front_to_back{};
  int count = 0;
};

/// Arrivals within reach of the filter: the bins of a quarter pixel that it covers, and one more on each side.
void find_arrivals(const PixelContext& c, int x, int y, std::vector<const Arrival*>& found) {
  const TileArrivals& t = *c.arrivals;
  const int reach = t.around;
  const int bx = (x - t.tile.x0) * kBinsPerPixel,
            by = (y - t.tile.y0) * kBinsPerPixel;  // of the pixel's corner, shifted
  const int edge = kBinsPerPixel + 2 * reach;
  found.clear();
  for (int row = by; row < by + edge; ++row) {
    const std::size_t first = std::size_t(row * t.bins + bx);
    for (std::uint32_t i = t.begin[first]; i < t.begin[first + std::size_t(edge)]; ++i) found.push_back(&t.sorted[i]);
  }
}

bool belongs(const Surface& s, const Arrival& a, const SurfaceTest& test) {
  return belongs(s.id, s.near, s.far, a, test);
}

/// Tells the surfaces apart. Where there is no depth to sort them by they count as one.
Surfaces find_surfaces(const PixelContext& c, const std::vector<const Arrival*>& found,
                       std::vector<std::uint8_t>& surface) {
  Surfaces s;
  surface.assign(found.size(), 0);
  if (!c.test.depths) {
    s.count = 1;
    s.list[0].count = int(found.size());
    return s;
  }
  int last = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Arrival& a = *found[i];
    int k = last;
    if (!(k < s.count && belongs(s.list[std::size_t(k)], a, c.test))) {
      k = 0;
      while (k < s.count && !belongs(s.list[std::size_t(k)], a, c.test)) ++k;
      if (k == s.count && s.count < kMaxSurfaces) s.list[std::size_t(s.count++)] = {a.id, a.depth, a.depth, 0, 0, 0, 0};
      if (k == kMaxSurfaces) k = kMaxSurfaces - 1;
    }
    Surface& to = s.list[std::size_t(k)];
    to.near = std::min(to.near, a.depth), to.far = std::max(to.far, a.depth);
    to.depth_sum += double(a.depth);
    ++to.count;
    surface[i] = std::uint8_t(k);
    last = k;
  }
  // Sorted by insertion: there are few.
  for (int k = 0; k < s.count; ++k) {
    int to = k;
    for (; to > 0 && s.list[std::size_t(k)].depth() < s.list[std::size_t(s.front_to_back[std::size_t(to - 1)])].depth();
         --to)
      s.front_to_back[std::size_t(to)] = s.front_to_back[std::size_t(to - 1)];
    s.front_to_back[std::size_t(to)] = k;
  }
  return s;
}

/// Brings the arrivals of each surface together, filled up to whole groups.
void order_by_surface(Surfaces& s, const PixelContext& c, int x, int y, PixelScratch& scratch) {
  int total = 0;
  for (int k = 0; k < s.count; ++k) {
    Surface& surface = s.list[std::size_t(k)];
    surface.begin = total;
    surface.padded = (surface.count + kCellLanes - 1) / kCellLanes * kCellLanes;
    total += surface.padded;
  }
  const auto size = std::size_t(total);
  scratch.ordered.assign(size, nullptr);
  scratch.x.assign(size, 0);
  scratch.y.assign(size, 0);
  scratch.weight.assign(size, 0);
  std::array<int, kMaxSurfaces> next{};
  for (int k = 0; k < s.count; ++k) next[std::size_t(k)] = s.list[std::size_t(k)].begin;
  const float mx = float(x - c.arrivals->tile.x0) + 0.5f, my = float(y - c.arrivals->tile.y0) + 0.5f;
  for (std::size_t i = 0; i < scratch.found.size(); ++i) {
    const Arrival* a = scratch.found[i];
    const auto at = std::size_t(next[scratch.surface[i]]++);
    scratch.ordered[at] = a;
    scratch.x[at] = a->x - mx;
    scratch.y[at] = a->y - my;
    scratch.weight[at] = a->weight;
  }
}

void weigh_light(const Surfaces& s, const PixelContext& c, PixelScratch& scratch) {
  scratch.scale.assign(scratch.ordered.size(), 1.0f);
  for (int k = 0; k < s.count; ++k) {
    const Surface& surface = s.list[std::size_t(k)];
    const auto begin = std::size_t(surface.begin);
    hold_fireflies({scratch.ordered.data() + begin, std::size_t(surface.count)}, c.firefly_limit,
                   scratch.scale.data() + begin, scratch.work);
    turn_down_changed({scratch.ordered.data() + begin, std::size_t(surface.count)}, c.present, c.samples,
                      c.change_limit, scratch.weight.data() + begin);
  }
}

void axis_weights(const Surface& surface, const PixelContext& c, PixelScratch& scratch) {
  const std::size_t size = scratch.ordered.size(), cells = std::size_t(c.axis.count);
  const auto begin = std::size_t(surface.begin), count = std::size_t(surface.padded);
  const auto stride = std::ptrdiff_t(size);
  float* weight = scratch.weight.data() + begin;
  lift_weights({weight, std::size_t(surface.count)});
  const float scale = gaussian_scale(c, {weight, count}, kColorSpacing,
                                     noise_share({scratch.ordered.data() + begin, std::size_t(surface.count)}));
  float *wx = scratch.wx.data() + begin, *wy = scratch.wy.data() + begin;
  c.kernel->axis_weights(scratch.x.data() + begin, surface.padded, c.axis.centers, c.axis.count, scale, wx, stride);
  c.kernel->axis_weights(scratch.y.data() + begin, surface.padded, c.axis.centers, c.axis.count, scale, wy, stride);
  for (std::size_t j = 0; j < cells; ++j)
    for (std::size_t i = 0; i < count; ++i) wy[j * size + i] *= weight[i];
}

/// Shares the area of the pixel among the surfaces, front to back, and that of each cell among the samples near it.
void share_cells(const Surfaces& s, const PixelContext& c, int x, int y, PixelScratch& scratch) {
  const int cells = c.axis.count;
  const std::size_t area = std::size_t(cells) * std::size_t(cells), size = scratch.ordered.size();
  scratch.sums.resize(area);
  scratch.share.resize(area);
  scratch.result.resize(size);
  scratch.through.assign(area, 1.0);
  for (int k = 0; k < s.count; ++k) {
    const Surface& surface = s.list[std::size_t(s.front_to_back[std::size_t(k)])];
    const auto begin = std::size_t(surface.begin);
    const bool last = k + 1 == s.count;
    if (!last) {
      const std::span<const Arrival* const> own(scratch.ordered.data() + begin, std::size_t(surface.count));
      measure_coverage(c, own, x, y, scratch);
    }
    c.kernel->cell_sums(scratch.wx.data() + begin, scratch.wy.data() + begin, std::ptrdiff_t(size), surface.padded,
                        cells, scratch.sums.data());
    for (std::size_t cell = 0; cell < area; ++cell) {
      const double covered =
          last ? 1.0 : double(scratch.hits[cell]) / (double(scratch.hits[cell]) + double(scratch.misses[cell]));
      const double filter = c.axis.share[cell / std::size_t(cells)] * c.axis.share[cell % std::size_t(cells)];
      scratch.share[cell] = float(filter * scratch.through[cell] * covered / double(scratch.sums[cell]));
      scratch.through[cell] *= 1 - covered;
    }
    c.kernel->sample_weights(scratch.wx.data() + begin, scratch.wy.data() + begin, std::ptrdiff_t(size), surface.padded,
                             cells, scratch.share.data(), scratch.result.data() + begin);
  }
}

}  // namespace

void lift_weights(std::span<float> weights) {
  const float most = weights.empty() ? 1 : *std::max_element(weights.begin(), weights.end());
  if (most > 0.5f) return;
  if (!(most > 0)) {
    std::fill(weights.begin(), weights.end(), 1.0f);
    return;
  }
  int exponent = 0;
  std::frexp(most, &exponent);
  for (float& weight : weights) weight = std::ldexp(weight, -exponent);
}

float gaussian_scale(const PixelContext& c, std::span<const float> weights, double spacing, double noise) {
  double sum = 0, squares = 0;
  for (const float w : weights) sum += double(w), squares += double(w) * double(w);
  const double edge = 2 * c.axis.radius + 2.0 / kBinsPerPixel;  // of the area that samples are taken from
  const double per_pixel = squares > 0 ? sum * sum / squares / (edge * edge) : 0;
  const double widened = c.sigma + std::max(kNoiseSigma - c.sigma, 0.0) * std::clamp(2.5 * (noise - 0.5), 0.0, 1.0);
  const double sigma = std::max(widened, spacing / std::sqrt(std::max(per_pixel, 0.25)));
  return float(0.5 / (sigma * sigma));
}

PixelWeights weigh_pixel(const PixelContext& c, int x, int y, PixelScratch& scratch) {
  find_arrivals(c, x, y, scratch.found);
  if (scratch.found.empty()) return {};
  Surfaces s = find_surfaces(c, scratch.found, scratch.surface);
  order_by_surface(s, c, x, y, scratch);
  weigh_light(s, c, scratch);
  scratch.wx.resize(scratch.ordered.size() * std::size_t(c.axis.count));
  scratch.wy.resize(scratch.wx.size());
  for (int k = 0; k < s.count; ++k) axis_weights(s.list[std::size_t(k)], c, scratch);
  share_cells(s, c, x, y, scratch);
  return {scratch.ordered, scratch.result, scratch.scale, s.count};
}

}  // namespace varve
