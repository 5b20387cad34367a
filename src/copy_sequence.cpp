#include "copy_sequence.h"

#include <set>

#include "exr/write_frame.h"
#include "plan/probe.h"
#include "stages/preflight.h"
#include "stages/read_present.h"

namespace varve {
namespace {

std::vector<OutputPart> parts_of(const FrameHeaders& headers, const FramePixels& pixels) {
  std::set<int> decoded;
  for (const Subject& subject : headers.subjects)
    for (const int part : varve::parts_of(subject))
      if (!is_deep(headers.files.front().parts[std::size_t(part)])) decoded.insert(part);
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
  check_outputs(job, schedule_frames(job, info, "", {}));
  Workers workers(job.threads);
  for (int frame : info.frames) {
    const FrameHeaders headers = read_frame_headers(job.input, frame, job.roles, jitter);
    DeepFrame deep;  // read as the resolve reads them, and copied as they are
    const FileSet files = read_files(headers, {true, true, true}, deep, workers);
    write_frame(job.output.path(frame), headers.files.front(), parts_of(headers, files.front()), {job.zip_level, {}},
                workers);
  }
}

}  // namespace varve
