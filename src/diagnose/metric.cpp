#include "diagnose/metric.h"

#include <algorithm>

namespace varve {
namespace {

constexpr auto kDown = Better::down, kUp = Better::up;
constexpr auto kFrame = MetricScope::frame, kPair = MetricScope::pair, kSequence = MetricScope::sequence;

constexpr Metric kMetrics[] = {
    {MetricId::missing, "missing", "frames", kDown, kSequence, false,
     "Frames that only one side has. The limit is 0 unless one is given."},
    {MetricId::not_finite, "not-finite", "values", kDown, kFrame, false,
     "Values that are NaN or infinite on one side and not the same on the other. The limit is 0 unless one is given."},
    {MetricId::differing, "differing", "values", kDown, kFrame, false,
     "Values that are not the same number in the compared channels."},
    {MetricId::max, "max", "", kDown, kFrame, false,
     "Largest absolute difference of R, G, B, and of each further channel."},
    {MetricId::mean, "mean", "", kDown, kFrame, false, "Mean absolute difference, likewise."},
    {MetricId::rmse, "rmse", "", kDown, kFrame, false, "Root of the mean square difference, likewise."},
    {MetricId::relmse, "relmse", "", kDown, kFrame, false,
     "Mean of (b - a)^2 / (a^2 + 0.01 m^2), m being the mean luminance of A."},
    {MetricId::psnr, "psnr", "dB", kUp, kFrame, false,
     "Peak signal to noise ratio of linear values held to 0..1, peak 1."},
    {MetricId::psnr_tone, "psnr-tone", "dB", kUp, kFrame, false,
     "The same after x / (1 + x), negative values counting as 0."},
    {MetricId::psnr_pu, "psnr-pu", "dB", kUp, kFrame, false,
     "The same of PU21 codes, peak at the code of white (--white)."},
    {MetricId::ssim, "ssim", "", kUp, kFrame, true,
     "Structural similarity of the tone-mapped luminance; 1 is the same."},
    {MetricId::flip, "flip", "", kDown, kFrame, true,
     "Mean FLIP of colors held to 0..1: what is noticed when both take turns; 0 same, 1 worst."},
    {MetricId::hdr_flip, "hdr-flip", "", kDown, kFrame, true,
     "Mean HDR-FLIP: the greatest FLIP over all useful exposures."},
    {MetricId::bias, "bias", "", kDown, kSequence, false,
     "Part of the mean square error that stays over time: blur, ghosts, offsets."},
    {MetricId::flicker, "flicker", "", kDown, kSequence, false,
     "The rest of the mean square error: what changes from frame to frame at a fixed pixel."},
    {MetricId::warped, "warped", "", kDown, kPair, false,
     "Mean square change of the error along the motion since the frame before; needs motion vectors."},
    {MetricId::spectrum, "spectrum", "share", kDown, kSequence, false,
     "Share of the error's power over time at 1/8 cycle per frame and above; needs 9 frames in a row."},
    {MetricId::tflip, "tflip", "", kDown, kPair, true,
     "Mean difference between FLIP of B against its frame before and FLIP of A against its frame before."},
    {MetricId::ghost, "ghost", "share", kDown, kPair, false,
     "Share of A's frame before, unmoved, that shows in B: 0 none, 1 nothing else."},
    {MetricId::sharpness, "sharpness", "share", kUp, kFrame, false,
     "Share of A's gradients that B has: 1 as sharp, less is blurred, more is sharpened."},
    {MetricId::lag, "lag", "frames", kDown, kSequence, false, "Mean age of what B shows after a cut of --cuts."},
    {MetricId::half_life, "half-life", "frames", kDown, kSequence, false,
     "Frames until half of what was there before a cut has gone."},
    {MetricId::mtf50, "mtf50", "c/px", kUp, kSequence, false,
     "Frequency at which the edge of --edge keeps half its contrast in B, in cycles per pixel."},
    {MetricId::edge_width, "edge-width", "px", kDown, kSequence, false, "Width of that edge in B from 10 to 90 %."},
    {MetricId::edge_blur, "edge-blur", "px^2", kDown, kSequence, false,
     "Variance of the line spread in B minus that in A."},
};
static_assert(std::size(kMetrics) == kMetricCount);

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }
const Metric& metric_of(MetricId id) { return kMetrics[std::size_t(id)]; }

const Metric* find_metric(std::string_view name) {
  const auto found = std::ranges::find(kMetrics, name, &Metric::name);
  return found == std::end(kMetrics) ? nullptr : &*found;
}

bool holds(const Limit& limit, double value) {
  return metric_of(limit.metric).better == Better::down ? value <= limit.value : value >= limit.value;
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::equal:
      return "equal";
    case Verdict::within:
      return "within";
    case Verdict::beyond:
      return "beyond";
    case Verdict::incomparable:
      return "incomparable";
  }
  return "";
}

}  // namespace varve
