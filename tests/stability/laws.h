// The laws that are asked of a pass; each says what breaks it, or nothing.
#pragma once

#include <string>

#include "stability/passes.h"

namespace varve::stability {

/// Counts what was run, for the report.
struct LawCounts {
  long runs = 0;    ///< a pass over a shot
  long pixels = 0;  ///< that were looked at
};

/// Every value is finite.
std::string broken_finite(const Pass& pass, const RawShot& shot, Workers& workers, LawCounts& counts);

/// A changed pixel changes nothing outside of what the pass reads: NaN, infinities, 65504 and 1e30 in one pixel of one
/// frame of a shot at rest, or, with `moves`, of one that moves by less than a pixel a frame. The rest has the same
/// bits.
std::string broken_footprint(const Pass& pass, bool moves, Workers& workers, LawCounts& counts);

/// 2^k times the light is 2^k times the result, bit for bit.
std::string broken_scale(const Pass& pass, int exponent, Workers& workers, LawCounts& counts);

/// What a mirror shows is resolved to what the mirror shows of the result.
std::string broken_mirror(const Pass& pass, bool vertical, Workers& workers, LawCounts& counts);

/// One color everywhere stays that color, whatever moves.
std::string broken_constancy(const Pass& pass, const glm::vec4& color, Workers& workers, LawCounts& counts);

/// Any number of threads gives the same bytes.
std::string broken_threads(const Pass& pass, LawCounts& counts);

}  // namespace varve::stability
