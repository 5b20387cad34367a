// Which reading of stored vectors the pixels speak for, and whether they tell at all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "motion/hypotheses.h"
#include "motion/rough_reading.h"

namespace varve {

/// Two hypotheses at the places where they lead apart measurably (0.3 px and 1 % of the way): each place is a vote for
/// the nearer one. Places beside each other are not independent, so only a third of the votes counts as evidence.
struct VectorVotes {
  std::size_t decided = 0, won = 0;
  double at_least = 0;  ///< lower 99 % bound (Wilson) of the share of votes that the first one wins; 0 without votes
};

/// How far the measurements lie from where the first hypothesis leads towards where the second does: 0 says the first,
/// 1 the second. Least squares over all places, so that differences far below a pixel count, too, where there are many.
struct Pull {
  double share = 0.5;
  double deviation = 1e9;  ///< standard deviation of the share: the larger of what places and what pairs of frames show
};

/// What the pixels say about two channels.
enum class VectorFinding {
  found,          ///< one hypothesis, and every other one is beaten
  rough,          ///< the vectors follow the motion, but no constant scale brings them onto it; rivals may be left
  ambiguous,      ///< the best one has rivals that lead to the same places in these frames
  contradictory,  ///< pairs of frames, or parts of the picture, speak for different hypotheses
  nothing,        ///< no hypothesis agrees with the motion of most places
  untestable,     ///< too few places that can be followed and move
};

struct RankedHypothesis {
  VectorHypothesis hypothesis;
  Fit fit;
  FoundScale scale;                        ///< where the scale was open
  VectorVotes first_against;               ///< the first of the ranking against this one
  Pull pull;                               ///< from the first towards this one, where votes do not decide
  std::size_t alone = 0, first_alone = 0;  ///< of a rival: places that agree with it alone, and with the first alone
  bool rival = false;                      ///< not told from the first one
  double apart = 1;                        ///< share of the places that move where it leads elsewhere than the first
  std::vector<PairScale> scales;           ///< of a rough reading: the factors of each pair of frames
  double residual = -1;  ///< median patch_difference along its vectors over places that move; -1 where not measured
};

struct ChannelRanking {
  int x = 0, y = 1;  ///< channels of the group
  VectorFinding finding = VectorFinding::untestable;
  std::vector<RankedHypothesis> ranking;  ///< best first, rivals right behind it
  Fit rest;                               ///< no motion at all
  VectorVotes against_rest;
  double confidence = 0;  ///< 0..1: least of the bounds by which the first beats every hypothesis that is no rival, and
                          ///< rest; 0 unless one is found
  double lead = 0;        ///< the same bound whatever is left open
  bool joined = false;    ///< readings were taken out by another pair of channels, see settle_joined
  std::vector<int> contradicting;  ///< pairs of frames that speak for another hypothesis
  std::vector<int> not_following;  ///< pairs of frames where no motion fits better than the vectors
  std::size_t without_vector = 0;  ///< places that move but hold what they would at rest
};

/// Wilson's lower bound for a share, 99 % one-sided.
double lower_bound(double won, double of);

/// Share of places up to which two readings lead to the same places here: the others are measured at a wrong place or
/// lie where motion ends.
inline constexpr double kSameHere = 0.05;

/// Whether all that is left leads to the same places in these frames (to 0.3 px and 1 % of the way).
bool same_here(const ChannelRanking& ranking);

/// Least number of places that move for anything to be said.
inline constexpr std::size_t kFewestPlaces = 40;

VectorVotes votes_between(const VectorHypothesis& first, const VectorHypothesis& second,
                          const std::vector<FollowedPlace>& places, const Window& display);
Pull pull_between(const VectorHypothesis& first, const VectorHypothesis& second,
                  const std::vector<FollowedPlace>& places, const Window& display);
VectorVotes votes_against_rest(const VectorHypothesis& hypothesis, const std::vector<FollowedPlace>& places,
                               const Window& display);

/// Ranks all hypotheses for the channels x and y of the places.
ChannelRanking rank_hypotheses(const std::vector<FollowedPlace>& places, int x, int y, const Window& display);

/// Rows of the convention table that read vectors of that direction so.
std::vector<std::string_view> conventions_like(const MotionEncoding& encoding);

/// What the rivals of the first leave open: "direction", "sign of y", ...
std::vector<std::string> left_open(const ChannelRanking& ranking);

}  // namespace varve
