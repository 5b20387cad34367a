#include "stages/settle_vectors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/error.h"
#include "motion/patch_match.h"
#include "stages/motion_pair.h"
#include "stages/probe_motion.h"
#include "stages/reading_options.h"

namespace varve {
namespace {

constexpr int kCheckedPairs = 2;
constexpr int kPlaces = 400;
constexpr double kSuspicious = 0.4;  // of the places, nearer by the vectors than by no motion
constexpr double kConfident = 0.6;   // of ChannelRanking::confidence

std::string frames_text(const std::vector<MotionPair>& pairs) {
  std::string text;
  for (const MotionPair& pair : pairs)
    text += (text.empty() ? "" : ", ") + std::to_string(pair.earlier) + "-" + std::to_string(pair.frame);
  return text;
}

std::string pair_text(const VectorLayer& layer, const VectorReport& report) {
  return layer.names[std::size_t(report.ranking.x)] + ", " + layer.names[std::size_t(report.ranking.y)];
}

/// The readings that are left: the first one and its rivals.
std::vector<VectorHypothesis> left(const ChannelRanking& ranking) {
  std::vector<VectorHypothesis> readings;
  for (std::size_t i = 0; i < ranking.ranking.size(); ++i)
    if (i == 0 || ranking.ranking[i].rival) readings.push_back(ranking.ranking[i].hypothesis);
  return readings;
}

/// A reading that can be followed, and why it was taken among others.
struct Choice {
  VectorHypothesis hypothesis;
  std::string reason;
};

// Without a doubt, or the only one among those left that a renderer with such channel names is known to write.
std::optional<Choice> choose(const VectorLayer& layer, const VectorReport& report) {
  const ChannelRanking& ranking = report.ranking;
  if (ranking.finding == VectorFinding::found) {
    const RankedHypothesis& first = ranking.ranking.front();
    // A measured scale has to bring the longest vectors to within a tenth of a pixel.
    const double error = 2 * first.scale.deviation / std::max(first.scale.scale, 1e-30);
    if (ranking.confidence < kConfident || first.hypothesis.jitter != 0) return std::nullopt;
    if (first.hypothesis.scale_free && error > 0.005) return std::nullopt;
    return Choice{first.hypothesis, "the other readings lose"};
  }
  const std::optional<NamedReading> named = reading_by_names(layer, ranking);
  if (!named) return std::nullopt;
  return Choice{named->hypothesis,
                "of the readings that lead to the same places in these frames, it is the only one that goes with the "
                "names of the channels (" +
                    named->convention + ")"};
}

void apply(const VectorLayer& layer, const VectorHypothesis& h, RoleRequest& roles) {
  const bool previous = h.encoding.direction == MotionDirection::previous;
  const std::string role = previous ? "motion" : "forward";
  roles.map.push_back({role + ".x", layer.names[std::size_t(h.x)]});
  roles.map.push_back({role + ".y", layer.names[std::size_t(h.y)]});
  // The plainest row, with everything that was found put over it.
  roles.convention = "varve";
  roles.encoding = h.encoding;
  roles.override_bias = roles.override_scale = roles.override_shutter = roles.override_sign_x = roles.override_sign_y =
      roles.override_unit = true;
}

/// The reading to advise: one that goes with the names of the channels, if there is one among those left.
VectorHypothesis advised(const VectorLayer& layer, const ChannelRanking& ranking) {
  for (const VectorHypothesis& h : left(ranking))
    if (!conventions_of_names(layer, h).empty()) return h;
  return ranking.ranking.front().hypothesis;
}

/// Whose pixels are nearer along stored vectors than at rest.
VectorVotes look_along(const FrameVectors& from, const FrameVectors& to, const VectorHypothesis& h,
                       const glm::dvec2& jitter, Workers& workers) {
  VectorVotes votes;
  const bool previous = h.encoding.direction == MotionDirection::previous;
  const double turn = previous ? 1 : -1;
  const Window &a = from.present.color.window(), &b = to.present.color.window();
  if (std::min({a.width(), a.height(), b.width(), b.height()}) < 2 * kPatchRadius + 3) return votes;
  const double middle = middle_brightness(from.present.color);
  const TonePyramid here = tone_pyramid(from.present.color, middle, workers, 1);
  const TonePyramid there = tone_pyramid(to.present.color, middle, workers, 1);
  const std::vector<double> ranges = ranges_of(from.values.front());
  for (const Place& place : textured_places(here.fine(), kPlaces, workers)) {
    FollowedPlace stored;
    (previous ? stored.here : stored.there) = values_at(from.values.front(), ranges, place.x, place.y, kPatchRadius);
    const glm::dvec2 by = predicted(h, stored, from.display);
    const double squared = by.x * by.x + by.y * by.y;
    if (!(squared > 1) || !(squared < 1e12)) continue;
    const std::optional<double> along =
        patch_difference(here.fine(), place.x, place.y, there.fine(), turn * (by + jitter));
    const std::optional<double> sampled = patch_difference(here.fine(), place.x, place.y, there.fine(), turn * jitter);
    const std::optional<double> rest = patch_difference(here.fine(), place.x, place.y, there.fine(), glm::dvec2(0));
    if (!sampled || !rest) continue;
    // Vectors that leave the picture are as right as others, but not those that fly past it.
    const bool flies = std::abs(by.x) > 0.5 * a.width() || std::abs(by.y) > 0.5 * a.height();
    if (!along && !flies) continue;
    ++votes.decided;
    votes.won += along && *along < std::min(*sampled, *rest);
  }
  return votes;
}

bool suspicious(const VectorVotes& votes) {
  return votes.decided >= kFewestPlaces && double(votes.won) < kSuspicious * double(votes.decided);
}

VectorHypothesis hypothesis_of(const MotionEncoding& encoding, MotionDirection direction) {
  VectorHypothesis h;
  h.encoding = encoding;
  h.encoding.direction = direction;
  return h;
}

/// Looks along the vectors of one subject in one pair; the worse of both directions where both are stored.
VectorVotes look_at_pair(const FrameHeaders& earlier, const FrameHeaders& later, std::size_t k,
                         const MotionParameters& motion, Workers& workers) {
  const Subject& subject = later.subjects[k];
  const bool forward = earlier.subjects[k].forward.has_value();
  const auto read = [&](const FrameHeaders& headers, const std::optional<VectorChannels>& vectors) {
    VectorNeeds needs;
    needs.vectors = false;
    needs.only = vectors;
    return read_frame_vectors(headers, k, motion, needs, workers);
  };
  const FrameVectors now = read(later, subject.backward);
  const FrameVectors before = read(earlier, earlier.subjects[k].forward);
  const glm::dvec2 jitter = later.jitter && earlier.jitter
                                ? glm::dvec2(later.jitter->x - earlier.jitter->x, later.jitter->y - earlier.jitter->y)
                                : glm::dvec2(0);
  VectorVotes worst;
  const auto take = [&](const VectorVotes& votes) {
    if (worst.decided == 0 || (votes.decided > 0 && votes.won * worst.decided < worst.won * votes.decided))
      worst = votes;
  };
  if (subject.backward)
    take(look_along(now, before, hypothesis_of(subject.backward_encoding, MotionDirection::previous), jitter, workers));
  if (forward)
    take(look_along(before, now, hypothesis_of(earlier.subjects[k].forward_encoding, MotionDirection::next), jitter,
                    workers));
  return worst;
}

// What the pixels of more frames say once the first looks were strange.
void find_out(const ResolveJob& job, const SequenceInfo& info, const VectorVotes& seen, const std::string& where,
              const std::function<void(const std::string&)>& warning, Workers& workers) {
  const MotionReport report = probe_motion(job, info.frames, {.pairs = 4, .marks = false}, workers);
  for (const VectorLayerReport& layer : report.layers)
    for (const VectorReport& channels : layer.channels) {
      if (!channels.given || channels.ranking.ranking.empty()) continue;
      const VectorFinding finding = channels.ranking.finding;
      const VectorVotes& given = channels.given_against_rest;
      const bool worse = given.decided >= kFewestPlaces && double(given.won) < kSuspicious * double(given.decided);
      if ((finding != VectorFinding::found && finding != VectorFinding::ambiguous) || !worse ||
          !(channels.first_against_given.at_least > kConfident))
        continue;
      throw Failure(ExitCode::inconsistent,
                    "the vectors " + pair_text(layer.layer, channels) + ", read as convention " +
                        info.first.subjects.front().convention + " says (" + words_of(channels.given->hypothesis) +
                        "), lead farther from where the pixels came from than no motion does, at " +
                        std::to_string(given.decided - given.won) + " of " + std::to_string(given.decided) +
                        " places in frames " + frames_text(report.pairs) +
                        "; the pixels say: " + verdict_text(layer.layer, channels, report.display) + "; give " +
                        reading_options(layer.layer, advised(layer.layer, channels.ranking)) +
                        ", or --check-motion off to go on as it is");
    }
  if (warning)
    warning("the vectors lead to pixels that are less like than those at rest at " +
            std::to_string(seen.decided - seen.won) + " of " + std::to_string(seen.decided) + " places in " + where +
            ", and no other reading of them fits better; varve probe --motion tells more");
}

}  // namespace

SettledVectors settle_vectors(const ResolveJob& job) {
  SettledVectors settled{job, ""};
  if (job.roles.convention != "auto") return settled;
  const std::vector<int> on_disk = job.input.color.frames_on_disk();
  if (on_disk.empty()) return settled;  // told by whoever reads them
  const int shown = job.frames.empty() ? on_disk.front() : job.frames.front();
  const JitterSource jitter = parse_jitter_source(job.jitter);
  std::string refusal;
  told_by_names(job, shown, jitter, &refusal);
  if (refusal.empty()) return settled;  // told, or refused for something else

  Workers workers(job.threads);
  const MotionReport report = probe_motion(job, on_disk, {.marks = true}, workers);
  std::string said;
  std::set<std::string> layers;
  for (const VectorLayerReport& layer : report.layers) layers.insert(layer.layer.name);
  bool chosen = false;
  if (report.layers.size() == 1)
    for (const VectorReport& channels : report.layers.front().channels) {
      const VectorLayer& layer = report.layers.front().layer;
      said += (said.empty() ? "" : "; ") + verdict_text(layer, channels, report.display);
      const std::optional<Choice> choice = chosen ? std::nullopt : choose(layer, channels);
      if (!choice) continue;
      chosen = true;
      apply(layer, choice->hypothesis, settled.job.roles);
      settled.note = "motion: " + layer.names[std::size_t(choice->hypothesis.x)] + ", " +
                     layer.names[std::size_t(choice->hypothesis.y)] + " lead " + words_of(choice->hypothesis) +
                     ", found from the pixels of frames " + frames_text(report.pairs) + ": " + choice->reason;
    }
  else
    said = report.layers.empty()
               ? std::string("there are no pairs of frames to look at")
               : "there are vectors of " + std::to_string(layers.size()) +
                     " layers, and each needs a --convention of its own; varve probe --motion ranks them";
  for (const std::string& note : report.notes)
    if (report.pairs.empty()) said += "; " + note;
  if (!chosen) throw Failure(ExitCode::inconsistent, refusal + "; the pixels say: " + said);
  return settled;
}

void check_vectors(const ResolveJob& job, const SequenceInfo& info,
                   const std::function<void(const std::string&)>& warning, Workers& workers) {
  const JitterSource jitter = parse_jitter_source(job.jitter);
  VectorVotes strange;
  std::string where;
  int looked = 0;
  for (const auto& [first, second] : frame_pairs(info.frames, kCheckedPairs)) {
    const FrameHeaders earlier = read_frame_headers(job.input, first, job.roles, jitter);
    const FrameHeaders later = read_frame_headers(job.input, second, job.roles, jitter);
    bool any = false;
    for (std::size_t k = 0; k < std::min(earlier.subjects.size(), later.subjects.size()); ++k) {
      if (!later.subjects[k].backward && !earlier.subjects[k].forward) continue;
      const VectorVotes votes = look_at_pair(earlier, later, k, job.parameters.motion, workers);
      if (!suspicious(votes)) continue;
      any = true;
      strange = votes;
      where = "frames " + std::to_string(first) + " and " + std::to_string(second);
    }
    if (!any) return;  // one pair that is as it should be suffices: a cut or a frozen frame is strange, too
    ++looked;
  }
  if (looked > 0) find_out(job, info, strange, where, warning, workers);
}

}  // namespace varve
