// Sharpening of what is written, never of what the next frame builds on.
#pragma once

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// What happens to a resolved frame on its way to the file.
struct FinishParameters {
  double sharpen = 0;  ///< strength, 0 to 1; 0: off
};

/// Adds to every color channel its difference to the mean of the four neighbors, times `strength` and less the more
/// contrast there is already: the idea of contrast-adaptive sharpening (AMD FidelityFX CAS), by a formula of ours that
/// knows no range of values. With low and high of the 3x3 neighborhood, c + strength * (1 - (high - low) / (|high| +
/// |low|)) * (c - mean), held between low and high: nothing overshoots, and light scaled by a power of two gives the
/// result scaled. Pixels with `total` 0 hold no data and are neither changed nor read; alpha is kept.
Plane<glm::vec4> sharpen(const Plane<glm::vec4>& color, const Plane<float>& total, double strength, Workers& workers);

}  // namespace varve
