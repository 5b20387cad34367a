// Further samples of a frame, read from files of their own.
#pragma once

#include <functional>
#include <vector>

#include "plan/extra_samples.h"
#include "stages/source_frame.h"

namespace varve {

/// For each output of the frame its further samples: presents of the window of the frame's own, valid where a crop has
/// a sample and like the frame's own elsewhere. Crops of one position that do not overlap share one; `compact`: only
/// where they lie close together, and presents have the window of their crops. `own`: the
/// presents of the frame's subjects, with what cameras had to add. `move` is called with what a present has of crops
/// only and the place of its subject, before the rest is filled in. Throws what reading throws, naming file and frame.
std::vector<std::vector<Present>> read_extras(const SourceOptions& options, const FrameHeaders& headers,
                                              const std::vector<Present>& own, const ReadOptions& read,
                                              const ChannelNeeds& needs, bool compact,
                                              const std::function<void(Present&, std::size_t subject)>& move,
                                              Workers& workers);

}  // namespace varve
