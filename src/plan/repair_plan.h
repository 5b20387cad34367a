// Whether vectors are tested and repaired, and by what.
#pragma once

#include "plan/plan.h"

namespace varve {

/// The pass, and in `plan` the channels that it needs. Called when the plan knows whether there are vectors.
PlannedPass repair_pass(const SequenceInfo& info, const Parameters& parameters, Plan& plan);

/// Whether every subject has vectors and depth, and a camera is known: what rests can be told by it.
bool repair_uses_cameras(const SequenceInfo& info);

/// Bytes of a pixel that it takes at its height, and its time in seconds for a pixel whose vectors are right.
std::size_t repair_bytes_per_pixel(const Parameters& parameters);
double repair_nanoseconds(const Parameters& parameters);

}  // namespace varve
