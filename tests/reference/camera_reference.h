// The slow twin of camera motion: through the world and back, with matrices written out.
#pragma once

#include "motion/camera.h"

namespace varve::reference {

/// As varve::reproject, for the pixel's point taken to the world and from there to the other picture.
SeenPoint reproject(double x, double y, double depth, const Camera& from, const Camera& to);

}  // namespace varve::reference
