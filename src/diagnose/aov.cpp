#include "diagnose/aov.h"

namespace varve {
namespace {

constexpr Aov kAovs[] = {
    {"count", "", PixelType::float32, "samples", "0 and up", "viridis", 0, 20,
     "Effective sample count: one over the sum of squared weights of all samples in the pixel. 0 where nothing valid "
     "was seen. Of --accumulator recursive and two-sided, samples of --extra count as one with the frame's own."},
    {"clip", "", PixelType::float32, "relative", "0 to 2", "inferno", 0, 1,
     "Clip distance: how far rectification moved the history (under --rule off: would have moved it), in RGB, over the "
     "longer of what it was and what it became.",
     kByRecursive | kByTwoSided | kBySubpixel},
    {"reject", "", PixelType::uint32, "bits", "0 to 8191", "turbo", 0, 8191,
     "Why history was not used, or counts half or less of what it would: a sum of the bits listed under REJECTION "
     "BITS. 0 where history was used. With --accumulator two-sided: why the past was not used."},
    {"motion", "xy", PixelType::float32, "pixels, y down", "any", "blue-red", -16, 16,
     "Backward motion used, after dilation: previous position minus this position."},
    {"weight", "", PixelType::float32, "fraction", "0 to 1", "viridis", 0, 1,
     "Weight of the history in the output pixel; the present has the rest."},
    {"prediction", "rgb", PixelType::float32, "scene-linear", "any", "viridis", 0, 1,
     "What the frames before say this pixel is: the history rectified without the pixel itself, nothing of the present "
     "blended in. 0 where there is no history. It follows its neighbors, which share the jitter of the pixel: to rank "
     "settings use varve measure.",
     kByRecursive},
    {"blur-variance", "", PixelType::float32, "pixels squared", "0 and up", "inferno", 0, 1,
     "Second moment of the kernel through which the pixel sees the samples, mean of both axes: what reading history "
     "between pixels has blurred, and a box of one pixel (0.083) from the jitter. With --accumulator subpixel of all "
     "four histories, at the true positions of their samples.",
     kByRecursive | kBySubpixel},
    {"residual", "", PixelType::float32, "relative", "0 to 2", "inferno", 0, 1,
     "How far history lags behind the present: their difference, averaged with its sign over --residual-window, over "
     "the light there, before the present counts. 0 where there is no history.",
     kByRecursive | kBySubpixel},
    {"repaired", "", PixelType::float32, "flag", "0 or 1", "inferno", 0, 1,
     "1 where the input color was not finite and something else stands in the output."},
    {"count-past", "", PixelType::float32, "samples", "0 and up", "viridis", 0, 20,
     "Effective sample count of what the frames before say of the pixel, before its weight is cut for having been "
     "clipped. 0 where they say nothing.",
     kByTwoSided | kByGather},
    {"count-future", "", PixelType::float32, "samples", "0 and up", "viridis", 0, 20, "The same of the frames after.",
     kByTwoSided | kByGather},
    {"reject-future", "", PixelType::uint32, "bits", "0 to 8191", "turbo", 0, 8191,
     "Why the future was not used: the bits of the plane reject, seen from the other side of time.", kByTwoSided},
    {"vector-residual", "", PixelType::float32, "fraction", "0 to 1", "inferno", 0, 0.25,
     "What speaks against the vector to the frame before, as it came: how far the light lies outside of what is seen "
     "where it leads, on a scale where 1 is all there is; 1 where the surface is not there. 0 where nothing can be "
     "compared, and under --repair-motion off."},
    {"vector-repair", "", PixelType::uint32, "code", "0 to 4", "turbo", 0, 4,
     "What became of the vector to the frame before: 0 kept, 1 that of a neighbor on the same surface, 2 the camera's, "
     "3 found in the pixels, 4 dropped. Under --repair-motion check, what would become of it."},
    {"variance", "", PixelType::float32, "luminance squared", "0 and up", "inferno", 0, 0.01,
     "Predicted variance of the pixel's luminance: the spread of its samples times the sum of their squared weights. "
     "The "
     "spread holds detail within the pixel too, so it is an upper bound.",
     kByGather},
    {"frames", "", PixelType::float32, "frames", "0 and up", "viridis", 0, 33,
     "Frames that have a sample in the pixel.", kByGather},
    {"surfaces", "", PixelType::float32, "surfaces", "0 to 8", "turbo", 0, 4,
     "Surfaces that were told apart in the pixel and composited front to back.", kByGather},
    {"gain", "", PixelType::float32, "fraction", "0 to 1", "viridis", 0, 1,
     "Share of the pixel's samples that count fully: lower where light changed and frames were turned down.",
     kByGather},
    {"removed", "", PixelType::float32, "luminance", "0 and up", "inferno", 0, 1,
     "Energy taken away: luminance of the fireflies that --firefly-limit held back.", kByGather},
    {"round-trip", "", PixelType::float32, "pixels", "0 and up", "inferno", 0, 1,
     "How far the vector to the frame before and the vector that leads back from there miss each other. 0 where one of "
     "them is not known.",
     kByGather},
    {"evaluation", "", PixelType::float32, "samples", "0 to 4096", "inferno", 0, 16,
     "Samples that the pixel lacks: what --want-samples and --want-noise ask for less what it has; all that is wanted "
     "where history was turned down and only its own sample is left. Noise is that of the plane variance, in the "
     "gather as far as the pixel's samples are enough to tell it, else the spread of the 3x3 samples around over the "
     "plane count. --rerender makes a list of it."},
    {"layer-index", "", PixelType::float32, "layers", "0 and up", "turbo", 0, 8,
     "With --layers: the layer whose motion the pixel follows, 1 being the nearest; 0 for the background, and where "
     "nothing is composited. In a deep color: the sample."},
    {"layer-variation", "", PixelType::float32, "fraction", "0 to 1", "viridis", 0, 1,
     "With --layers: the change of transmittance across that layer, or what the background is seen through."},
    {"layers", "", PixelType::float32, "layers", "0 and up", "turbo", 0, 8,
     "With --layers: layers that have a part in the pixel. In a deep color: samples."},
    {"layer-difference", "", PixelType::float32, "relative", "0 to 2", "inferno", 0, 1,
     "With --layers: how much composite and each differ, in RGB, over the larger of both. Both are worked out, so all "
     "does not mean this plane.",
     kByAll, true},
};

constexpr RejectName kBits[] = {
    {kRejectFirstFrame, "first", "first frame of the sequence"},
    {kRejectCut, "cut", "restart on a cut or after a gap in the frame numbers"},
    {kRejectWindow, "window", "previous position outside the data window of the history"},
    {kRejectDepth, "depth", "another surface lay at the previous position"},
    {kRejectVector, "vector", "the vector is not finite or longer than --max-motion"},
    {kRejectEmptyHistory, "empty", "no valid history at the previous position"},
    {kRejectPresent, "present", "the present pixel is not finite"},
    {kRejectNormal, "normal", "the surface at the previous position was turned by more than --normal-angle"},
    {kRejectId, "id", "another id lay at the previous position (--id-test)"},
    {kRejectSpeed, "speed", "the vector there was longer or shorter by more than --speed-difference"},
    {kRejectDirection, "direction", "the vector there led elsewhere by more than --direction-angle"},
    {kRejectAcceleration, "acceleration", "the vector there was another (--acceleration)"},
    {kRejectReactive, "reactive", "the reactive mask takes half of the history or more"},
};

}  // namespace

std::span<const Aov> diagnostic_aovs() { return kAovs; }

const Aov* find_aov(std::string_view name) {
  for (const Aov& aov : kAovs)
    if (aov.name == name) return &aov;
  return nullptr;
}

std::string accumulators_of(const Aov& aov) {
  std::string text;
  const auto add = [&](unsigned who, const char* name) {
    if (aov.filled_by & who) text += (text.empty() ? "--accumulator " : " or ") + std::string(name);
  };
  add(kByRecursive, "recursive");
  add(kByTwoSided, "two-sided");
  add(kByGather, "gather");
  add(kBySubpixel, "subpixel");
  return text;
}

std::span<const RejectName> reject_bits() { return kBits; }

}  // namespace varve
