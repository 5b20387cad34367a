// Going on from what another run left (--state-in), and leaving it (--state-out).
#pragma once

#include <vector>

#include "stages/accumulate_frame.h"
#include "stages/set_up.h"

namespace varve {

/// State files are for accumulators that remember. Throws Failure(usage) for others, and where --preroll would warm up
/// a history that is given.
void check_state_options(const ResolveJob& job);

/// The head of --state-in fits this run: version, frames, layers, parameters. Throws Failure(inconsistent) with the
/// first thing that differs.
void check_continues(const Setup& s);

/// Everything of --state-in, after a look at the frames it was made from, as far as they are still there. Throws
/// Failure(inconsistent) where one was rendered again, or what read_state() throws.
std::vector<SubjectState> continued_states(const Setup& s, InputWatch& watch);

/// How the cameras go on from the last frame of the earlier run to the first one of this: that run could not know it.
void continue_cameras(const SourceFrame& first, const FrameCameras& before, std::vector<SubjectState>& states);

/// Writes --state-out. `used` ends with the frame of `headers`. Throws Failure(output).
void save_states(const Setup& s, const FrameHeaders& headers, std::vector<UsedFrame> used,
                 const std::vector<SubjectState>& states);

/// Whether --state-out is there already, whole, from the same frames.
bool is_saved(const Setup& s, const std::vector<UsedFrame>& used);

}  // namespace varve
