#include "stages/score_left_out.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "exr/convert.h"
#include "stages/read_pair.h"

namespace varve {
namespace {

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
    const bool follows = i > 0 && frames[i] == frames[i - 1] + 1 &&
                         std::ranges::find(job.resolve.cuts, frames[i]) == job.resolve.cuts.end();
    std::vector<ColorPair> now;
    for (std::size_t k = 0; k < pair.match.subjects.size(); ++k) {
      const SubjectPair& subject = pair.match.subjects[k];
      const Subject& resolved = pair.b.subjects[subject.b];
      ColorPair colors = color_pair(pair, subject, pixels, false, workers);
      score.not_finite += count_not_finite(resolved, pixels.b);
      const Plane<glm::vec2> motion = pair_motion(pair, subject, pixels, workers);
      const bool has_before = follows && k < before.size();
      if (has_before) score.leave_out += leave_out_error(colors.a, colors.bad, before[k].b, motion, workers);
      // Against black: all that changes along the motion, true change included, which is the same for every setting.
      colors.a.fill(glm::vec4(0.f));
      if (has_before && !motion.empty()) score.unsteady += warped_residual(colors, before[k], motion, workers);
      now.push_back(std::move(colors));
    }
    before = std::move(now);
  }
  return score;
}

}  // namespace varve
