#include "diagnose/aov.h"

namespace varve {
namespace {

constexpr Aov kAovs[] = {
    {"count", "", PixelType::float32, "samples", "0 and up", "viridis", 0, 20,
     "Effective sample count: one over the sum of squared weights of all samples in the pixel. 0 where nothing valid "
     "was seen."},
    {"clip", "", PixelType::float32, "relative", "0 to 2", "inferno", 0, 1,
     "Clip distance: how far rectification moved the history (under --rule off: would have moved it), in RGB, over the "
     "longer of what it was and what it became."},
    {"reject", "", PixelType::uint32, "bits", "0 to 127", "turbo", 0, 127,
     "Why history was not used: a sum of the bits listed under REJECTION BITS. 0 where history was used."},
    {"motion", "xy", PixelType::float32, "pixels, y down", "any", "blue-red", -16, 16,
     "Backward motion used, after dilation: previous position minus this position."},
    {"weight", "", PixelType::float32, "fraction", "0 to 1", "viridis", 0, 1,
     "Weight of the history in the output pixel; the present has the rest."},
    {"prediction", "rgb", PixelType::float32, "scene-linear", "any", "viridis", 0, 1,
     "What the frames before say this pixel is: the history rectified without the pixel itself, nothing of the present "
     "blended in. 0 where there is no history. It follows its neighbors, which share the jitter of the pixel: to rank "
     "settings use varve measure."},
    {"repaired", "", PixelType::float32, "flag", "0 or 1", "inferno", 0, 1,
     "1 where the input color was not finite and something else stands in the output."},
};

constexpr RejectName kBits[] = {
    {kRejectFirstFrame, "first", "first frame of the sequence"},
    {kRejectCut, "cut", "restart on a cut or after a gap in the frame numbers"},
    {kRejectWindow, "window", "previous position outside the data window of the history"},
    {kRejectDepth, "depth", "another surface lay at the previous position"},
    {kRejectVector, "vector", "the vector is not finite or longer than --max-motion"},
    {kRejectEmptyHistory, "empty", "no valid history at the previous position"},
    {kRejectPresent, "present", "the present pixel is not finite"},
};

}  // namespace

std::span<const Aov> diagnostic_aovs() { return kAovs; }

const Aov* find_aov(std::string_view name) {
  for (const Aov& aov : kAovs)
    if (aov.name == name) return &aov;
  return nullptr;
}

std::span<const RejectName> reject_bits() { return kBits; }

}  // namespace varve
