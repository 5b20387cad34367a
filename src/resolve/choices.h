// The named choices of the recursive accumulator. Enumerations only: the kernels are compiled for several
// processors, and a header they share must not carry inline functions.
#pragma once

namespace varve {

/// How history is read between pixels. All are non-expansive (math: |R(f)| <= 1), so recursion is stable.
enum class HistoryFilter { bilinear, catmull_rom, catmull_rom9, catmull_rom5 };

/// What the neighborhood of the present allows history to be.
enum class Box { none, minmax, rounded, dynamic4, variance, variance_minmax, kdop7, kdop13, pca, ellipsoid, hull };
enum class BoxRule { clip, clamp, project, off };
enum class BoxAnchor { present, mean, center };
enum class BoxSpace { rgb, ycocg, log };

/// How mean and deviation of a window are found.
enum class WindowMoments { direct, separable, gaussian, pyramid };

/// Weight of the present: fixed, or max(alpha, 1/n) while n frames have been seen (Yang 2009, slide 9).
enum class AlphaRule { fixed, mean };

/// What makes a pixel start over, besides leaving the data window.
enum class Disocclusion { window, depth };

/// Reconstruction of the present from true sample positions.
enum class SampleFilter { none, tent, gaussian, blackman_harris, mitchell };

}  // namespace varve
