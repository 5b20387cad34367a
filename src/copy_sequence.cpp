#include "copy_sequence.h"

#include <algorithm>
#include <set>

#include "exr/read_frame.h"
#include "exr/write_frame.h"
#include "plan/probe.h"
#include "stages/preflight.h"

namespace varve {
namespace {

/// Whole parts that hold a color to resolve; of role files, depth and vectors.
std::vector<ChannelRef> channels_of(const FrameHeaders& headers, int file) {
  std::vector<ChannelRef> wanted;
  const auto add = [&](ChannelRef ref) {
    if (ref.file == file && std::ranges::find(wanted, ref) == wanted.end()) wanted.push_back(ref);
  };
  for (const Subject& subject : headers.subjects) {
    const int part = part_of(subject);
    if (file == 0)
      for (int c = 0; c < int(headers.files.front().parts[std::size_t(part)].channels.size()); ++c) add({0, part, c});
    if (subject.depth) add(*subject.depth);
    if (const auto& vectors = subject.backward ? subject.backward : subject.forward)
      add((*vectors)[0]), add((*vectors)[1]);
  }
  return wanted;
}

std::vector<OutputPart> parts_of(const FrameHeaders& headers, const FramePixels& pixels) {
  std::set<int> decoded;
  for (const Subject& subject : headers.subjects) decoded.insert(part_of(subject));
  std::vector<OutputPart> parts;
  const FileHeader& source = headers.files.front();
  for (int p = 0; p < int(source.parts.size()); ++p) {
    OutputPart& part = parts.emplace_back();
    part.source_part = p;
    part.copy_chunks = !decoded.contains(p);
    const std::vector<Channel>& channels = source.parts[std::size_t(p)].channels;
    for (std::size_t c = 0; c < channels.size() && !part.copy_chunks; ++c)
      part.channels.push_back({channels[c], &pixels.planes[std::size_t(p)][c]});
  }
  return parts;
}

}  // namespace

void copy_sequence(const ResolveJob& job) {
  const JitterSource jitter = parse_jitter_source(job.jitter);
  const SequenceInfo info = probe_sequence(job.input, job.frames, job.roles, jitter);
  check_outputs(job, schedule_frames(job, info, ""));
  Workers workers(job.threads);
  for (int frame : info.frames) {
    const FrameHeaders headers = read_frame_headers(job.input, frame, job.roles, jitter);
    std::vector<FramePixels> files;
    for (int file = 0; file < int(headers.files.size()); ++file)
      files.push_back(read_channels(headers.files[std::size_t(file)], channels_of(headers, file), workers));
    write_frame(job.output.path(frame), headers.files.front(), parts_of(headers, files.front()), {job.zip_level, {}},
                workers);
  }
}

}  // namespace varve
