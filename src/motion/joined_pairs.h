// Two pairs of channels, one to the previous and one to the next frame: which is which, told by the vectors themselves.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "motion/hypotheses.h"
#include "motion/rank_hypotheses.h"

namespace varve {

/// What two pairs say of each other. The way from this frame back to the earlier one is the way from there to here
/// turned round: the pair that leads to the previous frame holds in this frame what the other one holds in the earlier
/// frame, but for the sign. That is exact where the pixels are not, so a hundredth of a pixel of acceleration tells.
struct JoinedPairs {
  std::size_t decided = 0, won = 0;  ///< places that tell, and those of them that say so
  double at_least = 0;               ///< lower bound of the share, see VectorVotes
  bool tells = false;                ///< without doubt, and in no pair of frames otherwise
  bool first_previous = false;       ///< the first pair leads to the previous frame, the second to the next; or turned
  bool negated = false;              ///< both have the same sign, as in Cycles: one of them is turned round
};

/// `first` and `second`: channels (x, y) of the places. `bias`: what both hold at rest.
JoinedPairs join_pairs(const std::vector<FollowedPlace>& places, std::pair<int, int> first, std::pair<int, int> second,
                       double bias);

/// Takes from both rankings the readings that no reading of the other pair goes with: same unit, bias, scale (to a
/// percent) and order of channels, the other direction, and the sign as the pairs show. Where one is left of what was
/// ambiguous, it is found. Leaves both as they are where nothing would be left.
void settle_joined(ChannelRanking& first, ChannelRanking& second, const JoinedPairs& joined);

}  // namespace varve
