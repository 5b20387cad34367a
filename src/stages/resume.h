// What an earlier run has done already (--resume), and what is left to do.
#pragma once

#include <vector>

#include "stages/input_watch.h"
#include "stages/set_up.h"

namespace varve {

/// Marks frames whose outputs are there, whole, and made with the same parameters from the same inputs, by their
/// contents; leaves out those that no unfinished frame depends on. Marks the last frame where --state-out wants what is
/// known after it. Throws what print_of() throws.
void mark_finished(const Setup& s, InputWatch& watch, std::vector<ScheduledFrame>& schedule);

/// A finished frame is worked on again only where a later one, or a state file, needs its history.
bool is_needed(const std::vector<ScheduledFrame>& schedule, std::size_t index, const FrameReach& reach);

}  // namespace varve
