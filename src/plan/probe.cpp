#include "plan/probe.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>
#include <system_error>

#include "base/error.h"
#include "exr/unknown_convention.h"
#include "plan/camera_survey.h"
#include "plan/find_samples.h"

namespace varve {
namespace {

constexpr std::size_t kMaxGaps = 100'000;   // listed; two frames may lie two thousand million apart
constexpr std::size_t kMaxDifferences = 3;  // frames whose channels differ, described one by one

std::string at_frame(int frame) { return "frame " + std::to_string(frame) + ": "; }

std::vector<int> frames_to_probe(const InputSequence& input, const std::vector<int>& asked) {
  if (!asked.empty()) {
    if (!input.color.has_frame() && asked.size() > 1)
      throw Failure(ExitCode::usage, input.color.text() +
                                         ": the name has no place for a frame number, so it is one file; "
                                         "write it as shot.####.exr to give several frames");
    return asked;
  }
  std::vector<int> frames = input.color.frames_on_disk();
  if (frames.empty())
    throw Failure(ExitCode::input,
                  input.color.text() + (input.color.has_frame() ? ": no file of that name with a frame number is there"
                                                                : ": there is no such file"));
  return frames;
}

// Frames that a sequence of that spacing should have. On twos, the odd ones are no gaps.
void find_gaps(SequenceInfo& info) {
  std::int64_t step = 0;
  for (std::size_t i = 1; i < info.frames.size(); ++i) {
    const std::int64_t distance = std::int64_t(info.frames[i]) - info.frames[i - 1];
    step = step == 0 ? distance : std::min(step, distance);
  }
  for (std::size_t i = 1; i < info.frames.size(); ++i)
    for (std::int64_t f = info.frames[i - 1] + step; f < info.frames[i] && info.gaps.size() < kMaxGaps; f += step)
      info.gaps.push_back(int(f));
  if (!info.gaps.empty())
    info.notes.push_back("frames are missing between the first and the last: " +
                         (info.gaps.size() < kMaxGaps ? std::to_string(info.gaps.size()) : "100000 or more") +
                         "; the history starts anew after each gap");
  if (step > 1)
    info.notes.push_back("frames are " + std::to_string(step) +
                         " apart; vectors fit only if they were rendered for that distance");
}

std::set<std::string> channel_names(const FrameHeaders& frame) {
  std::set<std::string> names;
  for (const FileHeader& file : frame.files)
    for (const Part& part : file.parts)
      for (const Channel& channel : part.channels)
        names.insert((part.name.empty() ? "" : part.name + ":") + channel.name);
  return names;
}

std::string difference(const std::set<std::string>& of, const std::set<std::string>& without) {
  std::vector<std::string> names;
  std::set_difference(of.begin(), of.end(), without.begin(), without.end(), std::back_inserter(names));
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < 6; ++i) text += (i ? ", " : " ") + names[i];
  if (names.size() > 6) text += " and " + std::to_string(names.size() - 6) + " more";
  return text;
}

void compare_windows(const FrameHeaders& frame, SequenceInfo& info) {
  for (std::size_t f = 0; f < frame.files.size(); ++f) {
    const std::vector<Part>&here = frame.files[f].parts, &first = info.first.files[f].parts;
    for (std::size_t p = 0; p < std::min(here.size(), first.size()); ++p) {
      info.windows_move = info.windows_move || here[p].data_window != first[p].data_window;
      info.windows_differ = info.windows_differ || here[p].display_window != first[p].display_window;
    }
  }
}

/// Goes through the frames one by one; holds only what is counted.
struct Survey {
  SequenceInfo& info;
  std::set<std::string> first_names;
  CameraSurvey cameras;
  std::size_t differing = 0;

  void add(const FrameHeaders& frame) {
    if (frame.jitter) ++info.frames_with_jitter;
    if (frame.sample_jitter.empty() && frame.jitter) info.jitters.push_back(*frame.jitter);
    for (const std::optional<Jitter>& jitter : frame.sample_jitter)
      if (jitter) info.jitters.push_back(*jitter);
    cameras.add(frame);
    compare_windows(frame, info);
    const std::set<std::string> names = channel_names(frame);
    if (names == first_names || ++differing > kMaxDifferences) return;
    const std::string missing = difference(first_names, names), added = difference(names, first_names);
    info.notes.push_back(at_frame(frame.frame) + "the channels differ from those of frame " +
                         std::to_string(info.first.frame) + (missing.empty() ? "" : "; missing:" + missing) +
                         (added.empty() ? "" : "; new:" + added));
  }

