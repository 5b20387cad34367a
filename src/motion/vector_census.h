// What stored vectors look like before anybody reads them: at rest everywhere, constant, clamped, weighed by alpha,
// mixed at edges.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "base/plane.h"

namespace varve {

/// One end of the values of a channel.
struct Pile {
  double value = 0;
  std::size_t at = 0;      ///< pixels that hold exactly this value
  std::size_t beside = 0;  ///< pixels within the last hundredth of the range before it
  std::size_t others = 0;  ///< different values that the other channel has among them, 32 at most
};

/// Counts over frames of two channels that belong together.
struct VectorCensus {
  std::size_t pixels = 0, not_finite = 0;
  std::size_t zero = 0;  ///< both channels 0
  std::array<double, 2> least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::array<double, 2> greatest{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  std::array<std::array<Pile, 2>, 2> piles{};  ///< of each channel: at the least, at the greatest
  std::size_t frames = 0;
  // Partly covered pixels beside covered ones: the vector is the neighbor's times alpha, or the neighbor's.
  std::size_t weighed_by_alpha = 0, not_weighed = 0;
  // Steps between two flat sides: with values in between, or sharp.
  std::size_t mixed_edges = 0, sharp_edges = 0;

  bool all_zero() const { return pixels > 0 && zero + not_finite == pixels; }
  bool constant(int channel) const;
  /// A pile at an end that smooth motion does not make: four times as many pixels as in the hundredth before it, and
  /// other values of the other channel in it, so that it is no flat thing that slides.
  bool clamped(int channel) const;
  bool premultiplied() const { return weighed_by_alpha >= 24 && weighed_by_alpha > 3 * not_weighed; }
  bool antialiased() const { return mixed_edges >= 40 && 3 * mixed_edges > sharp_edges; }
};

/// Adds a frame. Both channels over one window; `alpha` may be empty, else it covers the same window.
void add_frame(VectorCensus& census, const Plane<float>& x, const Plane<float>& y, const Plane<float>& alpha);

}  // namespace varve
