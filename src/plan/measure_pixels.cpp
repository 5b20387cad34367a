// The pixels of a few frames in numbers, for `probe --pixels`.

#include <algorithm>
#include <cmath>

#include "exr/convert.h"
#include "exr/read_deep.h"
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

/// Values met so far; the mean is their sum until finish().
struct Measurement {
  ChannelStatistics& statistics;
  std::vector<float> values;

  void add(float value) {
    ++statistics.pixels;
    if (!std::isfinite(value)) {
      ++statistics.not_finite;
      return;
    }
    const double v = value;
    const bool first = statistics.pixels == statistics.not_finite + 1;
    statistics.zero += v == 0;
    statistics.least = first ? v : std::min(statistics.least, v);
    statistics.greatest = first ? v : std::max(statistics.greatest, v);
    statistics.mean += v;
  }
  void add(PixelType type, const std::byte* from, std::size_t count) {
    values.resize(count);
    to_float(type, from, values.data(), count);
    for (const float value : values) add(value);
  }
  void finish() {
    if (statistics.pixels > statistics.not_finite) statistics.mean /= double(statistics.pixels - statistics.not_finite);
  }
};

// Rows in order, so that the sum does not depend on threads.
void measure(const RawPlane& plane, ChannelStatistics& statistics) {
  Measurement measurement{statistics, {}};
  for (int y = 0; y < plane.rows; ++y) measurement.add(plane.type, plane.row(y), std::size_t(plane.columns));
  measurement.finish();
}

// Samples of a deep part instead of pixels, and how many a pixel has. One thread, for the same reason.
void measure_deep(const FileHeader& file, int part, const std::vector<RoleChannel>& channels, int frame,
                  std::vector<ChannelStatistics>& all) {
  const Part& described = file.parts[std::size_t(part)];
  std::vector<RoleChannel> here;
  for (const RoleChannel& channel : channels)
    if (channel.ref.part == part) here.push_back(channel);
  if (here.empty()) return;
  const auto row = [&](const std::string& channel, const std::string& role) {
    ChannelStatistics statistics;
    statistics.frame = frame;
    statistics.part = described.name;
    statistics.channel = channel;
    statistics.role = role;
    return statistics;
  };
  std::vector<ChannelStatistics> found;
  for (const RoleChannel& channel : here)
    found.push_back(row(described.channels[std::size_t(channel.ref.channel)].name, channel.role));
  std::vector<Measurement> measurements;
  for (ChannelStatistics& statistics : found) measurements.push_back({statistics, {}});
  ChannelStatistics counts = row("samples per pixel", "deep");
  Measurement counted{counts, {}};
  Workers one(1);
  read_deep(file, part, {}, one, [&](const DeepLine& line, int) {
    for (std::size_t i = 0; i < here.size(); ++i) {
      const std::size_t c = std::size_t(here[i].ref.channel);
      measurements[i].add(described.channels[c].type, line.samples[c], line.count());
    }
    for (std::size_t x = 0; x < line.pixels(); ++x) counted.add(float(line.first[x + 1] - line.first[x]));
  });
  for (Measurement& measurement : measurements) measurement.finish();
  counted.finish();
  all.insert(all.end(), found.begin(), found.end());
  all.push_back(counts);
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
      std::vector<RoleChannel> deep;
      const FileHeader& file = headers.files[std::size_t(f)];
      for (const RoleChannel& channel : wanted) {
        if (channel.ref.file != f) continue;
        if (is_deep(file.parts[std::size_t(channel.ref.part)])) {
          deep.push_back(channel);
        } else {
          here.push_back(channel);
          refs.push_back(channel.ref);
        }
      }
      for (int part = 0; !deep.empty() && part < int(file.parts.size()); ++part)
        measure_deep(file, part, deep, frame, all);
      if (here.empty()) continue;
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
