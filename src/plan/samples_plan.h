// What the plan says of several samples in each pixel.
#pragma once

#include "plan/plan.h"

namespace varve {

/// The pass that makes one of them, with what is to be said about it added to `notes`. Empty where nothing was taken
/// for samples.
std::vector<PlannedPass> samples_passes(const SequenceInfo& info, const Parameters& parameters,
                                        std::vector<std::string>& notes);

}  // namespace varve
