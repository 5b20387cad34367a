// A sequence and its plan as text for people, and as JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "plan/plan.h"

namespace varve {

std::string describe_text(const SequenceInfo& info, const Plan& plan, const std::vector<ChannelStatistics>& statistics);
std::string describe_json(const SequenceInfo& info, const Plan& plan, const std::vector<ChannelStatistics>& statistics);

}  // namespace varve
