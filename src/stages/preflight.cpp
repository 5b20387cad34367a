#include "stages/preflight.h"
#include "stages/gather_frame.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/json.h"
#include "base/version.h"
#include "exr/temporary_file.h"
#include "exr/write_frame.h"
#include "plan/camera_plan.h"
#include "plan/deep_plan.h"
#include "plan/layers_plan.h"
#include "plan/preset.h"
#include "stages/state_file.h"

namespace varve {
namespace {

/// First and last frame number that a frame reaches.
std::pair<long long, long long> limits_of(int frame, const FrameReach& reach) {
  const long long start = block_start(frame, reach.block);
  return {start - reach.before, start + reach.block - 1 + reach.after};
}

/// All frames to look at: those on disk within reach of the first and of the last requested.
std::vector<ScheduledFrame> frames_between(const ResolveJob& job, const SequenceInfo& info, const FrameReach& reach) {
  const std::set<int> requested(info.frames.begin(), info.frames.end());
  std::set<int> all = requested;
  if (job.input.color.has_frame()) {
    const long long first = limits_of(info.frames.front(), reach).first;
    const long long last = limits_of(info.frames.back(), reach).second;
    for (const int frame : job.input.color.frames_on_disk())
      if (frame >= first && frame <= last) all.insert(frame);
  }
  std::vector<ScheduledFrame> schedule;
  for (const int frame : all) schedule.emplace_back().frame = frame, schedule.back().write = requested.contains(frame);
  return schedule;
}

void mark_restarts(std::vector<ScheduledFrame>& schedule, const std::vector<int>& cuts,
                   const std::map<int, std::string>& found, bool goes_on) {
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    ScheduledFrame& s = schedule[i];
    if (i == 0 && !goes_on)
      s.restart_reason = "first frame";
    else if (std::find(cuts.begin(), cuts.end(), s.frame) != cuts.end())
      s.restart_reason = "cut";
    else if (const auto cut = found.find(s.frame); cut != found.end())
      s.restart_reason = "cut found: " + cut->second;
    else if (i > 0 && s.frame != schedule[i - 1].frame + 1)
      s.restart_reason = "gap after frame " + std::to_string(schedule[i - 1].frame);
    s.restart = !s.restart_reason.empty();
  }
}

/// What was asked for; a sidecar by its numbers, since they may change under its name.
std::string describe_jitter(const std::string& jitter) {
  std::string rows;
  const JitterSource source = parse_jitter_source(jitter);
  char row[100];
  for (const auto& [frame, offset] : source.table) {
    std::snprintf(row, sizeof row, "%d:%.17g,%.17g ", frame, offset.x, offset.y);
    rows += row;
  }
  for (const auto& [place, offset] : source.further) {
    std::snprintf(row, sizeof row, "%d.%d:%.17g,%.17g ", place.first, place.second, offset.x, offset.y);
    rows += row;
  }
  return rows.empty() ? jitter : "table:" + hash_of(rows);
}

/// Likewise.
std::string describe_cameras(const std::string& camera) {
  std::string rows;
  for (const auto& [frame, row] : parse_camera_source(camera).table) {
    rows += std::to_string(frame) + ":";
    const auto add = [&](double number) { rows += json_number(number) + ","; };
    for (const double number : row.view) add(number);
    for (std::size_t i = 0; row.projection && i < 16; ++i) add((*row.projection)[i]);
    add(row.focal), add(row.aperture);
  }
  return rows.empty() ? camera : "table:" + hash_of(rows);
}

std::string samples_text(const SampleRequest& samples) {
  return (samples.mode == SampleMode::each ? "each" : "resolve") +
         (samples.grid > 0 ? ",grid:" + std::to_string(samples.grid) : std::string());
}

std::filesystem::path canonical(const std::string& path) { return std::filesystem::weakly_canonical(path); }

}  // namespace

std::vector<int> frames_in_reach(const ResolveJob& job, const SequenceInfo& info) {
  std::vector<int> frames;
  for (const ScheduledFrame& s : frames_between(job, info, reach_of(job))) frames.push_back(s.frame);
  return frames;
}

std::vector<ScheduledFrame> schedule_frames(const ResolveJob& job, const SequenceInfo& info, const StateHead* before,
                                            const std::map<int, std::string>& found_cuts) {
  std::vector<ScheduledFrame> schedule = frames_between(job, info, reach_of(job));
  mark_restarts(schedule, job.cuts, found_cuts, before != nullptr);
  return schedule;
}

FrameReach reach_of(const ResolveJob& job) {
  const Accumulator accumulator = job.parameters.accumulator;
  if (accumulator == Accumulator::recursive || accumulator == Accumulator::subpixel) return {job.preroll, 0, true};
  if (job.parameters.accumulator == Accumulator::gather) {
    const int reach = gather_reach(job.parameters.gather);
    return {reach, reach, false};
  }
  const int look_ahead = look_ahead_frames(job.parameters.two_sided, job.parameters.recursive.alpha);
  return {look_ahead, look_ahead, false, look_ahead};
}

