#include "stages/resume.h"

#include <utility>

#include "base/error.h"
#include "exr/file_header.h"
#include "stages/continue_history.h"
#include "stages/provenance.h"
#include "stages/state_file.h"

namespace varve {
namespace {

bool says(const FileHeader& header, const char* name, const std::string& text) {
  const Attribute* found = header.parts.front().attribute(name);
  return found && found->text == text;
}

/// Whether a whole file of this run stands there already. `inputs` is asked for last: it may have to read them.
template <class Inputs>
bool is_complete(const std::string& path, const std::string& hash, const std::string& frames, const Inputs& inputs) {
  try {
    const FileHeader header = read_header(path);
    if (!says(header, "varve:hash", hash) || !says(header, "varve:frames", frames) || !has_every_chunk(path))
      return false;
    return says(header, "varve:inputs", inputs());
  } catch (const Failure&) {
    return false;
  }
}

bool is_open(const ScheduledFrame& s) { return (s.write && !s.complete) || s.leaves_state; }

/// Keeps what unfinished frames need: each back to its restart.
void drop_finished(std::vector<ScheduledFrame>& schedule) {
  std::vector<ScheduledFrame> kept;
  for (std::size_t begin = 0; begin < schedule.size();) {
    std::size_t end = begin + 1, last_open = begin;
    bool open = false;
    while (end < schedule.size() && !schedule[end].restart) ++end;
    for (std::size_t i = begin; i < end; ++i)
      if (is_open(schedule[i])) open = true, last_open = i;
    for (std::size_t i = begin; i < end; ++i)
      if ((open && i <= last_open) || schedule[i].complete) kept.push_back(schedule[i]);
    begin = end;
  }
  schedule = std::move(kept);
}

}  // namespace

void mark_finished(const Setup& s, InputWatch& watch, std::vector<ScheduledFrame>& schedule) {
  const ResolveJob& job = s.job;
  const StateHead* before = s.before ? &*s.before : nullptr;
  if (!job.state_out.empty() && !schedule.empty())
    schedule.back().leaves_state =
        !job.resume || !is_saved(s, frames_used(schedule, schedule.size() - 1, s.reach, before, watch));
  if (!job.resume) return;
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    ScheduledFrame& frame = schedule[i];
    if (!frame.write) continue;
    const std::string frames = format_frame_list(frame_numbers_used(schedule, i, s.reach, before));
    const auto inputs = [&] { return provenance_of(frames_used(schedule, i, s.reach, before, watch)).inputs; };
    frame.complete = is_complete(job.output.path(frame.frame), s.hash, frames, inputs) &&
                     (!job.diagnostics || is_complete(job.diagnostics->path(frame.frame), s.hash, frames, inputs));
  }
  if (s.reach.back_to_restart) drop_finished(schedule);
}

bool is_needed(const std::vector<ScheduledFrame>& schedule, std::size_t index, const FrameReach& reach) {
  bool needed = is_open(schedule[index]);
  for (std::size_t k = index + 1; reach.back_to_restart && !needed && k < schedule.size() && !schedule[k].restart; ++k)
    needed = is_open(schedule[k]);
  return needed;
}

}  // namespace varve
