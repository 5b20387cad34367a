// Moments to pixels.
#pragma once

#include <cstdint>

#include "base/parallel.h"
#include "base/plane.h"
#include "synth/moment.h"
#include "synth/positions.h"

namespace varve::synth {

/// One sample in every pixel, all planes over the same window.
struct Picture {
  Plane<float> r, g, b, a, depth, backward_x, backward_y, forward_x, forward_y;
  Plane<std::uint32_t> id;
};

struct SampleSettings {
  glm::dvec2 jitter{0};   ///< sample position minus pixel center, pixels
  double noise = 0;       ///< deviation of a factor with mean 1 on the color, as path tracing has it
  std::uint64_t key = 0;  ///< of all chance in this sample
};

/// Samples every pixel of `window` at its center plus the jitter. The same for any number of workers.
Picture render_samples(const Moment& moment, const Window& window, const SampleSettings& settings, Workers& workers);

/// Color and alpha.
struct Truth {
  Plane<float> r, g, b, a;
};

/// n x n samples in every pixel, one at a random place in each cell of the filter's weight.
Truth render_stratified(const Moment& moment, const Window& window, int n, Filter filter, std::uint64_t key,
                        Workers& workers);

}  // namespace varve::synth