int block_start(int frame, int block) {
  const int past_start = frame % block;  // negative for frames below 0
  return frame - past_start - (past_start < 0 ? block : 0);
}

std::pair<std::size_t, std::size_t> span_around(const std::vector<ScheduledFrame>& schedule, std::size_t index,
                                                const FrameReach& reach) {
  std::size_t first = index, last = index;
  const auto [earliest, latest] = limits_of(schedule[index].frame, reach);
  while (!schedule[first].restart && first > 0 && (reach.back_to_restart || schedule[first - 1].frame >= earliest))
    --first;
  while (last + 1 < schedule.size() && !schedule[last + 1].restart && schedule[last + 1].frame <= latest) ++last;
  return {first, last};
}

NeighborFrames neighbors_of(const std::vector<ScheduledFrame>& schedule, std::size_t index) {
  NeighborFrames neighbors;
  // A history that goes on from a state file goes on from the frame before.
  if (!schedule[index].restart) neighbors.before = index > 0 ? schedule[index - 1].frame : schedule[0].frame - 1;
  if (index + 1 < schedule.size() && !schedule[index + 1].restart) neighbors.after = schedule[index + 1].frame;
  return neighbors;
}

std::string describe_parameters(const ResolveJob& job, const SequenceInfo& info, const StateHead* before) {
  std::string text = parameters_text(job.parameters);
  // Where the history begins decides what recursion gives; a finite window knows nothing of other frames.
  if (reach_of(job).back_to_restart)
    text += " first=" + std::to_string(before ? before->first : info.frames.front()) +
            " preroll=" + std::to_string(before ? before->preroll : job.preroll);
  std::vector<int> cuts = job.cuts;
  std::sort(cuts.begin(), cuts.end());
  if (!cuts.empty()) text += " cuts=" + format_frame_list(cuts);
  if (job.find_cuts) text += " find-cuts=on";
  text += " camera=" + describe_cameras(job.camera);
  text += " jitter=" + describe_jitter(job.jitter) + " convention=" + job.roles.convention;
  for (const std::string& layer : job.roles.layers) text += " layer=" + layer;
  text += layers_text(job.roles.combine_layers, info) + deep_text(job.roles.combine_layers, info);
  for (const std::string& channels : job.roles.channels) text += " channels=" + channels;
  if (!job.roles.channels.empty())
    text += std::string(" channel-weights=") + (job.roles.channel_weights == ChannelWeights::own ? "own" : "beauty");
  if (job.roles.samples.mode != SampleMode::off) text += " samples=" + samples_text(job.roles.samples);
  for (const auto& [role, channel] : job.roles.map) text += " map:" + role + "=" + channel;
  for (const Subject& subject : info.first.subjects) {
    const MotionEncoding& e = subject.backward ? subject.backward_encoding : subject.forward_encoding;
    char encoding[160];
    std::snprintf(encoding, sizeof encoding, ",%.17g,%.17g,%.17g,%g,%g,%d,%d", e.bias, e.scale, e.shutter, e.sign_x,
                  e.sign_y, int(e.unit), int(e.direction));
    text += " vectors:" + subject.layer + "=" + subject.convention;
    text += encoding;
  }
  for (const std::string& aov : job.request.aovs) text += " aov=" + aov;
  if (std::find(job.request.aovs.begin(), job.request.aovs.end(), "evaluation") != job.request.aovs.end())
    text += " want-samples=" + json_number(job.rerender.want_samples) +
            " want-noise=" + json_number(job.rerender.want_noise);
  if (!job.extra_list.empty()) text += " extra-list=" + std::filesystem::path(job.extra_list).filename().string();
  if (job.request.diagnostics_apart) text += " diagnostics=apart";
  if (!job.request.keep_channels) text += " keep=none";
  if (job.compression) text += std::string(" compression=") + name_of(*job.compression);
  text += " zip-level=" + std::to_string(job.zip_level);
  if (!job.ocio_config.empty()) text += " ocio=" + std::filesystem::path(job.ocio_config).filename().string();
  if (!job.from_space.empty()) text += " from-space=" + job.from_space;
  if (!job.to_space.empty()) text += " to-space=" + job.to_space;
  return text;
}

std::string describe_side_inputs(const ResolveJob& job) {
  std::string text;
  for (const SequencePattern& role : job.input.roles)
    text += " role:" + std::filesystem::path(role.text()).filename().string();
  const bool converts = !job.from_space.empty() || !job.to_space.empty();
  const char* variable = std::getenv("OCIO");
  const std::string config = !converts ? "" : job.ocio_config.empty() && variable ? variable : job.ocio_config;
  std::error_code none;
  if (!std::filesystem::is_regular_file(config, none)) return text;
  std::ostringstream bytes;
  bytes << std::ifstream(config, std::ios::binary).rdbuf();
  return text + " config:" + bytes.str();
}

