#include "compare_sequence.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "stages/heat_maps.h"
#include "stages/read_pair.h"
#include "stages/score_color.h"

namespace varve {
namespace {

/// Sums over the sequence of everything compared, by name.
struct Gathered {
  std::map<std::string, std::size_t> rows;  ///< name to index in Comparison::rows
  std::map<std::string, ChannelDifference> differences;
  std::map<std::string, std::unique_ptr<ColorScore>> colors;
};

/// Frames of each side; with a list, those of them that are on disk.
std::vector<int> frames_of(const SequencePattern& pattern, const std::vector<int>& wanted) {
  const std::vector<int> all = pattern.frames_on_disk();
  if (wanted.empty()) return all;
  std::vector<int> frames;
  std::ranges::set_intersection(all, wanted, std::back_inserter(frames));
  return frames;
}

void find_frames(const CompareJob& job, Comparison& c) {
  const std::vector<int> a = frames_of(job.a, job.frames), b = frames_of(job.b, job.frames);
  for (const auto& [side, frames, pattern] : {std::tuple("A", &a, &job.a), std::tuple("B", &b, &job.b)})
    if (frames->empty())
      throw Failure(ExitCode::input, std::string("no file of ") + side + " ('" + pattern->text() + "') is there" +
                                         (job.frames.empty() ? "" : " for the frames asked for") +
                                         "; check the pattern");
  std::ranges::set_intersection(a, b, std::back_inserter(c.frames));
  std::ranges::set_difference(a, b, std::back_inserter(c.only_a));
  std::ranges::set_difference(b, a, std::back_inserter(c.only_b));
  // A frame of the list that neither side has is missing on both.
  for (int frame : job.frames)
    if (!std::ranges::binary_search(a, frame) && !std::ranges::binary_search(b, frame)) {
      c.only_a.push_back(frame);
      c.findings.push_back({frame, 1, {"the frame is in neither A nor B", FindingKind::shape}});
    }
  if (c.frames.empty())
    c.reason = "A has frames " + format_frame_list(a) + " and B has " + format_frame_list(b) + ": none in common";
}

void add_finding(Comparison& c, int frame, const Finding& finding) {
  const auto same = std::ranges::find(c.findings, finding, &FrameFinding::finding);
  if (same == c.findings.end())
    c.findings.push_back({frame, 1, finding});
  else
    ++same->count;
}

ComparisonRow& row_of(Comparison& c, Gathered& g, const std::string& name, bool color) {
  const auto [at, added] = g.rows.try_emplace(name, c.rows.size());
  if (added) c.rows.push_back({name, color, std::vector<MetricValues>(c.frames.size()), {}});
  return c.rows[at->second];
}

void put_counts(MetricValues& values, const ChannelDifference& d) {
  values[MetricId::differing] = double(d.differing);
  values[MetricId::not_finite] = double(d.not_finite);
}

void put_difference(MetricValues& values, const ChannelDifference& d) {
  put_counts(values, d);
  values[MetricId::max] = d.greatest;
  values[MetricId::mean] = d.mean();
  values[MetricId::rmse] = d.rmse();
}

bool is_alpha(const FramePair& pair, const ChannelPair& channel) {
  return std::ranges::any_of(pair.match.subjects, [&](const SubjectPair& s) {
    return pair.a.subjects[s.a].color[3] == std::optional(channel.a);
  });
}

/// The color's row that a channel belongs to: the subject whose R, G or B it is; none for other channels.
const SubjectPair* subject_of(const FramePair& pair, const ChannelPair& channel) {
  for (const SubjectPair& subject : pair.match.subjects)
    for (std::size_t k = 0; k < 3; ++k)
      if (channel.color && pair.a.subjects[subject.a].color[k] == std::optional(channel.a)) return &subject;
  return nullptr;
}

/// Value by value; R, G and B are counted together, alpha and other channels have rows of their own.
void compare_values(const CompareJob& job, const FramePair& pair, const PairPixels& pixels, std::size_t index,
                    Comparison& c, Gathered& g, Workers& workers) {
  std::map<std::string, ChannelDifference> of_colors;
  for (const SubjectPair& subject : pair.match.subjects) row_of(c, g, subject.name, true);
  for (const ChannelPair& channel : pair.match.channels) {
    const ChannelDifference d = compare_channel(channel, pixels, job.nan_equal, workers);
    if (const SubjectPair* subject = subject_of(pair, channel)) {
      of_colors[subject->name] += d;
      continue;
    }
    const std::string name = is_alpha(pair, channel) ? "alpha " + channel.name : channel.name;
    put_difference(row_of(c, g, name, false).frames[index], d);
    g.differences[name] += d;
  }
  for (const auto& [name, d] : of_colors) {
    put_counts(row_of(c, g, name, true).frames[index], d);
    g.differences[name] += d;
  }
}

Step step_to(const CompareJob& job, const Comparison& c, std::size_t index) {
  if (std::ranges::find(job.cuts, c.frames[index]) != job.cuts.end()) return Step::cut;
  return index > 0 && c.frames[index] == c.frames[index - 1] + 1 ? Step::follows : Step::gap;
}

void compare_colors(const CompareJob& job, const FramePair& pair, const PairPixels& pixels, std::size_t index,
                    Comparison& c, Gathered& g, Workers& workers) {
  for (const SubjectPair& subject : pair.match.subjects) {
    ColorPair colors = color_pair(pair, subject, pixels, job.nan_equal, workers);
    if (!job.heat_folder.empty()) write_heat_maps(job, pair, subject, colors, workers);
    auto& score = g.colors[subject.name];
    if (!score) score = std::make_unique<ColorScore>(job);
    const Plane<glm::vec2> motion = pair_motion(pair, subject, pixels, workers);
    MetricValues values = score->add(std::move(colors), motion, step_to(job, c, index), workers);
    MetricValues& row = row_of(c, g, subject.name, true).frames[index];
    for (MetricId counted : {MetricId::differing, MetricId::not_finite}) values[counted] = row[counted];
    row = values;
  }
}

void finish_rows(Comparison& c, const Gathered& g, Workers& workers) {
  for (ComparisonRow& row : c.rows) {
    const auto difference = g.differences.find(row.name);
    if (row.color) row.sequence = g.colors.at(row.name)->sequence(workers);
    if (difference == g.differences.end()) continue;
    if (row.color)
      put_counts(row.sequence, difference->second);
    else
      put_difference(row.sequence, difference->second);
  }
}

}  // namespace

Comparison compare_sequence(const CompareJob& job, const CompareEvents& events) {
  Comparison c;
  find_frames(job, c);
  Workers workers(job.threads);
  Gathered gathered;
  const bool motion = job.metrics[std::size_t(MetricId::warped)];
  for (std::size_t i = 0; i < c.frames.size() && c.reason.empty(); ++i) {
    if (events.should_stop && events.should_stop()) throw Failure(ExitCode::interrupted, "the comparison was stopped");

    // Shape first.
    const FramePair pair = read_frame_pair(job, c.frames[i], motion);
    for (const Finding& finding : pair.match.findings) add_finding(c, c.frames[i], finding);
    if (!pair.match.incomparable.empty()) {
      c.reason = "frame " + std::to_string(c.frames[i]) + ": " + pair.match.incomparable;
      break;
    }

    // Then values, then what they look like.
    const PairPixels pixels = read_pixels(pair, workers);
    compare_values(job, pair, pixels, i, c, gathered, workers);
    compare_colors(job, pair, pixels, i, c, gathered, workers);
    if (events.frame) events.frame(int(i) + 1, int(c.frames.size()));
  }
  if (c.reason.empty()) finish_rows(c, gathered, workers);
  judge(c, job.limits);
  return c;
}

}  // namespace varve
