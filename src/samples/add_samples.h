// Samples that only some pixels have beside the one that all have.
#pragma once

#include <vector>

#include "resolve/choices.h"
#include "resolve/present.h"

namespace varve {

/// `first` with `further` samples of some of its pixels: presents of its window with the same planes, valid where they
/// are samples and like `first` elsewhere. As resolve_samples(), but that pixels without any of them stay as they are,
/// bit for bit, and that a pixel of n samples counts n: `sample_weight` is their number, or with a filter (each jitter
/// must be known then) the sum of their weights, `color` their mean, and `reconstructed` what the filter makes of them.
/// The jitter is that of `first`. Reads a border of 3 pixels with a filter.
Present add_samples(Present first, const std::vector<Present>& further, SampleFilter filter, Workers& workers);

}  // namespace varve
