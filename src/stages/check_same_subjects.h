// What one frame has, the next must have as well.
#pragma once

#include "plan/plan.h"

namespace varve {

/// Frames of a sequence must agree on what is resolved and on what that takes; windows may move. Throws
/// Failure(inconsistent) naming the frame, what differs and the remedy.
void check_same_subjects(const FrameHeaders& first, const FrameHeaders& now, const Plan& plan);

}  // namespace varve