  void finish(const JitterSource& jitter) {
    const std::string of = " of " + std::to_string(info.frames.size()) + " frames";
    cameras.finish(info);
    if (differing > kMaxDifferences)
      info.notes.push_back("the channels of " + std::to_string(differing - kMaxDifferences) +
                           " more frames differ as well");
    if (info.first.grid > 1) {
      info.jitter_source = "the places of the samples in their grid" +
                           (jitter.description.empty() ? std::string() : ", and " + jitter.description);
      return;
    }
    const std::string in = " in " + std::to_string(info.frames_with_jitter) + of;
    switch (jitter.kind) {
      case JitterSource::Kind::none:
        info.jitter_source = "none, as asked";
        break;
      case JitterSource::Kind::automatic:
        info.jitter_source = info.frames_with_jitter == 0 ? "none found" : "from the headers" + in;
        if (!jitter.points.empty()) info.jitter_source = "from the headers, or assumed: " + jitter.description;
        break;
      default:
        info.jitter_source = jitter.description + in;
    }
  }
};

void note_jitter(const InputSequence& input, const JitterSource& jitter, SequenceInfo& info) {
  if (info.frames_with_jitter > 0 && info.frames_with_jitter < int(info.frames.size()))
    info.notes.push_back("the jitter is known for " + std::to_string(info.frames_with_jitter) + " of " +
                         std::to_string(info.frames.size()) + " frames only");
  if (jitter.kind == JitterSource::Kind::automatic && !jitter.points.empty())
    info.notes.push_back(
        "the jitter is assumed to be " + jitter.description +
        ", as --assume-jitter says, where the headers do not tell it; varve probe --check-jitter holds "
        "it against the pixels");
  if (jitter.kind != JitterSource::Kind::automatic || info.frames_with_jitter > 0) return;
  const std::filesystem::path beside =
      std::filesystem::path(input.color.path(info.frames.front())).parent_path() / "jitter.csv";
  std::error_code ignored;
  if (std::filesystem::is_regular_file(beside, ignored))
    info.notes.push_back(beside.string() +
                         " lies beside the frames and is not used; if it belongs to them, give --jitter " +
                         beside.string());
}

void note_vectors(const SequenceInfo& info, std::vector<std::string>& notes) {
  for (const Subject& subject : info.first.subjects)
    for (const std::optional<VectorChannels>& vector : {subject.backward, subject.forward}) {
      if (!vector) continue;
      const ChannelRef x = (*vector)[0];
      const Channel& channel =
          info.first.files[std::size_t(x.file)].parts[std::size_t(x.part)].channels[std::size_t(x.channel)];
      if (channel.type != PixelType::float16) continue;
      notes.push_back(
          "vectors such as " + channel.name +
          " are stored as half: between 32 and 64 px their step is 1/32 px, and it doubles with every octave");
      return;
    }
}

void note_parts(const SequenceInfo& info, std::vector<std::string>& notes) {
  std::set<int> resolved;
  for (const Subject& subject : info.first.subjects)
    for (const int part : parts_of(subject)) resolved.insert(part);
  for (const FileHeader& file : files_on_disk(info.first))
    for (const Part& part : file.parts) {
      const std::string where = part.name.empty() ? file.path : "part " + part.name;
      const bool color =
          file.path == info.first.files.front().path && resolved.contains(int(&part - file.parts.data()));
      if (is_deep(part) && !color)
        notes.push_back(where + " is deep; it is passed through as it is" +
                        (file.path == info.first.files.front().path ? ", unless --layer names it" : ""));
      if (!is_lossy(part.compression) || is_deep(part)) continue;
      std::vector<std::string> data;
      for (const Channel& channel : part.channels) {
        const ChannelClass holds = classify(channel);
        if (holds != ChannelClass::color && holds != ChannelClass::alpha) data.push_back(channel.name);
      }
      if (data.empty()) continue;
      const bool dwa = part.compression == Compression::dwaa || part.compression == Compression::dwab;
      notes.push_back(where + ": " + name_of(part.compression) + " compression is lossy and the part holds data (" +
                      data.front() + (data.size() > 1 ? ", ..." : "") + ")" +
                      (dwa ? "; it changes data channels whose name ends in Y, vectors by a tenth of a pixel" : ""));
    }
}

}  // namespace

FrameHeaders read_frame_headers(const InputSequence& input, int frame, const RoleRequest& roles,
                                const JitterSource& jitter, const CameraSource& cameras) {
  FrameHeaders headers;
  headers.frame = frame;
  try {
    headers.files.push_back(read_header(input.color.path(frame)));
    for (const SequencePattern& role : input.roles) headers.files.push_back(read_header(role.path(frame)));
    if (roles.samples.mode != SampleMode::off) {
      find_samples(headers, roles, jitter);
      headers.cameras = cameras_of(headers, cameras);
      return headers;
    }
    headers.subjects = find_subjects(headers.files, roles);
    headers.outputs = color_outputs(headers.files, headers.subjects, roles);
    const Subject& main = headers.subjects.front();
    for (const std::optional<ChannelRef>& channel : main.color)
      if (channel && !headers.jitter)
        headers.jitter = jitter_of(jitter, headers.files.front().parts[std::size_t(channel->part)], frame);
    if (!headers.jitter) headers.jitter = jitter_of(jitter, headers.files.front().parts.front(), frame);
    headers.cameras = cameras_of(headers, cameras);
  } catch (const UnknownConvention& unknown) {
    throw UnknownConvention(at_frame(frame) + unknown.what());
  } catch (const Failure& failure) {
    const std::string sentence = failure.what();
    throw Failure(failure.code(), sentence.starts_with("frame ") ? sentence : at_frame(frame) + sentence);
  }
  return headers;
}

SequenceInfo probe_sequence(const InputSequence& input, const std::vector<int>& frames, const RoleRequest& roles,
                            const JitterSource& jitter, const CameraSource& cameras) {
  SequenceInfo info;
  info.frames = frames_to_probe(input, frames);
  std::sort(info.frames.begin(), info.frames.end());
  info.frames.erase(std::unique(info.frames.begin(), info.frames.end()), info.frames.end());
  find_gaps(info);
  info.first = read_frame_headers(input, info.frames.front(), roles, jitter, cameras);
  Survey survey{info, channel_names(info.first), {}};
  survey.add(info.first);
  for (std::size_t i = 1; i < info.frames.size(); ++i)
    survey.add(read_frame_headers(input, info.frames[i], roles, jitter, cameras));
  survey.finish(jitter);
  if (info.windows_move) info.notes.push_back("the data window moves between frames; outside it there is no data");
  if (info.windows_differ)
    info.notes.push_back("the display window differs between frames; pixels are matched by their coordinates");
  note_jitter(input, jitter, info);
  note_vectors(info, info.notes);
  note_parts(info, info.notes);
  return info;
}

}  // namespace varve
