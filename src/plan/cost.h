// What a plan will cost: memory by one formula, time from one table of measured constants.
#pragma once

#include "plan/plan.h"

namespace varve {

/// Peak memory in bytes: a base, the raw planes of one frame (in and out), the planes of one subject at work, and two
/// histories of every subject. Independent of the length of the sequence.
std::size_t estimate_bytes(const SequenceInfo& info, const Plan& plan, const Parameters& parameters,
                           const OutputRequest& output);

/// Wall time of one frame: pixels and bytes times the constants of the table, over the threads (1 and up). An estimate:
/// made on another machine, for noisy pictures.
double estimate_seconds(const SequenceInfo& info, const Plan& plan, const Parameters& parameters,
                        const OutputRequest& output, int threads);

}  // namespace varve
