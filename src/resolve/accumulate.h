// The recursive accumulator: one frame back, rectified by the neighborhood of the present.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"
#include "resolve/choices.h"
#include "resolve/present.h"

namespace varve {

/// Exponential history. Sources: Yang 2009 slide 9, Salvi 2016.
struct RecursiveParameters {
  double alpha = 0.1;  ///< weight of the present in the steady state, (0, 1]
  AlphaRule alpha_rule = AlphaRule::mean;
  HistoryFilter history_filter = HistoryFilter::catmull_rom;
  double cubic_b = 0, cubic_c = 0.5;  ///< of HistoryFilter::cubic; see is_expansive(cubic_gain())
  bool dering = true;                 ///< hold what a filter reads between the pixels that count positively
  Disocclusion disocclusion = Disocclusion::window;
  double depth_tolerance = 0.05;                    ///< relative difference of depth that still is the same surface
  Unjitter unjitter = Unjitter::none;               ///< fetch the present at pixel centers; not with a sample filter
  SampleFilter sample_filter = SampleFilter::none;  ///< reconstruct the present from true sample positions
};

/// What history may say. Sources: Salvi 2016 (variance clipping), Pedersen 2016, Lopez.
struct RectifyParameters {
  Box box = Box::variance;
  double gamma = 1.0;  ///< half size of the variance box in standard deviations
  int window = 3;      ///< edge of the neighborhood: 3, 5 or 7
  BoxRule rule = BoxRule::clip;
  BoxAnchor anchor = BoxAnchor::present;  ///< clip towards the present (held inside the box) or the mean
  BoxSpace space = BoxSpace::rgb;
};

/// What one frame leaves to the next. Made only by accumulate(); empty before the first frame and after a cut.
struct History {
  Plane<glm::vec4> color;  ///< resolved RGBA, float, no border
  Plane<float> total;      ///< sum of sample weights so far; 0: no valid data
  Plane<float> spread;     ///< sum of squared normalized weights; 1/spread is the effective sample count
  Plane<float> depth;      ///< of the frame it was made from; empty without the depth test
  std::vector<std::uint8_t> rows_valid;

  bool empty() const { return color.empty(); }
};

/// Diagnostic planes of one frame; those not asked for are empty.
struct AccumulateDiagnostics {
  Plane<float> clip, weight;
  Plane<std::uint32_t> reject;
};

struct DiagnosticsWanted {
  bool clip = false, weight = false, reject = false;
};

struct AccumulateCounts {
  std::size_t restarted = 0;    ///< pixels without usable history
  std::size_t clipped = 0;      ///< pixels whose history was moved
  std::size_t vectors_bad = 0;  ///< of the restarted: because of their vector
};

struct Accumulated {
  History history;  ///< its color is the resolved frame
  AccumulateDiagnostics diagnostics;
  AccumulateCounts counts;
};

/// Kernel to run. Both give the same bits; `automatic` takes the fastest the processor has.
enum class Isa { automatic, baseline, avx2 };

/// One frame: fetch the history along the motion, rectify, blend. Works on present.color.window(); the history may have
/// another window. `jitter` (sample position minus pixel centre) is needed for a sample filter or to undo it, and
/// ignored otherwise. Reads: window/2 pixels around each pixel of the present (2 with a sample filter), 2 around the
/// previous position (3 with bspline5; B-spline coefficients fade by a factor of 2.3 and more from pixel to pixel).
/// `restart_bit` is noted in the reject plane where there is no history at all.
Accumulated accumulate(const Present& present, const History& previous, const RecursiveParameters& recursive,
                       const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, std::uint32_t restart_bit,
                       const DiagnosticsWanted& wanted, Workers& workers, Isa isa = Isa::automatic);

/// What the frames before say of the present: the history as accumulate() would fetch it, rectified by the neighborhood
/// without the pixel itself and towards its mean. color is 0 and total 0 where there is no history.
/// The sample of the pixel has no part in it, but its neighbors do, and a jittered frame shifts all its samples alike:
/// the difference to the sample favors tight boxes. For ranking settings see diagnose/leave_out.h.
History predict(const Present& present, const History& previous, const RecursiveParameters& recursive,
                const RectifyParameters& rectify, Workers& workers);

}  // namespace varve
