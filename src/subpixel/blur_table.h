// The blur of four histories under steady motion, simulated and tabulated as in Yang et al. 2009 (slide 17): there is
// no closed form, but the moments of the kernels obey a linear recursion, which four equations solve.
#pragma once

#include <array>
#include <functional>

#include <glm/vec2.hpp>

#include "subpixel/subpixel_history.h"
#include "subpixel/tent_weights.h"

namespace varve {

/// Fills the weights of samples around a place: weigh_samples_around() or weigh_samples_once() with their parameters.
using WeighSamples = std::function<bool(TentSamples&)>;

/// Kernel of each history when the quarters are visited in turn, always with the same weight of the present.
struct SteadyKernels {
  std::array<glm::dvec2, kQuadrants> mean;    ///< px, around the middle of the quarter
  std::array<glm::dvec2, kQuadrants> second;  ///< raw second moment per axis, px^2, just after its sample was added
};

/// `velocity` in pixels a frame, alpha in (0, 1]. Samples lie anywhere in their quarter (variance 1/48 px^2).
SteadyKernels steady_kernels(const glm::dvec2& velocity, double alpha, const WeighSamples& weigh);

/// The largest of the four second moments, mean of both axes, px^2.
double largest_moment(const SteadyKernels& kernels);

/// Second moment of the picture: the mean of the quarters as they are before their next sample, around the pixel
/// center.
double picture_moment(const SteadyKernels& kernels, double alpha);

/// The least alpha, from 0.001 to 1, at which `moment(alpha)` is no more than `limit`; by 30 bisections.
double least_alpha(double limit, const std::function<double(double alpha)>& moment);

/// least_alpha() of the picture over velocities from 0 to 1/2 px a frame; beyond that they repeat, mirrored.
struct BlurTable {
  static constexpr int kSteps = 17;                      ///< of each axis
  std::array<std::array<double, kSteps>, kSteps> alpha;  ///< [y][x]

  /// The largest of the four entries around: the blur has spikes where the grids of samples coincide. 0 for a velocity
  /// that is not a number.
  double at(const glm::dvec2& velocity) const;
};

BlurTable tabulate_blur(double limit, const WeighSamples& weigh);

}  // namespace varve
