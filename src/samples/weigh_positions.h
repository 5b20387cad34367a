// Samples of a pixel and of those around it, weighed by where each of them lies (math, sections 5 and 7.1).
#pragma once

#include "resolve/choices.h"
#include "samples/mean_color.h"

namespace varve {

/// Weight of the sample of a pixel in that pixel itself.
double position_weight(SampleFilter filter, glm::dvec2 jitter);

/// Color, companions and sample_weight of `out`: sum w c / sum w over the samples at p + 0.5 + jitter around each pixel
/// center, and sum w divided by `whole`, the number of samples: 1 on average over all jitters. Invalid samples have no
/// part. Where a kernel with negative lobes leaves less than a tenth, its positive part is used; where there is
/// nothing, the samples' mean. The jitter of every sample must be known. Reads a border of 3 pixels.
void weigh_positions(Samples samples, SampleFilter filter, Present& out, Workers& workers, double whole);

}  // namespace varve
