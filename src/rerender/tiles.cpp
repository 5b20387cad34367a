#include "rerender/tiles.h"

#include <algorithm>
#include <queue>

namespace varve {
namespace {

constexpr double kShare = 0.05;  // of a tile's pixels, that say how many samples it may get

/// The largest step of whose samples at least `pixels` of the tile want more than half.
int steps_allowed(const std::vector<float>& wanted, std::size_t pixels, int most) {
  int allowed = 0;
  for (int step = 1; step < kMostSteps && samples_of_step(step) <= most; ++step) {
    const double half = samples_of_step(step) / 2.0;
    const auto want = std::count_if(wanted.begin(), wanted.end(), [&](float l) { return double(l) > half; });
    if (std::size_t(want) < std::max<std::size_t>(pixels, 1)) break;
    allowed = step;
  }
  return allowed;
}

Tile sum_tile(const Window& window, const Evaluation& e, const RerenderRequest& request) {
  Tile tile;
  tile.window = window;
  std::vector<float> all;
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      const double lacking = double(e.lacking.at(x, y)), variance = double(e.variance.at(x, y));
      tile.variance += variance;
      if (!(lacking > 0)) continue;
      // The frames that lent a pixel its n samples get further ones as well, mostly: m in each make it n (1 + m).
      const double wanted = lacking / std::max(1.0, double(e.count.at(x, y)));
      all.push_back(float(wanted));
      tile.lacking += lacking;
      ++(e.failed.at(x, y) ? tile.failed : tile.noisy);
      for (int step = 1; step < kMostSteps; ++step) {
        const double m = std::min(double(samples_of_step(step)), wanted);
        tile.gain[step] += variance * m / (1 + m);
      }
    }
  const auto pixels = request.budget > 0 ? 1 : std::size_t(kShare * double(window.pixels()) + 0.5);
  tile.steps = steps_allowed(all, pixels, request.most);
  return tile;
}

/// One step of one tile, the next one it could get.
struct Offer {
  double worth = 0;  // variance for a sample
  std::size_t frame = 0, tile = 0;
  bool operator<(const Offer& other) const {
    if (worth != other.worth) return worth < other.worth;
    return frame != other.frame ? frame > other.frame : tile > other.tile;
  }
};

double cost_of(const Tile& tile, int step) { return double(tile.window.pixels()) * samples_of_step(step); }

}  // namespace

TileFrame sum_tiles(int frame, const Evaluation& evaluation, const RerenderRequest& request) {
  const Window& w = evaluation.lacking.window();
  TileFrame out{frame, w, (w.width() + request.tile - 1) / request.tile, {}};
  for (int y = w.y0; y < w.y1; y += request.tile)
    for (int x = w.x0; x < w.x1; x += request.tile)
      out.tiles.push_back(
          sum_tile({x, y, std::min(x + request.tile, w.x1), std::min(y + request.tile, w.y1)}, evaluation, request));
  return out;
}

void spend_all(std::vector<TileFrame>& frames) {
  for (TileFrame& frame : frames)
    for (Tile& tile : frame.tiles) tile.step = tile.steps;
}

void spend(std::vector<TileFrame>& frames, double samples) {
  std::priority_queue<Offer> offers;
  const auto offer = [&](std::size_t f, std::size_t t) {
    const Tile& tile = frames[f].tiles[t];
    if (tile.step >= tile.steps) return;
    const double cost = cost_of(tile, tile.step + 1) - cost_of(tile, tile.step);
    const double worth = (tile.gain[tile.step + 1] - tile.gain[tile.step]) / cost;
    if (worth > 0) offers.push({worth, f, t});
  };
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t t = 0; t < frames[f].tiles.size(); ++t) {
      frames[f].tiles[t].step = 0;
      offer(f, t);
    }
  for (double left = samples; !offers.empty();) {
    const Offer best = offers.top();
    offers.pop();
    Tile& tile = frames[best.frame].tiles[best.tile];
    const double cost = cost_of(tile, tile.step + 1) - cost_of(tile, tile.step);
    if (cost > left) continue;  // a cheaper one may still fit
    left -= cost;
    ++tile.step;
    offer(best.frame, best.tile);
  }
}

}  // namespace varve
