// The named choices of the recursive accumulator. Enumerations only: the kernels are compiled for several
// processors, and a header they share must not carry inline functions.
#pragma once

namespace varve {

/// How frames are combined: exponential history, one frame back (Yang 2009, Salvi 2016); strict past and strict future
/// merged with the present counted once; every sample of the frames around, carried here and used once; or four
/// exponential histories in the quarters of a pixel, one of them new in each frame (Yang 2009).
enum class Accumulator { recursive, two_sided, gather, subpixel };

/// How the samples of the four histories are weighed around a place: a tent, normalized; the same so that their
/// centroid is the place; or one bilinear fetch in each history.
enum class SubpixelWeights { plain, first_order, second_order, bilinear };

/// Where the bound on the blur of the four histories comes from: the kernel of each pixel as it came about, or a table
/// of steady motions (Yang 2009).
enum class BlurBound { tracked, tabulated };

/// How history is read between pixels. All but some cubics are non-expansive (|R(f)| <= 1, see resampling_kernel.h), so
/// that reading it again and again is stable; the plan refuses the cubics that are not.
enum class HistoryFilter { bilinear, catmull_rom, catmull_rom9, catmull_rom5, cubic, bspline3, bspline5 };

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

/// Comparison of ids or stencils: a pixel of another id does not count; or the weight of history is the share of its
/// four pixels that have the id (soft edges).
enum class IdTest { off, hard, soft };

/// What a failed test does: the pixel starts over; it starts over from a slightly blurred present; or it keeps its
/// history but converges faster (Lopez).
enum class OnReject { restart, blur, weight };

/// Weight of history: by alpha, or by how much its luma agrees with that of the present (Pedersen 2016).
enum class Feedback { fixed, luma };

/// What is averaged: light; light over 1 + its luma (Karis); or its logarithm.
enum class Weighing { none, luminance, logarithm };

/// What is shown of what moves fast: the resolve, or the present blurred along the pixel's own vector or along the
/// longest around (Pedersen 2016).
enum class MotionBlur { off, own, neighbors };
/// Whether the present is brought to the pixel centers by a fetch at minus the jitter (Pedersen 2016).
enum class Unjitter { none, bilinear };

/// Reconstruction of the present from true sample positions.
enum class SampleFilter { none, tent, gaussian, blackman_harris, mitchell };

}  // namespace varve
