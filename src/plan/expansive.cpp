#include "plan/expansive.h"

#include <cstdio>

namespace varve {

std::string expansive_filter_text(std::string_view filter, const LargestGain& gain) {
  char figures[256];
  std::snprintf(figures, sizeof figures,
                "each pass multiplies a wave of %.2f cycles per pixel by %.4g along each axis where history lies %.2f "
                "pixels off the grid, so that what is read again every frame grows without end where the present "
                "weighs less than %.2g; ",
                gain.frequency, gain.gain, gain.fraction, critical_alpha(gain));
  return "history-filter " + std::string(filter) + " amplifies: " + figures +
         "take bspline5, which is as sharp and stable, catmull-rom, or cubic with cubic-c up to 0.5";
}

}  // namespace varve
