// What is asked for and cannot be done with what is there.
#pragma once

#include "plan/parameters.h"
#include "plan/probe.h"

namespace varve {

/// Throws Failure(inconsistent) when the sequence lacks what a choice needs, Failure(usage) when choices do not go
/// together; both name the remedy. Falling back silently would change the picture without a word.
void check_possible(const SequenceInfo& info, const Parameters& parameters);

}  // namespace varve
