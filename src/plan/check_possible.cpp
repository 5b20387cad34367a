#include "plan/check_possible.h"

#include "base/error.h"
#include "plan/camera_plan.h"
#include "plan/expansive.h"
#include "plan/layers_plan.h"
#include "plan/subpixel_plan.h"
#include "plan/value.h"

namespace varve {
namespace {

std::string layer_text(const Subject& subject) {
  std::string text = subject.layer.empty() ? "the main layer" : "layer " + subject.layer;
  if (!subject.view.empty()) text += " of view " + subject.view;
  return text;
}

// Both sides weigh by what they have seen: what moves that from pixel to pixel is of the recursive accumulator.
void check_two_sided(const SequenceInfo& info, const Parameters& parameters) {
  for (const Subject& subject : info.first.subjects)
    if (!subject.companions.empty())
      throw Failure(ExitCode::usage,
                    "--channels are not resolved by --accumulator two-sided; leave them out, or give --channel-weights "
                    "own or --accumulator recursive");
  if (parameters.recursive.reject.on_reject != OnReject::restart)
    throw Failure(ExitCode::usage,
                  "--accumulator two-sided drops what it does not believe; give --on-reject restart with it, or "
                  "--accumulator recursive");
  if (parameters.rectify.rule == BoxRule::off && parameters.rectify.clip_discount)
    throw Failure(ExitCode::usage,
                  "--accumulator two-sided discounts what the box moved, and --rule off moves nothing; give another "
                  "--rule, or --clip-discount off");
  const WeightParameters& w = parameters.recursive.weight;
  if (w.feedback != Feedback::fixed || w.speed_alpha > 0 || w.anti_flicker > 0 || w.weighing != Weighing::none)
    throw Failure(ExitCode::usage,
                  "--accumulator two-sided weighs every sample by its age alone; give --feedback fixed --speed-alpha 0 "
                  "--anti-flicker 0 --weighing none with it, or --accumulator recursive");
}

// Choices that no sequence can make possible.
void check_filters(const RecursiveParameters& recursive) {
  if (recursive.history_filter == HistoryFilter::cubic) {
    const LargestGain gain = cubic_gain(recursive.cubic_b, recursive.cubic_c);
    if (is_expansive(gain))
      throw Failure(ExitCode::usage, expansive_filter_text("cubic with cubic-b " + short_number(recursive.cubic_b) +
                                                               " and cubic-c " + short_number(recursive.cubic_c),
                                                           gain));
  }
  if (recursive.unjitter != Unjitter::none && recursive.sample_filter != SampleFilter::none)
    throw Failure(ExitCode::usage,
                  "--unjitter and --sample-filter both bring the present to the pixel centers; give one of them");
}

// A B-spline is fetched from coefficients, and those of a channel are not those of the color.
void check_companions(const SequenceInfo& info, const RecursiveParameters& recursive) {
  if (recursive.history_filter != HistoryFilter::bspline3 && recursive.history_filter != HistoryFilter::bspline5)
    return;
  for (const Subject& subject : info.first.subjects)
    if (!subject.companions.empty())
      throw Failure(ExitCode::usage,
                    "--channels do not go by the weights of a color whose history is read by a B-spline; give "
                    "--history-filter catmull-rom, or --channel-weights own");
}

// A test that was asked for by name needs its channel in every layer.
void check_tests(const SequenceInfo& info, const Parameters& parameters) {
  const RejectParameters& reject = parameters.recursive.reject;
  const auto refuse = [](const Subject& subject, const char* option, const char* what, const char* remedy) {
    throw Failure(ExitCode::inconsistent,
                  std::string(option) + " needs " + what + ", and " + layer_text(subject) + " has none; " + remedy);
  };
  if (reject.depth_slope > 0 && parameters.recursive.disocclusion != Disocclusion::depth)
    throw Failure(ExitCode::usage, "--depth-slope widens the depth test, which is off; give --disocclusion depth");
  for (const Subject& subject : info.first.subjects) {
    if (reject.id != IdTest::off && !subject.id)
      refuse(subject, "--id-test", "an id", "name it with --map id=CHANNEL, or give --id-test off");
    if (reject.normal_angle > 0 && !subject.normal)
      refuse(subject, "--normal-angle", "a normal",
             "name it with --map normal.x=CHANNEL and so on, or give --normal-angle 0");
    if (reject.tests_vectors() && !subject.backward && !subject.forward && !is_moved_by_camera(info, subject))
      refuse(subject,
             reject.acceleration > 0 ? "--acceleration"
             : reject.speed > 0      ? "--speed-difference"
                                     : "--direction-angle",
             "motion vectors",
             "name them with --map motion.x=CHANNEL and --map motion.y=CHANNEL, or leave the test out");
  }
}

}  // namespace

void check_possible(const SequenceInfo& info, const Parameters& parameters) {
  check_layers(info, parameters);
  check_subpixel(info, parameters);
  if (parameters.accumulator == Accumulator::two_sided) check_two_sided(info, parameters);
  if (parameters.accumulator != Accumulator::gather) check_filters(parameters.recursive);
  if (parameters.accumulator != Accumulator::gather) check_tests(info, parameters);
  if (parameters.accumulator == Accumulator::recursive) check_companions(info, parameters.recursive);
  if (parameters.recursive.disocclusion == Disocclusion::depth)
    for (const Subject& subject : info.first.subjects)
      if (!subject.depth)
        throw Failure(ExitCode::inconsistent,
                      "the depth test needs a depth, and " + layer_text(subject) +
                          " has none; name it with --map depth=CHANNEL or --depth-file FILE, or "
                          "give --disocclusion window");
  if (parameters.accumulator != Accumulator::gather) {
    const std::string clash =
        conflict(parameters.rectify, parameters.recursive, parameters.accumulator != Accumulator::two_sided);
    if (!clash.empty()) throw Failure(ExitCode::usage, clash);
  }
  const bool weigh = parameters.recursive.sample_filter != SampleFilter::none;
  if ((!weigh && parameters.recursive.unjitter == Unjitter::none) || parameters.accumulator == Accumulator::gather ||
      info.frames_with_jitter == int(info.frames.size()))
    return;
  const std::string known = info.frames_with_jitter == 0
                                ? "is not known"
                                : "is known for " + std::to_string(info.frames_with_jitter) + " of " +
                                      std::to_string(info.frames.size()) + " frames only";
  throw Failure(ExitCode::inconsistent, std::string(weigh ? "weighting by sample positions" : "undoing the jitter") +
                                            " needs the jitter of every frame, which " + known +
                                            "; give it with --jitter FILE or --jitter halton23:N, or give " +
                                            (weigh ? "--sample-filter none" : "--unjitter none"));
}

}  // namespace varve
