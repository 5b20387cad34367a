// The pixels of a few frames in numbers, for `probe --pixels`.

#include <algorithm>
#include <cmath>

#include "exr/convert.h"
#include "exr/read_frame.h"
#include "plan/find_samples.h"
#include "plan/probe.h"

namespace varve {
namespace {

/// A channel with what it is used for.
struct RoleChannel {
  ChannelRef ref;
  std::string role;
};

std::vector<RoleChannel> role_channels(const std::vector<Subject>& subjects) {
  std::vector<RoleChannel> found;
  const auto add = [&](const std::optional<ChannelRef>& ref, const std::string& role) {
    const auto same = [&](const RoleChannel& r) { return ref && r.ref == *ref; };
    if (ref && std::none_of(found.begin(), found.end(), same)) found.push_back({*ref, role});
  };
  constexpr const char* kColor[] = {"R", "G", "B", "A"};
  for (const Subject& subject : subjects) {
    for (std::size_t i = 0; i < 4; ++i) add(subject.color[i], kColor[i]);
    for (const Companion& companion : subject.companions)
      for (const std::optional<ChannelRef>& channel : companion.channels) add(channel, "companion");
    add(subject.depth, "depth");
    if (subject.backward) add((*subject.backward)[0], "motion.x"), add((*subject.backward)[1], "motion.y");
    if (subject.forward) add((*subject.forward)[0], "forward.x"), add((*subject.forward)[1], "forward.y");
  }
  return found;
}

// Rows in order, so that the sum does not depend on threads.
void measure(const RawPlane& plane, ChannelStatistics& statistics) {
  std::vector<float> row(std::size_t(plane.columns));
  double sum = 0;
  std::size_t finite = 0;
  for (int y = 0; y < plane.rows; ++y) {
    to_float(plane.type, plane.row(y), row.data(), row.size());
    for (const float value : row) {
      ++statistics.pixels;
      if (!std::isfinite(value)) {
        ++statistics.not_finite;
        continue;
      }
      const double v = value;
      statistics.zero += v == 0;
      statistics.least = finite == 0 ? v : std::min(statistics.least, v);
      statistics.greatest = finite == 0 ? v : std::max(statistics.greatest, v);
      sum += v;
      ++finite;
    }
  }
  if (finite > 0) statistics.mean = sum / double(finite);
}

// `count` frames spread evenly from the first to the last.
std::vector<int> spread(const std::vector<int>& frames, int count) {
  std::vector<int> chosen;
  const std::size_t n = std::min(frames.size(), std::size_t(std::max(count, 0)));
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(frames[n == 1 ? 0 : i * (frames.size() - 1) / (n - 1)]);
  return chosen;
}

}  // namespace

std::vector<ChannelStatistics> measure_pixels(const SequenceInfo& info, const InputSequence& input,
                                              const RoleRequest& roles, const JitterSource& jitter, int frames,
                                              Workers& workers) {
  std::vector<ChannelStatistics> all;
  for (const int frame : spread(info.frames, frames)) {
    const FrameHeaders headers = read_frame_headers(input, frame, roles, jitter);
    const std::vector<RoleChannel> wanted = role_channels(headers.subjects);
    for (int f = 0; f < int(headers.files.size()); ++f) {
      std::vector<RoleChannel> here;
      std::vector<ChannelRef> refs;
      for (const RoleChannel& channel : wanted)
        if (channel.ref.file == f) here.push_back(channel), refs.push_back(channel.ref);
      if (here.empty()) continue;
      const FileHeader& file = headers.files[std::size_t(f)];
      const FramePixels pixels = read_shown_channels(headers, f, refs, workers);
      std::vector<ChannelStatistics> found(here.size());
      workers.for_each(here.size(), [&](std::size_t i, int) {
        const Part& part = file.parts[std::size_t(here[i].ref.part)];
        found[i].frame = frame;
        found[i].part = part.name;
        found[i].channel = part.channels[std::size_t(here[i].ref.channel)].name;
        found[i].role = here[i].role;
        measure(pixels[here[i].ref], found[i]);
      });
      all.insert(all.end(), found.begin(), found.end());
    }
  }
  return all;
}

}  // namespace varve
