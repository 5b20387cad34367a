// Before any pixel is read: which frames, where to, and what is already done.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plan/extra_samples.h"
#include "plan/resolve_job.h"
#include "stages/cameras_around.h"

namespace varve {

struct StateHead;  // stages/state_file.h

/// How far the frames reach that one output is made from, besides its own.
struct FrameReach {
  int before = 0, after = 0;     ///< frames, not across restarts
  bool back_to_restart = false;  ///< recursion: on and on, as far back as there is history
  int block = 1;                 ///< frames of a block: the reach counts from its first and its last frame
};
FrameReach reach_of(const ResolveJob& job);

/// First frame number of the block that a frame lies in; blocks are aligned to frame 0.
int block_start(int frame, int block);

/// A frame to process: written, or only read to warm the history up.
struct ScheduledFrame {
  int frame = 0;
  bool write = false;
  bool complete = false;       ///< a finished output of the same parameters is there (--resume)
  bool leaves_state = false;   ///< --state-out wants what is known after it
  bool restart = false;        ///< history starts anew here: first frame, cut, or gap before it
  std::string restart_reason;  ///< "first frame", "cut", "gap after frame 12"
};

/// Frames in order: requested ones are written, existing ones between them and within reach around them are only made
/// use of. `found_cuts` begin shots besides those of the job; with the evidence. `before`: the history of the first one
/// goes on from there.
std::vector<ScheduledFrame> schedule_frames(const ResolveJob& job, const SequenceInfo& info,
                                            const StateHead* before = nullptr,
                                            const std::map<int, std::string>& found_cuts = {});

/// The same frames: those that cuts are to be looked for in.
std::vector<int> frames_in_reach(const ResolveJob& job, const SequenceInfo& info);

/// The frames that the vectors of schedule[index] lead to.
NeighborFrames neighbors_of(const std::vector<ScheduledFrame>& schedule, std::size_t index);

/// First and last place in the schedule of the frames that schedule[index] is made from.
std::pair<std::size_t, std::size_t> span_around(const std::vector<ScheduledFrame>& schedule, std::size_t index,
                                                const FrameReach& reach);

/// Every choice that decides the pixels, as text. Names of files come without their folders, so that equal work gives
/// equal bytes wherever it is done. `before`: the history began where that run began it.
std::string describe_parameters(const ResolveJob& job, const SequenceInfo& info, const StateHead* before = nullptr);

/// What decides the pixels from beside the frames: names of the role files, contents of the
/// color config (not of the tables that the config refers to). For the hash only.
std::string describe_side_inputs(const ResolveJob& job);

/// FNV-1a, 64 bits, hex, of the text and the version. Equal hash: equal output, as long as the frames that are read do
/// not change.
std::string hash_of(const std::string& text);

/// What several frames need: role files with a frame number of their own, and vectors, since without them all would be
/// averaged as if nothing moved; that is done only when asked for (--convention none).
/// Throws Failure(usage) or Failure(inconsistent) naming the file, the layer and the remedy.
void check_roles(const ResolveJob& job, const SequenceInfo& info);

/// Outputs differ from inputs and from each other, folders can be written to. Throws Failure.
void check_outputs(const ResolveJob& job, const std::vector<ScheduledFrame>& schedule);

/// Folders that a job writes into; "." for the current one.
std::vector<std::string> output_folders(const ResolveJob& job);

}  // namespace varve
