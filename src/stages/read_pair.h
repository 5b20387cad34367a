// One frame of both sequences as the metrics want it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/channel_difference.h"
#include "diagnose/color_pair.h"
#include "stages/match_channels.h"
#include "stages/read_present.h"

namespace varve {

/// Headers of one frame on both sides, and what belongs together.
struct FramePair {
  FrameHeaders a, b;
  FrameMatch match;
};

/// Reads headers. With `motion`, vectors are looked for as well; files whose vectors cannot be told by their names have
/// none then, and the findings say so.
FramePair read_frame_pair(const CompareJob& job, int frame, bool motion);

struct PairPixels {
  FileSet a, b;
};
/// Every channel that is to be compared, and the vectors.
PairPixels read_pixels(const FramePair& pair, Workers& workers);

/// How one channel differs, value by value in its own type.
ChannelDifference compare_channel(const ChannelPair& channel, const PairPixels& pixels, bool nan_equal,
                                  Workers& workers);

/// Both colors of a subject over its window. A single color channel stands for all three.
ColorPair color_pair(const FramePair& pair, const SubjectPair& subject, const PairPixels& pixels, bool nan_equal,
                     Workers& workers);

/// Backward motion over the subject's window in pixels, y down: B's vectors, else A's; empty when there are none.
Plane<glm::vec2> pair_motion(const FramePair& pair, const SubjectPair& subject, const PairPixels& pixels,
                             Workers& workers);

}  // namespace varve
