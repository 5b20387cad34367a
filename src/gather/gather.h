// The gather accumulator: every sample of the frames around is carried to the resolved frame along its own motion and
// used once, at its true position. No frame is resampled on the way, and each result depends on a finite window only.
#pragma once

#include <span>

#include "gather/source.h"
#include "resolve/accumulate.h"
#include "resolve/choices.h"

namespace varve {

/// Most frames in one window of frames: the one that is resolved and kMostReach on each side.
inline constexpr int kMostReach = 256;
inline constexpr int kMostGathered = 2 * kMostReach + 1;

struct GatherParameters {
  int reach = 16;       ///< frames on each side, up to kMostReach
  int cells = 4;        ///< on a pixel's edge, 1 to 8
  double sigma = 0.09;  ///< of the Gaussian around a cell's middle, pixels; widened where samples are few
  SampleFilter filter = SampleFilter::none;  ///< the filter of the output; none: a box of one pixel
  double return_tolerance = 0;   ///< px, besides a hundredth of the way: how far there and back may miss; 0: no test
  double change_limit = 3;       ///< standard errors by which the light of other frames may differ; 0: any
  double firefly_limit = 0;      ///< deviations beyond the median from which on a sample is held back; 0: never
  bool gain = true;              ///< follow changes of light that the vectors do not know
  int gain_window = 15;          ///< edge of the window that light is measured in, odd
  double gain_dead_zone = 0.10;  ///< relative change of light that noise alone may make
  double gain_weight = 0.05;     ///< change of light (as a logarithm) at which a frame counts half
};

/// Frames that the result of one frame is made from, on each side: with a gain, the pilots of the outermost need one
/// more.
inline int gather_reach(const GatherParameters& parameters) { return parameters.reach + (parameters.gain ? 1 : 0); }

/// Surfaces can be told apart by what the files have.
SurfaceTest surface_test(const Present& present);

/// Resolves frame `present` of the window; `sources` are consecutive frames of one shot, at most kMostGathered, frame
/// after frame, with as many samples each. Every sample follows the sample of its number from frame to frame; those of
/// all numbers meet in the pixel.
Accumulated gather(std::span<const GatherSource> sources, std::size_t present, const GatherParameters& parameters,
                   const SurfaceTest& test, const DiagnosticsWanted& wanted, Workers& workers,
                   Isa isa = Isa::automatic);

}  // namespace varve
