// Several samples in each pixel of one frame become one, before time comes in (Salvi 2016; math, section 7.1).
#pragma once

#include "resolve/choices.h"
#include "samples/mean_color.h"

namespace varve {

/// One present from the samples of each pixel, which have one window and the same planes. Color, companions and masks
/// are the mean of the samples that are valid, so whatever follows costs what it costs for one sample. Vectors, depth,
/// id and normal are those of one sample, never a mean: the one with the longest vector in pixels, of equal ones the
/// nearest, then the first; samples without weight or without a finite vector take no part where others do.
///
/// With a filter and the jitter of every sample known, color and companions are reconstructed at the pixel centers from
/// all samples around, those of neighboring pixels included, as weigh_samples() does with one; `sample_weight` of the
/// result says from how much, and its jitter is none. Without, a mean of samples stands for their mean position, which
/// is the jitter of the result; none where one of theirs is not known.
/// `show`: Present::combined says which sample, counted from 1, each pixel follows.
/// A single sample comes back with the same values. Reads a border of 3 pixels with a filter.
Present resolve_samples(Samples samples, SampleFilter filter, Workers& workers, bool show = false);

}  // namespace varve
