// Kernels that resample history, as weights at a fraction of a pixel, and whether they may be used again and again.
// Plain numbers: the row kernels include this, and a header that they share must not carry inline functions.
#pragma once

#include "resolve/choices.h"

namespace varve {

/// Of the pixels -1, 0, 1, 2 around a position `fraction` beyond pixel 0.
struct CubicWeights {
  double w[4];
};

/// Mitchell and Netravali 1988. B = 0, C = 1/2: Catmull-Rom; B = C = 1/3: Mitchell; B = 1, C = 0: cubic B-spline. The
/// weights sum to 1; with B above 0 a fraction of 0 is a small blur.
CubicWeights cubic_weights(double b, double c, double fraction);

/// Of the pixels -1 .. 2 (degree 3) or -2 .. 3 (degree 5); the other entries are not set.
struct BsplineWeights {
  double w[6];
};
BsplineWeights bspline_weights(int degree, double fraction);

/// What one pass through a kernel makes of the wave it amplifies most: R(f) = sum w_k exp(-2 pi i f (k - v)).
struct LargestGain {
  double gain = 1;       ///< max |R| over all frequencies f and fractions v
  double frequency = 0;  ///< f there, cycles per pixel
  double fraction = 0;   ///< v there
};
LargestGain cubic_gain(double b, double c);
/// Windowed sinc of that many lobes, normalized to a sum of 1.
LargestGain lanczos_gain(int lobes);

/// True when history must not be read through the kernel frame after frame: a wave would grow with every pass.
bool is_expansive(const LargestGain& gain);

/// The least weight of the present at which the recursion still holds in two dimensions: 1 - 1 / gain^2.
double critical_alpha(const LargestGain& gain);

}  // namespace varve
