#include "plan/cost.h"
#include "plan/repair_plan.h"

#include <algorithm>
#include <set>

#include "diagnose/aov.h"
#include "plan/deep_plan.h"
#include "plan/gather_plan.h"
#include "plan/subpixel_plan.h"
#include "plan/two_sided_plan.h"
#include "resolve/rectify_shapes.h"

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
                 kDepthTest = 1, kSampleWeights = 20, kBox = 28, kBlend = 8, kDiagnostic = 0.5, kCompanionMove = 250,
                 kCompanion = 140, kCubic = 45, kBspline3 = 100, kBspline5 = 125, kResolveSample = 8, kUnjitter = 12,
                 kSharpen = 33;

// Two-sided passes each frame twice in each direction.
constexpr double kTwoSidedPasses = 4;

/// Nanoseconds per pixel to hold history to its neighborhood.
double box_cost(const RectifyParameters& r) {
  if (r.box == Box::none) return 0;
  if (!needs_shapes(r)) return kBox * std::max(1, r.window) / 3;
  const double log = r.space == BoxSpace::log ? 120 : 0;
  if (r.moments == WindowMoments::separable) return log + 90;
  if (r.moments == WindowMoments::gaussian) return log + 140;
  if (r.moments == WindowMoments::pyramid) return log + 130;
  const double neighbors = double(r.window) * r.window / 9;  // of 3x3
  switch (r.box) {
    case Box::kdop7:
    case Box::kdop13:
    case Box::rounded:
    case Box::dynamic4:
      return log + 200 * neighbors;
    case Box::pca:
    case Box::ellipsoid:
      return log + 350 + 100 * neighbors;
    case Box::hull:
      return log + 200 + 150 * neighbors;
    default:
      return log + 100 * neighbors;
  }
}

/// Bytes that window moments need while a frame is at work.
std::size_t window_bytes(const RectifyParameters& r, const Window& window) {
  if (r.box == Box::none || r.moments == WindowMoments::direct) return 0;
  const bool cut = r.box != Box::variance;
  const std::size_t width = std::size_t(window.width());
  const std::size_t rows = std::size_t(std::min(window.height(), kWindowBandRows) + r.window - 1);
  if (r.moments == WindowMoments::pyramid) return window.pixels() * 24 + (cut ? rows * width * sizeof(Extremes) : 0);
  return rows * width * (r.box == Box::minmax && !r.clip_discount ? 0 : sizeof(Moments)) +
         (cut ? rows * width * sizeof(Extremes) : 0);
}

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

Window window_of(const SequenceInfo& info, const Subject& subject) {
  for (const std::optional<ChannelRef>& channel : subject.color)
    if (channel) return part_of(info, *channel).data_window;
  return {};
}

std::size_t pixels_of(const SequenceInfo& info, const Subject& subject) { return window_of(info, subject).pixels(); }

using PartKey = std::pair<int, int>;

// Parts that lose a color or a companion and must be written anew; every other part is copied chunk by chunk.
std::set<PartKey> rewritten_parts(const SequenceInfo& info) {
  std::set<PartKey> parts;
  for (const Subject& subject : info.first.subjects)
    for (const int part : parts_of(subject)) parts.insert({0, part});
  return parts;
}

// Of the channels that are resolved.
std::size_t color_bytes(const SequenceInfo& info) {
  std::size_t bytes = 0;
  const auto add = [&](const std::optional<ChannelRef>& channel) {
    if (channel)
      bytes += bytes_of(part_of(info, *channel), part_of(info, *channel).channels[std::size_t(channel->channel)]);
  };
  for (const Subject& subject : info.first.subjects) {
    for (const std::optional<ChannelRef>& channel : subject.color) add(channel);
    for (const Companion& companion : subject.companions)
      for (const std::optional<ChannelRef>& channel : companion.channels) add(channel);
  }
  return bytes;
}

/// What meets a history: subjects, or what several of them are made to before.
std::vector<Subject> accumulated(const SequenceInfo& info) {
  if (info.first.outputs.empty()) return info.first.subjects;
  std::vector<Subject> all;
  for (const Subject* subject : accumulated_subjects(info.first.outputs, info.first.subjects)) all.push_back(*subject);
  return all;
}

/// Presents of a frame that are there before they become fewer.
std::size_t bytes_to_combine(const SequenceInfo& info) {
  std::size_t bytes = 0;
  for (const ColorOutput& output : info.first.outputs)
    if (output.combine != Combine::alone && !output.after)
      bytes += output.inputs.size() * pixels_of(info, info.first.subjects[output.inputs.front()]) * (16 + 4 + 8 + 4);
  return bytes;
}

