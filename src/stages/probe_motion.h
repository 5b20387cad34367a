// Motion measured from pairs of frames, held against what is stored: `varve probe --motion`, and what a resolve checks.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exr/vector_layers.h"
#include "motion/rank_hypotheses.h"
#include "motion/vector_census.h"
#include "plan/resolve_job.h"

namespace varve {

/// A pair of frames that was looked at.
struct MotionPair {
  int frame = 0, earlier = 0;
  std::size_t textured = 0, followed = 0, moving = 0;  ///< places
  bool jitter_known = false;
};

/// What marks of surfaces say: pixels whose vector leads to another id or depth than rest does.
struct MarkVotes {
  std::size_t decided = 0, won = 0;  ///< the vector leads to the pixel's own id or depth, rest does not
};

/// Two channels of a layer, judged.
struct VectorReport {
  ChannelRanking ranking;
  VectorCensus census;
  bool picture_moves = false;                      ///< a third of all places that are found again moved
  double rest_residual = -1, floor_residual = -1;  ///< median patch_difference without motion, and at the best match
  MarkVotes ids, depths;                           ///< of the first of the ranking against rest
  std::optional<RankedHypothesis> given;           ///< what names or options say, where they say anything
  VectorVotes given_against_rest, first_against_given;
  std::vector<std::string> findings;  ///< sentences: zero, constant, clamped, ...
};

/// Vectors of one subject.
struct VectorLayerReport {
  std::string subject, view;
  VectorLayer layer;
  std::vector<VectorReport> channels;  ///< pairs of channels
};

struct MotionReport {
  std::vector<MotionPair> pairs;  ///< of the first subject
  Window display;
  std::vector<VectorLayerReport> layers;
  std::vector<std::string> notes;
};

/// How much is looked at.
struct MotionProbe {
  int pairs = 6;      ///< of neighboring frames, spread over the sequence
  int places = 600;   ///< in each frame
  bool marks = true;  ///< ids and depths too
};

/// Places of the first subject with what each layer stores for them: what a ranking is made from.
struct FollowedLayer {
  VectorLayer layer;
  std::vector<FollowedPlace> places;
};
struct FollowedFrames {
  std::vector<std::pair<int, int>> pairs;  ///< earlier, later frame of FollowedPlace::pair
  Window display;
  std::vector<FollowedLayer> layers;
};
FollowedFrames follow_frames(const ResolveJob& job, const std::vector<int>& frames, const MotionProbe& probe,
                             Workers& workers);

/// Looks at pairs of neighboring frames among `frames`. Reads what it needs and nothing else. Never throws for want of
/// evidence: the report says so.
MotionReport probe_motion(const ResolveJob& job, const std::vector<int>& frames, const MotionProbe& probe,
                          Workers& workers);

/// Headers of a frame with the vectors that names or options tell; none where they do not fit together. `refusal` is
/// the sentence that refuses vectors whose meaning nothing tells: the pixels may.
std::optional<FrameHeaders> told_by_names(const ResolveJob& job, int frame, const JitterSource& jitter,
                                          std::string* refusal = nullptr);

/// A request that finds no vectors, and so refuses none.
RoleRequest without_vectors(RoleRequest roles);

/// For people, and as a JSON object with the same facts:
///   pairs   [{frame, earlier, textured, followed, moving, jitter_known}]
///   layers  [{layer, view, vectors, channels: [{x, y, finding, confidence, conventions: [text], hypotheses: [{text,
///           direction, unit, bias, scale, scale_deviation, scale_x, scale_y, sign_x, sign_y, swapped, jitter, score,
///           agreement, off, residual, rival, decided, won}], rest: {agreement, off, residual}, floor: residual,
///           by_names: convention or null, same_here, joined, open: [text], findings: [text]}]}]
///   notes   [text]
std::string motion_text(const MotionReport& report);
std::string motion_json(const MotionReport& report);

/// What was found for two channels, in one sentence without a stop.
std::string verdict_text(const VectorLayer& layer, const VectorReport& report, const Window& display);

}  // namespace varve
