#include "plan/cost.h"

#include <algorithm>
#include <set>

#include "diagnose/aov.h"

namespace varve {
namespace {

constexpr std::size_t kBaseBytes = std::size_t(15) << 20;

/// Nanoseconds per decoded and per encoded byte, one thread.
struct CodecCost {
  double decode, encode;
};

// Measured on 1080p frames: zip and zips through libdeflate level 1, the others through the OpenEXR C++ API. rle, pxr24
// and b44 were not measured: pxr24 is zlib, the others are taken as light work.
constexpr CodecCost kNone{0.2, 0.9}, kLight{1.5, 3}, kZip{1.9, 6}, kPiz{5, 11}, kZlib{4.5, 18}, kDwa{2.6, 16};

// Nanoseconds per pixel and pass, one thread with AVX2, as tests/bench/passes_bench prints them; inversion of forward
// vectors, depth test and diagnostics are set by their traffic and not measured yet.
constexpr double kConvert = 1.5, kSanitize = 1.6, kMotion = 1.1, kInvert = 12, kDilate = 8.5, kHistory = 22,
                 kDepthTest = 1, kSampleWeights = 20, kBox = 28, kBlend = 8, kDiagnostic = 0.5, kCubic = 45,
                 kBspline3 = 100, kBspline5 = 125, kUnjitter = 12, kSharpen = 33;

/// Of reading history.
double cost_of(HistoryFilter filter) {
  return filter == HistoryFilter::cubic      ? kCubic
         : filter == HistoryFilter::bspline3 ? kBspline3
         : filter == HistoryFilter::bspline5 ? kBspline5
                                             : kHistory;
}

CodecCost cost_of(Compression compression) {
  switch (compression) {
    case Compression::none:
      return kNone;
    case Compression::rle:
    case Compression::b44:
    case Compression::b44a:
      return kLight;
    case Compression::zips:
    case Compression::zip:
      return kZip;
    case Compression::piz:
      return kPiz;
    case Compression::pxr24:
      return kZlib;
    case Compression::dwaa:
    case Compression::dwab:
      return kDwa;
  }
  return kZlib;
}

const Part& part_of(const SequenceInfo& info, ChannelRef ref) {
  return info.first.files[std::size_t(ref.file)].parts[std::size_t(ref.part)];
}

std::size_t bytes_of(const Part& part, const Channel& channel) {
  return part.data_window.pixels() / std::size_t(std::max(1, channel.x_sampling)) /
         std::size_t(std::max(1, channel.y_sampling)) * bytes_per_pixel(channel.type);
}

std::size_t bytes_of(const Part& part) {
  std::size_t bytes = 0;
  for (const Channel& channel : part.channels) bytes += bytes_of(part, channel);
  return bytes;
}

std::size_t pixels_of(const SequenceInfo& info, const Subject& subject) {
  for (const std::optional<ChannelRef>& channel : subject.color)
    if (channel) return part_of(info, *channel).data_window.pixels();
  return 0;
}

using PartKey = std::pair<int, int>;

// Parts that lose a color and must be written anew; every other part is copied chunk by chunk.
std::set<PartKey> rewritten_parts(const SequenceInfo& info) {
  std::set<PartKey> parts;
  for (const Subject& subject : info.first.subjects)
    for (const std::optional<ChannelRef>& channel : subject.color)
      if (channel) parts.insert({channel->file, channel->part});
  return parts;
}

std::size_t color_bytes(const SequenceInfo& info) {
  std::size_t bytes = 0;
  for (const Subject& subject : info.first.subjects)
    for (const std::optional<ChannelRef>& channel : subject.color)
      if (channel)
        bytes += bytes_of(part_of(info, *channel), part_of(info, *channel).channels[std::size_t(channel->channel)]);
  return bytes;
}

std::size_t diagnostic_bytes_per_pixel(const OutputRequest& output) {
  std::size_t bytes = 0;
  for (const Aov& aov : diagnostic_aovs()) {
    const bool asked = std::any_of(output.aovs.begin(), output.aovs.end(),
                                   [&](const std::string& name) { return name == aov.name || name == "all"; });
    if (asked) bytes += std::max<std::size_t>(1, aov.components.size()) * bytes_per_pixel(aov.type);
  }
  return bytes;
}

}  // namespace

std::size_t estimate_bytes(const SequenceInfo& info, const Plan& plan, const Parameters& parameters,
                           const OutputRequest& output) {
  std::size_t raw = color_bytes(info);  // of the output
  std::set<PartKey> whole;
  if (output.keep_channels) whole = rewritten_parts(info);
  for (const auto& [file, part] : whole) raw += bytes_of(part_of(info, {file, part, 0}));
  for (const ChannelRef ref : plan.channels)
    if (!whole.contains({ref.file, ref.part}))
      raw += bytes_of(part_of(info, ref), part_of(info, ref).channels[std::size_t(ref.channel)]);
  const bool depth_test = plan.use_depth && parameters.recursive.disocclusion == Disocclusion::depth;
  const HistoryFilter filter = parameters.recursive.history_filter;
  // Planes of color beside the present: B-spline coefficients, the reconstructed present, the sharpened result.
  const std::size_t extra = 16 * std::size_t((filter == HistoryFilter::bspline3 || filter == HistoryFilter::bspline5) +
                                             plan.use_jitter + (parameters.finish.sharpen > 0));
  std::size_t histories = 0, at_work = 0;
  for (const Subject& subject : info.first.subjects) {
    const std::size_t pixels = pixels_of(info, subject);
    histories += pixels * (2 * (16 + 8) + (depth_test ? 4 : 0));  // color, count and weight; depth of the last frame
    at_work = std::max(at_work, pixels * (16 + extra + (plan.use_motion ? 8 : 0) + (plan.use_depth ? 4 : 0) +
                                          diagnostic_bytes_per_pixel(output)));
  }
  return kBaseBytes + raw + histories + at_work;
}

double estimate_seconds(const SequenceInfo& info, const Plan& plan, const Parameters& parameters,
                        const OutputRequest& output, int threads) {
  double nanoseconds = 0;
  std::set<PartKey> read;
  for (const ChannelRef ref : plan.channels) read.insert({ref.file, ref.part});
  for (const auto& [file, index] :
       read) {  // compressed chunks hold all channels: a part is decoded whole or not at all
    const Part& part = part_of(info, {file, index, 0});
    nanoseconds += double(bytes_of(part)) * cost_of(part.compression).decode;
  }
  const std::size_t diagnostic_bytes = diagnostic_bytes_per_pixel(output);
  if (output.keep_channels) {
    for (const auto& [file, index] : rewritten_parts(info)) {
      const Part& part = part_of(info, {file, index, 0});
      nanoseconds +=
          double(bytes_of(part)) * cost_of(is_lossy(part.compression) ? Compression::zip : part.compression).encode;
    }
  } else {
    nanoseconds += double(color_bytes(info)) * kZip.encode;
  }
  const RecursiveParameters& recursive = parameters.recursive;
  double per_pixel = kConvert + kSanitize + kBlend + cost_of(recursive.history_filter) +
                     double(diagnostic_bytes) * (kDiagnostic + kZip.encode);
  if (plan.use_motion && parameters.motion.dilation != Dilation::none) per_pixel += kDilate;
  if (recursive.disocclusion == Disocclusion::depth) per_pixel += kDepthTest;
  if (recursive.sample_filter != SampleFilter::none) per_pixel += kSampleWeights;
  if (recursive.unjitter != Unjitter::none) per_pixel += kUnjitter;
  if (parameters.finish.sharpen > 0) per_pixel += kSharpen;
  if (parameters.rectify.box != Box::none) per_pixel += kBox * std::max(1, parameters.rectify.window) / 3;
  for (const Subject& subject : info.first.subjects) {
    const double motion = !plan.use_motion ? 0 : subject.backward ? kMotion : subject.forward ? kMotion + kInvert : 0;
    nanoseconds += double(pixels_of(info, subject)) * (per_pixel + motion);
  }
  return nanoseconds * 1e-9 / std::max(1, threads);
}

}  // namespace varve
