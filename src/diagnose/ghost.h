// How much of an old picture stays in a new one, and for how long.
#pragma once

#include <cstdint>
#include <span>

#include "diagnose/color_pair.h"

namespace varve {

/// Least squares share of a stale picture h in the test o against the reference r:
/// sum w (o - r)(h - r) / sum w (h - r)^2 over R, G, B, w = 1 / (1 + max(|r|, |h|))^2. 0: none of it; 1: nothing else.
struct Ghost {
  double product = 0, squares = 0;
  Ghost& operator+=(const Ghost& more) {
    product += more.product;
    squares += more.squares;
    return *this;
  }
  /// NaN when the stale picture is the reference itself: nothing moved.
  double coefficient() const;
};

/// `stale`: the reference of an earlier frame, fetched without motion. Pixels outside its window, or bad in either
/// frame (`stale_bad`, may be empty), take no part.
Ghost ghost_of(const ColorPair& now, const Plane<glm::vec4>& stale, const Plane<std::uint8_t>& stale_bad,
               Workers& workers);

/// What the shares of the picture before a cut say, one for each frame from the cut on.
struct Lag {
  double mean_age = 0;   ///< frames: sum of the shares, and of their continuation beyond the last; 9 for an
                         ///< exponential average with alpha 0.1
  double half_life = 0;  ///< frames until half is left: ln 0.5 / ln q, q the share that stays from frame to frame
};

/// NaN in both without at least two finite shares. A share that does not decay has an endless lag.
Lag lag_of(std::span<const double> shares);

}  // namespace varve
