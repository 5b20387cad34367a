// How far history lags behind the present: the difference, averaged with its sign, so that noise and aliasing cancel
// and a change of the light does not (Yang et al. 2009).
#pragma once

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Present minus history, red, green and blue, and in a the greatest magnitude among them both, which is the scale; a
/// is 0 and so is the rest where one of them is missing or both are black.
glm::vec4 difference_to(const glm::vec4& present, const glm::vec4& history);

/// |sum of differences| over the sum of scales, in the window of that many pixels around each; the greatest of red,
/// green and blue. Relative, from 0 to 2; the same at any exposure. Reads window/2 pixels, none beyond the plane.
Plane<float> residual_of(const Plane<glm::vec4>& differences, int window, Workers& workers);

/// The least weight of the present that leaves no more than `limit` of a residual: 1 - limit / residual; 0 where it is
/// below the limit, or there is none (limit 0).
double alpha_of_residual(double residual, double limit);

/// The least weight of a present of second moment `own` px^2 that keeps that of the mixture with a history of `moment`
/// px^2 at `limit`; 0 where it is below, or there is no limit (0), and 1 where it cannot be kept.
double alpha_of_blur(double moment, double own, double limit);

}  // namespace varve