std::size_t diagnostic_bytes_per_pixel(const OutputRequest& output, Accumulator accumulator) {
  std::size_t bytes = 0;
  for (const Aov* aov : planned_aovs(output, accumulator))
    bytes += std::max<std::size_t>(1, aov->components.size()) * bytes_per_pixel(aov->type);
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
  // Of a frame and of the one before: vectors, ids and normals for the tests; and what is shown instead of the history.
  const RejectParameters& reject = parameters.recursive.reject;
  const std::size_t tested =
      (reject.tests_vectors() ? 8u : 0u) + (plan.use_id ? 8u : 0u) + (plan.use_normal ? 24u : 0u);
  const std::size_t masks = (plan.use_reactive ? 4u : 0u) + (plan.use_responsive ? 4u : 0u);
  const std::size_t shown = parameters.fallback.any() ? 16 : 0;
  const bool two_sided = parameters.accumulator == Accumulator::two_sided;
  const bool gathers = parameters.accumulator == Accumulator::gather;
  const HistoryFilter filter = parameters.recursive.history_filter;
  // Planes of color beside the present: B-spline coefficients, the reconstructed present, the sharpened result.
  const std::size_t extra = 16 * std::size_t((filter == HistoryFilter::bspline3 || filter == HistoryFilter::bspline5) +
                                             plan.use_jitter + (parameters.finish.sharpen > 0));
  std::size_t histories = bytes_to_combine(info), at_work = 0;
  for (const Subject& subject : accumulated(info)) {
    const std::size_t pixels = pixels_of(info, subject);
    // color, count and weight; depth of the last frame
    histories += pixels * (2 * (16 + 8) + (depth_test ? 4 : 0) + tested + masks + shown);
    // A companion's sample, and its values of the last frame and of this one.
    const std::size_t companions = subject.companions.size();
    histories += pixels * 2 * 16 * companions;
    if (parameters.accumulator == Accumulator::subpixel)
      histories += pixels * subpixel_bytes_per_pixel(parameters, companions);
    if (gathers) histories += pixels * gather_bytes_per_pixel(parameters);
    if (two_sided)  // the past of the next block too, three frames' vectors
      histories += pixels * (24 + 3 * 20 + waiting_bytes_per_pixel(parameters, output));
    const bool tests_vectors = plan.use_motion && parameters.repair.mode != RepairMotion::off;
    if (tests_vectors && !gathers) histories += pixels * 12;  // what the next frame's vectors are tested against
    const bool in_space = parameters.rectify.box != Box::none && parameters.rectify.space != BoxSpace::rgb;
    at_work = std::max(at_work,
                       pixels * (16 + extra + 16 * companions + (plan.use_motion ? 8 : 0) + (plan.use_depth ? 4 : 0) +
                                 (in_space ? 16 : 0) + (tests_vectors ? repair_bytes_per_pixel(parameters) : 0) +
                                 diagnostic_bytes_per_pixel(output, parameters.accumulator)) +
                           window_bytes(parameters.rectify, window_of(info, subject)));
  }
  return kBaseBytes + raw + deep_bytes(info) + histories + at_work;
}

double estimate_seconds(const SequenceInfo& info, const Plan& plan, const Parameters& parameters,
                        const OutputRequest& output, int threads) {
  const bool two_sided = parameters.accumulator == Accumulator::two_sided;
  double nanoseconds = deep_nanoseconds(info);
  std::set<PartKey> read;
  for (const ChannelRef ref : plan.channels) read.insert({ref.file, ref.part});
  for (const auto& [file, index] :
       read) {  // compressed chunks hold all channels: a part is decoded whole or not at all
    const Part& part = part_of(info, {file, index, 0});
    nanoseconds += double(bytes_of(part)) * cost_of(part.compression).decode * (two_sided ? 3 : 1);
  }
  const std::size_t diagnostic_bytes = diagnostic_bytes_per_pixel(output, parameters.accumulator);
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
  double per_pixel = kConvert + kSanitize + double(diagnostic_bytes) * (kDiagnostic + kZip.encode);
  if (plan.use_motion) per_pixel += repair_nanoseconds(parameters);
  if (parameters.accumulator == Accumulator::gather) {
    if (parameters.finish.sharpen > 0) per_pixel += kSharpen;
    per_pixel += gather_nanoseconds(parameters);
    for (const Subject& subject : accumulated(info)) nanoseconds += double(pixels_of(info, subject)) * per_pixel;
    return nanoseconds * 1e-9 / std::max(1, threads);
  }
  const bool four = parameters.accumulator == Accumulator::subpixel;
  if (!four) per_pixel += kBlend + cost_of(recursive.history_filter);
  if (plan.use_motion && parameters.motion.dilation != Dilation::none) per_pixel += kDilate;
  if (recursive.disocclusion == Disocclusion::depth) per_pixel += kDepthTest;
  if (recursive.sample_filter != SampleFilter::none) per_pixel += kSampleWeights;
  if (recursive.unjitter != Unjitter::none) per_pixel += kUnjitter;
  if (parameters.finish.sharpen > 0) per_pixel += kSharpen;
  per_pixel += box_cost(parameters.rectify);
  const double passes = two_sided ? kTwoSidedPasses : 1;
  for (const ColorOutput& made : info.first.outputs)
    if (made.combine == Combine::samples)
      nanoseconds += double(made.inputs.size()) * double(pixels_of(info, info.first.subjects[made.inputs.front()])) *
                     (kConvert + kSanitize + kMotion + kResolveSample) * (two_sided ? 3 : 1);
  for (const Subject& subject : accumulated(info)) {
    const double motion = !plan.use_motion ? 0 : subject.backward ? kMotion : subject.forward ? kMotion + kInvert : 0;
    const std::size_t planes = subject.companions.size();
    if (four) nanoseconds += double(pixels_of(info, subject)) * subpixel_nanoseconds(parameters, planes);
    const double companions =
        planes == 0 || four ? 0 : kCompanionMove + double(planes) * (kCompanion + kConvert + kSanitize);
    nanoseconds += double(pixels_of(info, subject)) * ((per_pixel + motion) * passes + companions);
  }
  return nanoseconds * 1e-9 / std::max(1, threads);
}

}  // namespace varve
