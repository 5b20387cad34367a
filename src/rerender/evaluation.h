// Which pixels of a resolved frame lack samples, and what more of them would gain (Yang 2009 shades those again; here a
// renderer may).
#pragma once

#include "base/parallel.h"
#include "base/plane.h"
#include "rerender/request.h"
#include "resolve/accumulate.h"
#include "resolve/present.h"

namespace varve {

/// Planes over one window.
struct Evaluation {
  Plane<float> lacking;        ///< samples, 0 to kMostLacking
  Plane<float> count;          ///< effective samples that the pixel has, 1 and up where it has any, else 0
  Plane<float> variance;       ///< expected square of the error, of luminance L after L / (1 + L)
  Plane<std::uint8_t> failed;  ///< 1: reconstruction failed, the pixel has no more than its own sample
};

inline constexpr double kMostLacking = 4096;

/// A pixel with n effective samples lacks want_samples - n; all of want_samples where history was turned down and no
/// more than the pixel's own sample is left. To bring its noise, sigma over light, below want_noise it lacks
/// n (noise / want_noise)^2 - n; the larger of both counts. Sigma^2 is the spread of a sample over n: that which the
/// gather found among the pixel's own samples, as far as they are enough to tell it (two more stand for the spread
/// around), else that of the valid 3x3 samples around in the present, whatever surface they show: at an outline the
/// spread between surfaces is the error. Light is the mean of |luminance| over 3x3 resolved pixels. All of it scales
/// with the light but `variance`, which is as a display shows it.
Evaluation evaluate(const Present& present, const Accumulated& resolved, const RerenderRequest& request,
                    Workers& workers);

}  // namespace varve
