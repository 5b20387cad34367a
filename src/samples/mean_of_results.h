// Samples that were each accumulated over time, put together to the pixel.
#pragma once

#include <span>

#include "resolve/accumulate.h"

namespace varve {

/// The mean of what came of each sample, companions alike; where some have nothing, of those that have. What they have
/// seen adds up: `total`, counts, and 1/spread as far as samples do not share it. Of the diagnostics, clip and weight
/// are means and the bits of reject are those of any sample. Pixels are counted sample by sample, not here. All have
/// one window; what only the gather fills stays empty.
Accumulated mean_of_results(std::span<const Accumulated* const> results, Workers& workers);

/// The mean of colors over one window: of predictions.
Plane<glm::vec4> mean_of_colors(std::span<const Plane<glm::vec4>* const> colors, Workers& workers);

}  // namespace varve
