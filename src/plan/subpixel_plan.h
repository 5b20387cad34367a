// What the plan says of the sub-pixel histories, and of the bounds that hold for them and for the single history.
#pragma once

#include <string>
#include <vector>

#include "plan/plan.h"

namespace varve {

/// Passes of the four histories in running order, in place of those of the single one from the window test to the
/// blend. Sets what they read, and notes quarters of the pixel that no frame visits.
std::vector<PlannedPass> subpixel_passes(const SequenceInfo& info, const Parameters& parameters, Plan& plan);

/// The bounds on blur and residual, of either accumulator that has them.
PlannedPass bounds_pass(const Parameters& parameters);

/// Throws Failure for what the four histories cannot do, and for bounds where no weight of the present is chosen.
void check_subpixel(const SequenceInfo& info, const Parameters& parameters);

/// Bytes that a pixel takes in the four histories, beside a present and the picture.
std::size_t subpixel_bytes_per_pixel(const Parameters& parameters, std::size_t companions);

/// Nanoseconds per pixel, one thread.
double subpixel_nanoseconds(const Parameters& parameters, std::size_t companions);

}  // namespace varve
