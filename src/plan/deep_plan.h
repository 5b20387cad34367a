// What deep parts mean for the plan.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "plan/plan.h"

namespace varve {

/// The pass that flattens the deep colors, or the reason why deep parts are left as they are; none where no part of the
/// color file is deep.
std::optional<PlannedPass> flatten_pass(const SequenceInfo& info);

/// Which sample a deep pixel follows, for the parameters in the output header; empty where no color is deep.
std::string deep_text(const LayersRequest& request, const SequenceInfo& info);

/// Memory of the samples at work at one time. Headers do not tell how many there are: guessed from the size of the
/// file, and never more than a band.
std::size_t deep_bytes(const SequenceInfo& info);

/// Nanoseconds of one thread to read and flatten the deep colors of a frame.
double deep_nanoseconds(const SequenceInfo& info);

}  // namespace varve
