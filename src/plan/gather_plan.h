// What the plan says of the gather.
#pragma once

#include <vector>

#include "plan/plan.h"

namespace varve {

/// Passes of the gather in running order; sets what it reads. Where something is missing that it could use, the reason
/// says what it does instead, and a note what that costs. Throws Failure(inconsistent) for what cannot be done.
std::vector<PlannedPass> gather_passes(const SequenceInfo& info, const Parameters& parameters, Plan& plan);

/// Memory that a pixel of a subject takes in the window of frames, and while it is resolved.
std::size_t gather_bytes_per_pixel(const Parameters& parameters);

/// Nanoseconds per pixel, one thread.
double gather_nanoseconds(const Parameters& parameters);

}  // namespace varve
