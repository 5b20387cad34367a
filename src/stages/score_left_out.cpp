#include "stages/score_left_out.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "base/error.h"
#include "diagnose/aov.h"
#include "exr/convert.h"
#include "stages/read_pair.h"
#include "stages/write_resolved.h"

namespace varve {
namespace {

/// The diagnostic planes of one subject.
struct Planes {
  Plane<glm::vec4> prediction;
  Plane<std::uint32_t> reject;
};

ChannelRef channel_of(const FrameHeaders& headers, const Subject& subject, bool several, std::string_view aov,
                      std::string_view component) {
  const FileHeader& file = headers.files.front();
  const int part = part_of(subject);
  const std::string name = aov_channel(*find_aov(aov), subject, several, component);
  const std::optional<int> channel = file.parts[std::size_t(part)].channel(name);
  if (!channel) throw Failure(ExitCode::inconsistent, "'" + file.path + "' has no channel " + name);
  return {0, part, *channel};
}

Planes read_planes(const FrameHeaders& headers, const Subject& subject, bool several, const Window& window,
                   Workers& workers) {
  const std::vector<ChannelRef> refs = {channel_of(headers, subject, several, "prediction", "r"),
                                        channel_of(headers, subject, several, "prediction", "g"),
                                        channel_of(headers, subject, several, "prediction", "b"),
                                        channel_of(headers, subject, several, "reject", "")};
  const FramePixels pixels = read_channels(headers.files.front(), refs, workers);
  Planes planes{Plane<glm::vec4>(window, 0, glm::vec4(0.f)), Plane<std::uint32_t>(window)};
  workers.for_rows(window.y0, window.y1, [&](int y) {
    std::vector<float> row(std::size_t(window.width()));
    for (int k = 0; k < 3; ++k) {
      const RawPlane& raw = pixels[refs[std::size_t(k)]];
      to_float(raw.type, raw.row(y - window.y0), row.data(), row.size());
      for (std::size_t x = 0; x < row.size(); ++x) planes.prediction.row(y)[x][k] = row[x];
    }
    std::memcpy(planes.reject.row(y), pixels[refs[3]].row(y - window.y0), 4 * row.size());
  });
  return planes;
}

std::size_t count_not_finite(const Subject& subject, const FileSet& files) {
  std::size_t count = 0;
  for (int k = 0; k < 3; ++k) {
    const auto& ref = subject.color[std::size_t(k)];
    if (!ref) continue;
    const RawPlane& raw = files[std::size_t(ref->file)][*ref];
    std::vector<float> row(std::size_t(raw.columns));
    for (int y = 0; y < raw.rows; ++y) {
      to_float(raw.type, raw.row(y), row.data(), row.size());
      count += std::size_t(std::ranges::count_if(row, [](float v) { return !std::isfinite(v); }));
    }
  }
  return count;
}

CompareJob pair_job(const MeasureJob& job, const SequencePattern& output) {
  CompareJob compare;
  compare.a = job.resolve.input.color;
  compare.b = output;
  compare.motion = job.motion;
  compare.roles_a = compare.roles_b = job.resolve.roles;
  return compare;
}

}  // namespace

LeftOutScore score_left_out(const MeasureJob& job, const SequencePattern& output, const std::vector<int>& frames,
                            Workers& workers) {
  const CompareJob compare = pair_job(job, output);
  LeftOutScore score;
  std::vector<ColorPair> before;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FramePair pair = read_frame_pair(compare, frames[i], job.resolve.roles.convention != "none");
    const PairPixels pixels = read_pixels(pair, workers);
    const bool several = std::ranges::any_of(
        pair.b.subjects, [&](const Subject& s) { return s.layer != pair.b.subjects.front().layer; });
    const bool follows = i > 0 && frames[i] == frames[i - 1] + 1 &&
                         std::ranges::find(job.resolve.cuts, frames[i]) == job.resolve.cuts.end();
    std::vector<ColorPair> now;
    for (std::size_t k = 0; k < pair.match.subjects.size(); ++k) {
      const SubjectPair& subject = pair.match.subjects[k];
      const Subject& resolved = pair.b.subjects[subject.b];
      ColorPair colors = color_pair(pair, subject, pixels, false, workers);
      const Planes planes = read_planes(pair.b, resolved, several, subject.window, workers);
      score.leave_out += leave_out_error(colors.a, colors.bad, planes.prediction, planes.reject, workers);
      score.not_finite += count_not_finite(resolved, pixels.b);
      // Against black: all that changes along the motion, true change included, which is the same for every setting.
      colors.a.fill(glm::vec4(0.f));
      const Plane<glm::vec2> motion = pair_motion(pair, subject, pixels, workers);
      if (follows && k < before.size() && !motion.empty())
        score.unsteady += warped_residual(colors, before[k], motion, workers);
      now.push_back(std::move(colors));
    }
    before = std::move(now);
  }
  return score;
}

}  // namespace varve
