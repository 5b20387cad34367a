// Places on things that move unlike the rest of the picture, told by what is stored for them.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "base/plane.h"
#include "motion/patch_match.h"

namespace varve {

/// Textured places, at most about `count`, where two stored channels differ from what most of the picture holds, and
/// are even over a patch. As many from each direction and from each length (in octaves) of that difference, so that
/// small things and slow ones speak, too; neither unit, bias nor sign of the channels matters. `tone` has pixels of
/// `pixel` px. In pixels of `tone`; none lies on one of `taken`.
std::vector<Place> moving_places(const Plane<float>& tone, int pixel, const Plane<float>& x, const Plane<float>& y,
                                 int count, const std::vector<Place>& taken, Workers& workers);

}  // namespace varve
