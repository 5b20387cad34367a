// What the plan says of the two-sided accumulator.
#pragma once

#include <string>

#include "plan/plan.h"

namespace varve {

/// Where the vectors come from that lead ahead and back. `share` names how many layers lack one direction.
PlannedPass motion_of_both_sides(bool moves, bool inverted, bool with_depth, bool tested, const std::string& share);

/// How far each frame reaches, and what waiting for the future takes.
PlannedPass past_and_future(const Parameters& parameters, const OutputRequest& output);

/// How the sides are weighed.
std::string blend_of_both_sides(const Parameters& parameters);

/// Bytes per pixel that the future of a block takes until the past arrives; 0 when a file holds it.
std::size_t waiting_bytes_per_pixel(const Parameters& parameters, const OutputRequest& output);

}  // namespace varve
