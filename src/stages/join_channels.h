// Pairs of channels that hold the ways to both sides, ranked together.
#pragma once

#include <vector>

#include "motion/hypotheses.h"
#include "stages/probe_motion.h"

namespace varve {

/// Two channels that were judged by themselves.
struct JudgedChannels {
  const std::vector<FollowedPlace>* places;
  VectorReport* report;
};

/// Lets the channels of a subject settle each other, see settle_joined: Cycles' X, Y and Z, W; layers forward and
/// backward. The places of all are the same ones.
void join_channels(const std::vector<JudgedChannels>& judged);

}  // namespace varve
