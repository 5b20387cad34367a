// A reading of vectors as a user gives it, and the conventions whose names it goes with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exr/vector_layers.h"
#include "motion/rank_hypotheses.h"

namespace varve {

/// Options that make a resolve read the channels so: "--convention nuke --map motion.x=a.u ...".
std::string reading_options(const VectorLayer& layer, const VectorHypothesis& hypothesis);

/// Rows of the convention table that read vectors so and whose layer and channel names these are.
std::vector<std::string> conventions_of_names(const VectorLayer& layer, const VectorHypothesis& hypothesis);

/// A reading among several that lead to the same places, taken because it is the only one that a convention with such
/// layer and channel names has.
struct NamedReading {
  VectorHypothesis hypothesis;
  std::string convention;
};

/// None where nothing is left open, where names fit none or several of what is left, or where what is left leads to
/// different places in these frames, is measured in its scale, or holds the jitter.
std::optional<NamedReading> reading_by_names(const VectorLayer& layer, const ChannelRanking& ranking);

}  // namespace varve
