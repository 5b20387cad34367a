// What further samples would gain in each tile of a frame, and how many each is to get.
#pragma once

#include <cstddef>
#include <vector>

#include "base/window.h"
#include "rerender/evaluation.h"

namespace varve {

/// Numbers of samples that a tile can get: 0, 1, 2, 4, ... Few steps, so that neighbors are often alike.
inline constexpr int kMostSteps = 13;
inline int samples_of_step(int step) { return step == 0 ? 0 : 1 << (step - 1); }

struct Tile {
  Window window;
  int steps = 0;                 ///< the most it may get
  double gain[kMostSteps] = {};  ///< by step: the variance that is taken away, summed over its pixels that lack samples
  double lacking = 0;            ///< samples, summed
  double variance = 0;           ///< expected, summed over all its pixels
  std::size_t failed = 0,
              noisy = 0;  ///< pixels that lack samples: because reconstruction failed, or for another reason
  int step = 0;           ///< what it gets
};

/// Of one frame, row by row.
struct TileFrame {
  int frame = 0;
  Window window;
  int columns = 0;
  std::vector<Tile> tiles;
};

/// Sums an evaluation up. A pixel has its n effective samples from as many frames, more or less, and what is rendered
/// again in one of them is in the others, mostly: measured on the courtyard, that tells where samples gain better than
/// taking each frame for itself. So m samples more leave 1 / (1 + m) of its variance, and it wants its lacking samples
/// over n; more than that are not counted. A tile may get as many as a twentieth of its pixels want, with a budget as
/// many as any of them does.
TileFrame sum_tiles(int frame, const Evaluation& evaluation, const RerenderRequest& request);

/// Sets the step of every tile: without a budget the most, with one the steps that take away the most variance for a
/// sample, over all frames, as long as the budget reaches; of equal ones the earlier. `samples`: the budget.
void spend(std::vector<TileFrame>& frames, double samples);
void spend_all(std::vector<TileFrame>& frames);

}  // namespace varve
