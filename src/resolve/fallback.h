// What is shown instead of a resolved pixel that history does not serve well. Output only: the history never sees it.
#pragma once

#include "resolve/accumulate.h"

namespace varve {

/// What stands in for young pixels: the present slightly blurred, or its edges smoothed by their shape.
enum class YoungFilter { blur, morphological };

/// Both off by default.
struct FallbackParameters {
  MotionBlur motion_blur = MotionBlur::off;
  double blur_from = 2, blur_to = 15;  ///< px of speed between which the blurred present takes over (Pedersen 2016)
  double young_frames = 0;             ///< frames after a restart in which a soft present stands in, less and less
  YoungFilter young_filter = YoungFilter::blur;

  bool any() const { return motion_blur != MotionBlur::off || young_frames > 0; }
};

/// The resolved color with the fallbacks in place; empty where none is on. A pixel that neither concerns keeps its
/// bits. Motion blur: mean of seven bilinear samples of the present along the vector, half of it to each side; the
/// vector is that of the pixel or the longest of the 20 px tiles around. Reads the present along that vector.
Plane<glm::vec4> fall_back(const Present& present, const History& resolved, const FallbackParameters& parameters,
                           Workers& workers);

}  // namespace varve
