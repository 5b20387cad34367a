// Several samples in each pixel: which subjects make one color, where it is written, and what the files lose by it.
#pragma once

#include <span>
#include <vector>

#include "exr/channel_names.h"
#include "exr/jitter.h"

namespace varve {

/// Of subjects that are samples (find_subjects() with RoleRequest::samples, or show_grid()): one color for all samples
/// of a layer in a view, written without the number in the name, in the part and the types of the sample that lies
/// nearest to the pixel center, or of the first where positions are not known. `jitter` has one entry for each subject.
std::vector<ColorOutput> sample_outputs(std::span<const Subject> subjects, const SampleRequest& request,
                                        std::span<const std::optional<Jitter>> jitter);

/// Channels of the samples in file 0: those of the one that lends its place are passed on without the number in their
/// name, those of the others are dropped.
PassedOn passed_on_of_samples(const FileHeader& file, std::span<const ColorOutput> outputs,
                              std::span<const Subject> subjects, const SampleRequest& request);

/// Throws Failure(inconsistent), naming the remedy, when samples of one color differ: in their windows, in the channels
/// they have, or in what --channels names.
void check_samples_alike(const FileHeader& file, std::span<const ColorOutput> outputs,
                         std::span<const Subject> subjects);

}  // namespace varve
