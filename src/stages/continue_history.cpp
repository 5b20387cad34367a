#include "stages/continue_history.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "base/version.h"
#include "plan/camera_survey.h"
#include "stages/state_file.h"

namespace varve {
namespace {

std::vector<std::string> subject_names(const SequenceInfo& info) {
  std::vector<std::string> names;
  for (const Subject* subject : accumulated_subjects(info.first.outputs, info.first.subjects))
    names.push_back(subject->layer + (subject->view.empty() ? "" : "@" + subject->view));
  return names;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "the main layer" : name);
  return text;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// "alpha=0.1 there and alpha=0.2 here": the first word that differs.
std::string difference(const std::string& there, const std::string& here) {
  const std::vector<std::string> a = words_of(there), b = words_of(here);
  const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return (x == a.end() ? "nothing" : *x) + " there and " + (y == b.end() ? "nothing" : *y) + " here";
}

[[noreturn]] void refuse(const Setup& s, const std::string& why) {
  throw Failure(ExitCode::inconsistent, "the state file '" + s.job.state_in + "' " + why);
}

bool is_there(const InputSequence& input, int frame) {
  bool there = identity_of(input.color.path(frame)).there;
  for (const SequencePattern& role : input.roles) there = there && identity_of(role.path(frame)).there;
  return there;
}

}  // namespace

void check_state_options(const ResolveJob& job) {
  if (job.state_in.empty() && job.state_out.empty()) return;
  if (!reach_of(job).back_to_restart)
    throw Failure(ExitCode::usage,
                  "--state-in and --state-out are for accumulators that carry a history from frame to frame; this one "
                  "makes each frame from the files around it, so that any chunk gives the same bytes without a state: "
                  "leave them out, and have the frames around the chunk on disk");
  if (!job.state_in.empty() && job.preroll > 0)
    throw Failure(ExitCode::usage,
                  "--state-in brings the whole history, and --preroll would begin another one; give one of them");
}

void check_continues(const Setup& s) {
  const StateHead& before = *s.before;
  if (before.version != version())
    refuse(s, "was written by varve " + before.version + ", and this is " + version() +
                  "; run the chunk before it again with this version");
  const int first = s.info.frames.front();
  if (std::int64_t(first) - 1 != before.last())
    refuse(s, "holds what is known after frame " + std::to_string(before.last()) +
                  ", and the first frame to write is " + std::to_string(first) + "; give --frames from " +
                  std::to_string(before.last() + 1) + " on, or the state file of frame " + std::to_string(first - 1));
  if (before.subjects != subject_names(s.info))
    refuse(s, "is of other layers: " + list_of(before.subjects) + " there and " + list_of(subject_names(s.info)) +
                  " here; give the same --layer, --layers and --samples to both runs");
  if (before.parameters != s.parameters)
    refuse(s, "was made with other parameters: " + difference(before.parameters, s.parameters) +
                  "; give both runs the same ones");
  if (before.hash != s.hash)
    refuse(s,
           "was made with other files beside the frames: names of role files, or the color config, differ; give both "
           "runs the same ones");
}

std::vector<SubjectState> continued_states(const Setup& s, InputWatch& watch) {
  for (const UsedFrame& used : s.before->frames)
    if (is_there(s.job.input, used.frame) && print_of(watch, used.frame) != used.print)
      refuse(s, "was made before frame " + std::to_string(used.frame) + " ('" + s.job.input.color.path(used.frame) +
                    "') was rendered again; run the chunk that has this frame, and those after it, again");
  SavedState state = read_state(s.job.state_in);
  if (state.head.hash != s.before->hash || state.head.frames != s.before->frames ||
      state.head.subjects != s.before->subjects)
    refuse(s, "was written again while this run began; run it again");
  return std::move(state.subjects);
}

void continue_cameras(const SourceFrame& first, const FrameCameras& before, std::vector<SubjectState>& states) {
  if (first.cameras.empty()) return;
  const FrameCameras here = kept_cameras(first.headers);
  std::vector<CamerasAround> around;
  for (std::size_t k = 0; k < before.cameras.size() && k < here.cameras.size(); ++k)
    around.push_back({{}, {}, camera_change(before, here, k)});
  for (std::size_t k = 0; k < states.size(); ++k) states[k].forward.seen.cameras = cameras_of(first.headers, around, k);
}

void save_states(const Setup& s, const FrameHeaders& headers, std::vector<UsedFrame> used,
                 const std::vector<SubjectState>& states) {
  StateHead head;
  head.version = version();
  head.parameters = s.parameters;
  head.hash = s.hash;
  head.first = s.before ? s.before->first : s.info.frames.front();
  head.preroll = s.before ? s.before->preroll : s.job.preroll;
  head.frames = std::move(used);
  head.subjects = subject_names(s.info);
  head.cameras = kept_cameras(headers);
  write_state(s.job.state_out, head, states);
}

bool is_saved(const Setup& s, const std::vector<UsedFrame>& used) {
  try {
    const StateHead head = read_state(s.job.state_out).head;
    return head.version == version() && head.hash == s.hash && head.frames == used &&
           head.subjects == subject_names(s.info);
  } catch (const Failure&) {
    return false;
  }
}

}  // namespace varve