std::string hash_of(const std::string& text) {
  std::uint64_t h = 14695981039346656037ull;
  for (const char c : text + " " + version()) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(h));
  return hex;
}

void check_roles(const ResolveJob& job, const SequenceInfo& info) {
  for (const SequencePattern& role : job.input.roles)
    if (info.frames.size() > 1 && !role.has_frame())
      throw Failure(ExitCode::usage, "'" + role.text() + "' is one file for " + std::to_string(info.frames.size()) +
                                         " frames; put the frame number in, as in motion.####.exr");
  if (!has_others(info) || job.roles.convention == "none") return;
  const auto moves = [&](const Subject& s) { return s.backward || s.forward || is_moved_by_camera(info, s); };
  // A layer of several may be a still; a note of it says so.
  for (const ColorOutput& output : info.first.outputs)
    if (std::none_of(output.inputs.begin(), output.inputs.end(),
                     [&](std::size_t i) { return moves(info.first.subjects[i]); })) {
      const Subject& subject = info.first.subjects[output.inputs.front()];
      throw Failure(
          ExitCode::inconsistent,
          "'" + info.first.files.front().path + "' (frame " + std::to_string(info.first.frame) +
              ") has no motion vectors for " + (subject.layer.empty() ? "its color" : "layer '" + subject.layer + "'") +
              "; render them, name them with --map motion.x=CHANNEL or --motion-file, give depth and --camera FILE, or "
              "say --convention none to resolve as if nothing moved");
    }
}

void check_outputs(const ResolveJob& job, const std::vector<ScheduledFrame>& schedule) {
  std::set<std::filesystem::path> inputs;
  std::size_t writes = 0;
  for (const ScheduledFrame& s : schedule) {
    inputs.insert(canonical(job.input.color.path(s.frame)));
    for (const SequencePattern& role : job.input.roles) inputs.insert(canonical(role.path(s.frame)));
    writes += s.write;
  }
  const auto check = [&](const SequencePattern& pattern, const char* option, std::set<std::filesystem::path>& outputs) {
    if (writes > 1 && !pattern.has_frame())
      throw Failure(ExitCode::usage, std::string(option) + " '" + pattern.text() + "' names one file for " +
                                         std::to_string(writes) +
                                         " frames; put the frame number in, as in out.####.exr");
    for (const ScheduledFrame& s : schedule) {
      if (!s.write) continue;
      const std::string path = pattern.path(s.frame);
      const std::filesystem::path file = canonical(path);
      if (inputs.contains(file))
        throw Failure(ExitCode::usage, "output '" + path + "' (frame " + std::to_string(s.frame) +
                                           ") is one of the inputs; name another file or folder with " + option);
      if (!outputs.insert(file).second)
        throw Failure(ExitCode::usage, "output '" + path + "' (frame " + std::to_string(s.frame) +
                                           ") would be written twice; give " + option + " another name");
    }
    for (const ScheduledFrame& s : schedule)
      if (s.write) {
        check_writable(pattern.path(s.frame));
        break;
      }
  };
  std::set<std::filesystem::path> outputs;
  check(job.output, "--output", outputs);
  if (job.diagnostics) check(*job.diagnostics, "--diagnostics", outputs);
  if (!job.preview_folder.empty()) check_writable(job.preview_folder + "/color.png");
  const auto check_file = [&](const std::string& path, const std::string& what, const char* option) {
    if (path.empty()) return;
    if (inputs.contains(canonical(path)) || outputs.contains(canonical(path)))
      throw Failure(ExitCode::usage, "the " + what + " '" + path + "' is one of the frames read or written; give " +
                                         option + " another name");
    check_writable(path);
    outputs.insert(canonical(path));
  };
  check_file(job.report, "report", "--report");
  for (const std::string& list : job.rerender.files) check_file(list, "list", "--rerender");
  if (!job.rerender.files.empty() && job.resume)
    throw Failure(ExitCode::usage,
                  "--rerender looks at every frame, and --resume skips those that are done; leave one of them out");
  check_file(job.state_out, "state file", "--state-out");
  if (!job.state_out.empty() && !is_free_for_state(job.state_out))
    throw Failure(ExitCode::usage,
                  "'" + job.state_out + "' is there and is no state file; give --state-out another name");
}

std::vector<std::string> output_folders(const ResolveJob& job) {
  std::set<std::string> folders = {folder_of(job.output.text())};
  if (job.diagnostics) folders.insert(folder_of(job.diagnostics->text()));
  if (!job.preview_folder.empty()) folders.insert(job.preview_folder);
  for (const std::string& file : {job.report, job.state_out})
    if (!file.empty()) folders.insert(folder_of(file));
  for (const std::string& list : job.rerender.files) folders.insert(folder_of(list));
  return {folders.begin(), folders.end()};
}

}  // namespace varve
