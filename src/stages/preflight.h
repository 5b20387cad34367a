// Before any pixel is read: which frames, where to, and what is already done.
#pragma once

#include <string>
#include <vector>

#include "plan/resolve_job.h"

namespace varve {

/// A frame to process: written, or only read to warm the history up.
struct ScheduledFrame {
  int frame = 0;
  bool write = false;
  bool complete = false;       ///< a finished output of the same parameters is there (--resume)
  bool restart = false;        ///< history starts anew here: first frame, cut, or gap before it
  std::string restart_reason;  ///< "first frame", "cut", "gap after frame 12"
};

/// Frames in order: requested ones are written, existing ones between them and `preroll` before them only feed the
/// history. With --resume, frames that no unfinished frame depends on are left out.
std::vector<ScheduledFrame> schedule_frames(const ResolveJob& job, const SequenceInfo& info, const std::string& hash);

/// Everything that decides the pixels, as text, and its hash (FNV-1a, 64 bits, hex). Equal hash: equal output.
std::string describe_parameters(const ResolveJob& job, const SequenceInfo& info);
std::string hash_of(const std::string& text);

/// Several frames without vectors would be averaged as if nothing moved: that is done only when asked for
/// (--convention none). Throws Failure(inconsistent) naming the layer and the remedy.
void check_vectors(const ResolveJob& job, const SequenceInfo& info);

/// Outputs differ from inputs and from each other, folders can be written to. Throws Failure.
void check_outputs(const ResolveJob& job, const std::vector<ScheduledFrame>& schedule);

}  // namespace varve
