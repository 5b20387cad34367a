// The two-sided accumulator: what the frames before say and what the frames after say, each carried and rectified on
// its own, merged with the present counted once. In the steady state this is the Rauch-Tung-Striebel smoother of a
// random walk (Fraser and Potter 1969), and twice the effective samples of one side without its lag.
#pragma once

#include <cstdint>
#include <optional>

#include "resolve/accumulate.h"

namespace varve {

struct TwoSidedParameters {
  int look_ahead = 0;  ///< frames; 0: as many as hold 99 % of a side's weight
  double return_tolerance =
      0.5;  ///< px, besides a hundredth of the lengths: how far there and back may miss; 0: no test
};

/// Frames that a side reaches at least: those that hold 99 % of its weight, ln(.01) / ln(1 - alpha), or what was asked.
int look_ahead_frames(const TwoSidedParameters& two_sided, double alpha);

/// Weight left to a side of weight `total` that was moved by d into the box, given d^2 / r, r the local variance of one
/// sample: W / (1 + W d^2 / r), for the variance r / W it had, and the bias d it showed.
/// RectifyParameters::clip_discount asks for it.
double discounted_weight(double total, double d2_over_r);

/// What one side of time says of a frame, its present left out; where it says nothing, total is 0.
struct StrictSide {
  Plane<glm::vec4> color;
  Plane<float> total;           ///< weight, in samples, after the discount
  Plane<float> spread;          ///< sum of squared normalized weights
  Plane<std::uint32_t> reject;  ///< if wanted
  Plane<float> clip;            ///< if wanted
  AccumulateCounts counts;
};

/// One step of one side.
struct SideStep {
  History state;  ///< to be fetched by the frame beyond; its total is already faded by 1 - alpha
  StrictSide strict;
};

/// One frame along one side of time. present.motion and .depth lead to the frame that `beyond` was made from: the frame
/// before on the way through the past, the frame after on the way back. The side weighs its samples by (1 - alpha)^k
/// under AlphaRule::fixed; equally, up to the weight that alpha leaves to history, under AlphaRule::mean.
SideStep accumulate_side(const Present& present, const History& beyond, const RecursiveParameters& recursive,
                         const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, std::uint32_t restart_bit,
                         const DiagnosticsWanted& wanted, Workers& workers, Isa isa = Isa::automatic);

/// The same step, its strict side merged with that of the other side and with the present:
/// (W1 c1 + w s + W2 c2) / (W1 + w + W2). Swapping the sides gives the same bits. `other` is the future where
/// diagnostics tell the sides apart.
struct MergedStep {
  History state;
  Accumulated resolved;  ///< its history is the result: color, total and spread of both sides and the present
};
MergedStep accumulate_both(const Present& present, const History& beyond, const StrictSide& other,
                           const RecursiveParameters& recursive, const RectifyParameters& rectify,
                           std::optional<glm::dvec2> jitter, std::uint32_t restart_bit, const DiagnosticsWanted& wanted,
                           Workers& workers, Isa isa = Isa::automatic);

}  // namespace varve
