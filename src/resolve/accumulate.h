// The recursive accumulator: one frame back, rectified by the neighborhood of the present.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"
#include "base/reject.h"
#include "resolve/choices.h"
#include "resolve/present.h"
#include "resolve/reject.h"

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
  RejectParameters reject;
  WeightParameters weight;
};

/// What history may say. Sources: Salvi 2016 (variance clipping), Pedersen 2016, Lopez.
struct RectifyParameters {
  Box box = Box::variance;
  double gamma = 1.0;  ///< half size of the variance box in standard deviations
  int window = 3;      ///< edge of the neighborhood, odd, 3 to 63
  WindowMoments moments = WindowMoments::direct;
  BoxRule rule = BoxRule::clip;
  BoxAnchor anchor = BoxAnchor::present;  ///< where rule clip leads; held inside the box
  BoxSpace space = BoxSpace::rgb;
  int hull_passes = 64;        ///< cap on the refinements of the exact hull, at least 1
  bool clip_discount = false;  ///< history that had to be moved weighs less
};

/// Why these choices do not go together, with the remedy; empty when they do. `weight_by_age`: a history counts as many
/// samples only under AlphaRule::mean.
std::string conflict(const RectifyParameters& rectify, const RecursiveParameters& recursive, bool weight_by_age = true);

/// What one frame leaves to the next. Made only by accumulate(); empty before the first frame and after a cut.
struct History {
  Plane<glm::vec4> color;                    ///< resolved RGBA, float, no border
  std::vector<Plane<glm::vec4>> companions;  ///< resolved, in the order of Present::companions
  Plane<float> total;                        ///< sum of sample weights so far; 0: no valid data
  Plane<float> spread;  ///< sum of squared normalized weights; 1/spread is the effective sample count
  /// What rounding took from color; empty unless keeps_remainder() (resolve/remainder.h).
  Plane<glm::vec4> remainder;
  // Of the frame it was made from; each empty unless a test needs it.
  Plane<float> depth;
  Plane<glm::vec2> motion;
  Plane<std::uint32_t> id;
  Plane<glm::vec3> normal;
  std::vector<std::uint8_t> rows_valid;

  bool empty() const { return color.empty(); }
};

/// Diagnostic planes of one frame; those not asked for are empty.
struct AccumulateDiagnostics {
  Plane<float> clip, weight;
  Plane<std::uint32_t> reject;
  // Only of accumulators that look ahead; `reject` is then that of the past.
  Plane<float> count_past, count_future;
  Plane<std::uint32_t> reject_future;
  Plane<float> variance, frames, surfaces, gain, removed, round_trip;  // only of the gather
};

struct AccumulateView;  // resolve/accumulate_row.h
struct RowScratch;

struct DiagnosticsWanted {
  bool clip = false, weight = false, reject = false, counts = false;
  bool gather = false;  ///< what only the gather fills
};

struct AccumulateCounts {
  std::size_t restarted = 0;                        ///< pixels without usable history
  std::size_t clipped = 0;                          ///< pixels whose history was moved
  std::size_t vectors_bad = 0;                      ///< of the restarted: because of their vector
  std::array<std::size_t, kRejectBits> rejected{};  ///< pixels with each bit of the plane `reject`
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
/// Companions of the present are resolved along (resolve/accumulate_companions.h).
/// `restart_bit` is noted in the reject plane where there is no history at all.
Accumulated accumulate(const Present& present, const History& previous, const RecursiveParameters& recursive,
                       const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, std::uint32_t restart_bit,
                       const DiagnosticsWanted& wanted, Workers& workers, Isa isa = Isa::automatic);

/// What the frames before say of the present: the history as accumulate() would fetch it, rectified by the neighborhood
/// without the pixel itself and towards its mean. color is 0 and total 0 where there is no history. Gaussian and
/// pyramid moments are taken as those of the plain window.
/// The sample of the pixel has no part in it, but its neighbors do, and a jittered frame shifts all its samples alike:
/// the difference to the sample favors tight boxes. For ranking settings see diagnose/leave_out.h.
History predict(const Present& present, const History& previous, const RecursiveParameters& recursive,
                const RectifyParameters& rectify, Workers& workers);

/// Keeps of the present what the tests of the next frame compare with.
void remember_surfaces(History& history, const Present& present, const RecursiveParameters& recursive);

/// What a caller does with one row, in place of the blend. `worker` names scratch space that no other row uses
/// meanwhile.
using RowPass = std::function<void(const AccumulateView& view, int y, const RowScratch& scratch, int worker)>;

/// The history as accumulate() fetches and rectifies it, row by row, for accumulators that blend by rules of their own:
/// `fetched` sees each row before rectification, `rectified` after it. The view has the present, and of the outputs
/// only the planes of `diagnostics` that are wanted; of these `clip` is filled here. The tests of RejectParameters have
/// been made, and the weight of the history is that of its trust; WeightParameters have no say. Counts: only `clipped`
/// and `rejected`.
AccumulateCounts visit_history(const Present& present, const History& previous, const RecursiveParameters& recursive,
                               const RectifyParameters& rectify, std::optional<glm::dvec2> jitter,
                               std::uint32_t restart_bit, const DiagnosticsWanted& wanted,
                               AccumulateDiagnostics& diagnostics, const RowPass& fetched, const RowPass& rectified,
                               Workers& workers, Isa isa = Isa::automatic);

}  // namespace varve
