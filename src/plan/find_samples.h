// The samples of each pixel, from the headers of a frame.
#pragma once

#include <span>

#include "exr/read_frame.h"
#include "plan/probe.h"

namespace varve {

/// Fills what `headers.files` say of samples, as `roles.samples` asks: subjects, one for each sample, the outputs that
/// they make, where each of them lies in its pixel, and what of the files is used up. A grid of samples is shown as if
/// it were that many parts. Throws what find_subjects, choose_samples and check_samples_alike throw, and Failure(usage)
/// where --channel-weights own would make subjects of their own.
void find_samples(FrameHeaders& headers, const RoleRequest& roles, const JitterSource& jitter);

/// read_channels() of file `file` of a frame, whose pixels may be shown as cells of a grid.
FramePixels read_shown_channels(const FrameHeaders& headers, int file, std::span<const ChannelRef> channels,
                                Workers& workers);

}  // namespace varve
