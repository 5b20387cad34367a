// Structural similarity (Wang et al. 2004).
#pragma once

#include "diagnose/color_pair.h"

namespace varve {

/// Mean SSIM of the tone-mapped luminance y / (1 + y), range 1: Gaussian window of 11x11 pixels with sigma 1.5,
/// K1 = 0.01, K2 = 0.03, borders clamped. 1 for equal pictures; bad pixels count -1, the least there is.
double ssim(const ColorPair& pair, Workers& workers);

}  // namespace varve
