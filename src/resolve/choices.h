// The named choices of the recursive accumulator. Enumerations only: the kernels are compiled for several
// processors, and a header they share must not carry inline functions.
#pragma once

namespace varve {

/// How history is read between pixels. All but some cubics are non-expansive (|R(f)| <= 1, see resampling_kernel.h), so
/// that reading it again and again is stable; the plan refuses the cubics that are not.
enum class HistoryFilter { bilinear, catmull_rom, catmull_rom9, catmull_rom5, cubic, bspline3, bspline5 };

/// What the neighborhood of the present allows history to be.
enum class Box { none, minmax, variance, variance_minmax };
enum class BoxRule { clip, clamp };
enum class BoxAnchor { present, mean };
enum class BoxSpace { rgb, ycocg };

/// Weight of the present: fixed, or max(alpha, 1/n) while n frames have been seen (Yang 2009, slide 9).
enum class AlphaRule { fixed, mean };

/// What makes a pixel start over, besides leaving the data window.
enum class Disocclusion { window, depth };

/// Whether the present is brought to the pixel centers by a fetch at minus the jitter (Pedersen 2016).
enum class Unjitter { none, bilinear };

/// Reconstruction of the present from true sample positions.
enum class SampleFilter { none, tent, gaussian, blackman_harris, mitchell };

}  // namespace varve
