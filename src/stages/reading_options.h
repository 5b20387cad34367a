// A reading of vectors as a user gives it, and the conventions whose names it goes with.
#pragma once

#include <string>
#include <vector>

#include "exr/vector_layers.h"
#include "motion/hypotheses.h"

namespace varve {

/// Options that make a resolve read the channels so: "--convention nuke --map motion.x=a.u ...".
std::string reading_options(const VectorLayer& layer, const VectorHypothesis& hypothesis);

/// Rows of the convention table that read vectors so and whose layer and channel names these are.
std::vector<std::string> conventions_of_names(const VectorLayer& layer, const VectorHypothesis& hypothesis);

}  // namespace varve
