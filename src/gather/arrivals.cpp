#include "gather/arrivals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gather/shading_gain.h"

namespace varve {
namespace {

/// Tiles that a block's samples fall on.
struct TileSpan {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half open
  bool wide() const { return x1 > x0 && y1 > y0 && std::int64_t(x1 - x0) * (y1 - y0) > kWide; }
  static constexpr int kWide = 64;  // tiles
};

/// Tiles around samples that lie, without the jitter, between these positions.
TileSpan tiles_around(const GatherSource& source, const TileGrid& grid, double low_x, double low_y, double high_x,
                      double high_y) {
  const double ox = 0.5 + source.jitter.x - grid.window.x0, oy = 0.5 + source.jitter.y - grid.window.y0;
  const auto tile = [&](double at, int count) { return int(std::clamp(std::floor(at / kTile), -1.0, double(count))); };
  const int columns = grid.columns(), rows = grid.rows();
  TileSpan s{tile(low_x + ox - grid.margin, columns), tile(low_y + oy - grid.margin, rows),
             tile(high_x + ox + grid.margin, columns) + 1, tile(high_y + oy + grid.margin, rows) + 1};
  s.x0 = std::max(s.x0, 0), s.y0 = std::max(s.y0, 0);
  s.x1 = std::min(s.x1, columns), s.y1 = std::min(s.y1, rows);
  return s;
}

/// Calls use(x, y) with the position, without the jitter, of each sample of a block that could be followed; for none of
/// a frame that repeats another.
template <class Use>
void for_each_landing(const GatherSource& source, const Carried& field, int bx, int by, const Use& use) {
  if (source.repeats) return;
  const Window& w = source.window();
  const int x1 = std::min(w.x0 + (bx + 1) * kTile, w.x1), y1 = std::min(w.y0 + (by + 1) * kTile, w.y1);
  for (int y = w.y0 + by * kTile; y < y1; ++y)
    for (int x = w.x0 + bx * kTile; x < x1; ++x) {
      const glm::vec3& d = field.at(x, y);
      if (d.x == d.x) use(x + double(d.x), y + double(d.y));
    }
}

TileSpan tiles_of_block(const GatherSource& source, const Carried& field, const TileGrid& grid, int bx, int by) {
  double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
  for_each_landing(source, field, bx, by, [&](double x, double y) {
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  });
  if (!(low_x <= high_x)) return {};
  return tiles_around(source, grid, low_x, low_y, high_x, high_y);
}

/// The same sample by sample, as places in the grid: where vectors are noise the span is the whole picture, and lists
/// of spans would grow with its square.
void scattered_tiles(const GatherSource& source, const Carried& field, const TileGrid& grid, int bx, int by,
                     std::vector<std::size_t>& tiles) {
  tiles.clear();
  for_each_landing(source, field, bx, by, [&](double x, double y) {
    const TileSpan s = tiles_around(source, grid, x, y, x, y);
    for (int row = s.y0; row < s.y1; ++row)
      for (int column = s.x0; column < s.x1; ++column) tiles.push_back(std::size_t(row * grid.columns() + column));
  });
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
}

/// Adds what arrives in the tile of `out` from a block of source `f` whose first pixel is (x0, y0). `target` is the
/// sample in the resolved frame whose light it is held against; none where that is its own frame.
void collect_block(std::span<const GatherSource> sources, const GatherSource* target, std::size_t f,
                   const Carried& carried, int x0, int y0, const LightRule& light, const SurfaceTest& test,
                   TileArrivals& out) {
  const GatherSource& source = sources[f];
  const Window& w = source.window();
  const double ox = 0.5 + source.jitter.x - out.tile.x0, oy = 0.5 + source.jitter.y - out.tile.y0;
  const float low = -float(out.around) / kBinsPerPixel, high = float(kTile) - low;
  constexpr float most = std::numeric_limits<float>::max();
  const bool lit = light.gain && target;
  const int x1 = std::min(x0 + kTile, w.x1), y1 = std::min(y0 + kTile, w.y1);
  for (int y = y0; y < y1; ++y) {
    const glm::vec3* field = carried.row(y) - w.x0;
    const float* valid = source.present->valid.row(y) - w.x0;
    const glm::vec4* color = source.present->color.row(y) - w.x0;
    const SurfaceRow surfaces(*source.present, y);
    for (int x = x0; x < x1; ++x) {
      const float ax = float(x + double(field[x].x) + ox), ay = float(y + double(field[x].y) + oy);
      if (!(ax >= low && ay >= low && ax < high && ay < high && valid[x] > 0)) continue;
      Arrival a{.x = ax,
                .y = ay,
                .depth = field[x].z,
                .gain = 1,
                .weight = 1,
                .light = float(luminance(color[x])),
                .id = surfaces[x].id,
                .pixel = std::uint32_t(y - w.y0) << 16 | std::uint32_t(x - w.x0),
                .source = std::uint32_t(f)};
      if (lit) {
        const glm::dvec2 at = glm::dvec2(double(ax), double(ay)) + glm::dvec2(out.tile.x0, out.tile.y0);
        const ShadingGain g =
            shading_gain(source, x, y, *target, at, {a.id, a.depth}, test, light.dead_zone, light.weight);
        a.gain = g.gain, a.weight = g.weight;
        a.light = std::clamp(a.light * g.gain, -most, most);  // statistics of infinities are no numbers
      }
      out.unsorted.push_back(a);
      out.bin_of.push_back(std::uint32_t(int((ay - low) * kBinsPerPixel) * out.bins + int((ax - low) * kBinsPerPixel)));
    }
  }
}

/// Sorts by bin, keeping the order of arrival within a bin.
void sort_into_bins(TileArrivals& t) {
  const std::size_t bins = std::size_t(t.bins) * std::size_t(t.bins);
  t.begin.assign(bins + 1, 0);
  for (const std::uint32_t bin : t.bin_of) ++t.begin[bin + 1];
  for (std::size_t i = 1; i <= bins; ++i) t.begin[i] += t.begin[i - 1];
  t.sorted.resize(t.unsorted.size());
  std::vector<std::uint32_t> next(t.begin.begin(), t.begin.end() - 1);
  for (std::size_t i = 0; i < t.unsorted.size(); ++i) t.sorted[next[t.bin_of[i]]++] = t.unsorted[i];
}

constexpr std::size_t kMaxTileSurfaces = 16;

/// Tells the surfaces of a tile apart and fits how each moved. Most tiles show one, and need no fit.
void fit_surfaces(TileArrivals& t, std::span<const GatherSource> sources, const SurfaceTest& test) {
  t.surfaces.clear();
  if (!test.depths) return;
  std::vector<std::uint8_t>& of = t.surface_of;
  of.assign(t.sorted.size(), 0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < t.sorted.size(); ++i) {
    const Arrival& a = t.sorted[i];
    const auto fits = [&](std::size_t k) {
      return belongs(t.surfaces[k].id, t.surfaces[k].near, t.surfaces[k].far, a, test);
    };
    std::size_t k = last;
    if (!(k < t.surfaces.size() && fits(k))) {
      k = 0;
      while (k < t.surfaces.size() && !fits(k)) ++k;
    }
    if (k == t.surfaces.size()) {
      if (k == kMaxTileSurfaces)
        --k;
      else
        t.surfaces.push_back({a.id, a.depth, a.depth, {}});
    }
    TileSurface& s = t.surfaces[k];
    s.near = std::min(s.near, a.depth), s.far = std::max(s.far, a.depth);
    of[i] = std::uint8_t(k);
    last = k;
  }
  if (t.surfaces.size() < 2) return t.surfaces.clear();
  const std::size_t samples = samples_of(sources);
  for (TileSurface& s : t.surfaces) s.motion.resize(sources.size() / samples);
  for (std::size_t i = 0; i < t.sorted.size(); ++i) {
    const Arrival& a = t.sorted[i];
    const GatherSource& source = sources[a.source];
    const Window& w = source.window();
    const int x = w.x0 + int(a.pixel & 0xFFFF), y = w.y0 + int(a.pixel >> 16);
    const glm::dvec2 moved = glm::dvec2(double(a.x) + t.tile.x0, double(a.y) + t.tile.y0) - source.position(x, y);
    t.surfaces[of[i]].motion[frame_of(a, samples)].add(glm::dvec2(double(a.x), double(a.y)) - glm::dvec2(kTile / 2), 1,
                                                       {moved, double(source.present->depth.at(x, y))});
  }
}

}  // namespace

BlockLists list_blocks(const GatherSource& source, const Carried& field, const TileGrid& grid) {
  const Window& w = source.window();
  const int columns = (w.width() + kTile - 1) / kTile, rows = (w.height() + kTile - 1) / kTile;
  std::vector<TileSpan> spans;
  for (int by = 0; by < rows; ++by)
    for (int bx = 0; bx < columns; ++bx) spans.push_back(tiles_of_block(source, field, grid, bx, by));
  BlockLists lists;
  const int tiles = grid.columns();
  std::vector<std::size_t> scattered;
  const auto each = [&](auto&& use) {
    for (std::size_t block = 0; block < spans.size(); ++block) {
      const TileSpan& span = spans[block];
      if (span.wide()) {
        scattered_tiles(source, field, grid, int(block) % columns, int(block) / columns, scattered);
        for (const std::size_t tile : scattered) use(block, tile);
        continue;
      }
      for (int y = span.y0; y < span.y1; ++y)
        for (int x = span.x0; x < span.x1; ++x) use(block, std::size_t(y * tiles + x));
    }
  };
  lists.begin.assign(std::size_t(tiles * grid.rows()) + 1, 0);
  each([&](std::size_t, std::size_t tile) { ++lists.begin[tile + 1]; });
  for (std::size_t i = 1; i < lists.begin.size(); ++i) lists.begin[i] += lists.begin[i - 1];
  lists.blocks.resize(lists.begin.back());
  std::vector<std::uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  each([&](std::size_t block, std::size_t tile) {
    lists.blocks[next[tile]++] =
        std::uint32_t(block / std::size_t(columns)) << 16 | std::uint32_t(block % std::size_t(columns));
  });
  return lists;
}

void collect_arrivals(const TileGrid& grid, int column, int row, std::span<const GatherSource> sources,
                      std::size_t present, std::span<const Carried> fields, std::span<const BlockLists> lists,
                      const LightRule& light, const SurfaceTest& test, TileArrivals& out) {
  const Window& target = grid.window;
  out.tile = {target.x0 + column * kTile, target.y0 + row * kTile,
              std::min(target.x0 + (column + 1) * kTile, target.x1),
              std::min(target.y0 + (row + 1) * kTile, target.y1)};
  out.around = int(std::ceil(grid.margin * kBinsPerPixel));
  out.bins = kTile * kBinsPerPixel + 2 * out.around;
  out.unsorted.clear();
  out.bin_of.clear();
  const std::size_t tile = std::size_t(row * grid.columns() + column);
  const std::size_t samples = samples_of(sources);
  for (std::size_t f = 0; f < sources.size(); ++f) {
    const Window& w = sources[f].window();
    const GatherSource* own = &sources[present * samples + (sources[f].whole ? sources[f].sample : 0)];
    if (!own->whole) own = &sources[present * samples];
    if (f / samples == present) own = nullptr;
    for (std::uint32_t b = lists[f].begin[tile]; b < lists[f].begin[tile + 1]; ++b)
      collect_block(sources, own, f, fields[f], w.x0 + int(lists[f].blocks[b] & 0xFFFF) * kTile,
                    w.y0 + int(lists[f].blocks[b] >> 16) * kTile, light, test, out);
  }
  sort_into_bins(out);
  fit_surfaces(out, sources, test);
}

}  // namespace varve
