// What cameras are used for.
#pragma once

#include "plan/plan.h"

namespace varve {

/// True for a subject (of info.first) that has depth, no vectors, and a camera in every frame: its vectors are made.
bool is_moved_by_camera(const SequenceInfo& info, const Subject& subject);
/// How many are.
std::size_t moved_by_camera(const SequenceInfo& info);

/// Decides plan.use_cameras, adds notes.
PlannedPass camera_pass(const SequenceInfo& info, const Parameters& parameters, Plan& plan);

}  // namespace varve
