#include "plan/subpixel_plan.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "plan/describe_rectify.h"
#include "plan/layers_plan.h"
#include "plan/value.h"

namespace varve {
namespace {

std::string weights_text(const SubpixelParameters& p) {
  switch (p.weights) {
    case SubpixelWeights::plain:
      return "a tent of " + short_number(p.radius) + " px";
    case SubpixelWeights::first_order:
      return "a tent of " + short_number(p.radius) + " px, corrected so that nothing drifts";
    case SubpixelWeights::second_order:
      return "a tent of at least 0.75 px, corrected so that nothing drifts and parabolas stay what they are";
    case SubpixelWeights::bilinear:
      break;
  }
  return "one bilinear fetch in each";
}

std::string tests_text(const Parameters& parameters) {
  const RejectParameters& r = parameters.recursive.reject;
  std::string tests = "inside the window";
  if (parameters.recursive.disocclusion == Disocclusion::depth)
    tests += ", depth within " + short_number(parameters.recursive.depth_tolerance * 100) + " %";
  if (r.id != IdTest::off) tests += ", same id";
  if (r.normal_angle > 0) tests += ", normal within " + short_number(r.normal_angle) + " degrees";
  return tests;
}

/// Frames in each quarter of the pixel.
std::array<int, kQuadrants> visits(const SequenceInfo& info) {
  std::array<int, kQuadrants> count{};
  for (const Jitter& jitter : info.jitters) ++count[quadrant_of({jitter.x, jitter.y})];
  return count;
}

void note_visits(const SequenceInfo& info, Plan& plan) {
  if (info.jitters.size() < kQuadrants) return;
  constexpr std::array<const char*, kQuadrants> kNames = {"left above", "right below", "right above", "left below"};
  const std::array<int, kQuadrants> count = visits(info);
  std::string missing;
  for (std::size_t k = 0; k < kQuadrants; ++k)
    if (count[k] == 0) missing += (missing.empty() ? "" : ", ") + std::string(kNames[k]);
  if (!missing.empty())
    plan.notes.push_back(
        "the jitter never visits these quarters of the pixel: " + missing +
        "; they are reconstructed from the others, with less detail. A pattern such as quadrants:16 of "
        "varve jitter visits all in turn");
}

// What makes a picture of the size of the frames only.
void check_scale(const SequenceInfo& info, const Parameters& parameters) {
  if (parameters.accumulator != Accumulator::subpixel)
    throw Failure(ExitCode::usage,
                  "--scale 2 writes the quarters of a pixel, which only --accumulator subpixel keeps; give it, or "
                  "--preset yang, or leave --scale out");
  if (parameters.fallback.any() || parameters.finish.sharpen > 0)
    throw Failure(ExitCode::usage,
                  "--scale 2 writes the quarters of a pixel as they are; give --sharpen 0 --blur-young 0 --motion-blur "
                  "off with it");
  if (composites_after(info))
    throw Failure(ExitCode::usage,
                  "--scale 2 does not put layers together that were resolved apart; give --layers composite, or "
                  "resolve each layer by itself");
  if (info.first.grid > 1)
    throw Failure(ExitCode::usage,
                  "--samples grid makes one pixel of several, and --scale 2 several of one; leave one of them out");
}

}  // namespace

std::vector<PlannedPass> subpixel_passes(const SequenceInfo& info, const Parameters& parameters, Plan& plan) {
  plan.use_jitter = true;
  const RecursiveParameters& r = parameters.recursive;
  if (r.disocclusion == Disocclusion::depth) plan.use_depth = true;
  if (r.reject.id != IdTest::off) plan.use_id = true;
  if (r.reject.normal_angle > 0) plan.use_normal = true;
  note_visits(info, plan);
  std::vector<PlannedPass> passes;
  passes.push_back(
      {"sub-pixel histories", true,
       "each sample goes to the history of its quarter of the pixel, by its jitter; the others are carried "
       "along the vectors until their turn comes"});
  passes.push_back({"reconstruct", true,
                    "up to 16 samples of all four, weighed by " + weights_text(parameters.subpixel) +
                        "; each sample is tested: " + tests_text(parameters)});
  const bool box = parameters.rectify.box != Box::none;
  passes.push_back({"neighborhood box", box,
                    box ? "what history may say: " + describe_box(parameters.rectify)
                        : "not asked for: samples of other quarters look elsewhere"});
  passes.push_back({"rectify", box, box ? describe_rule(parameters.rectify) : "no box"});
  passes.push_back(
      {"blend", true,
       r.alpha_rule == AlphaRule::fixed
           ? "the present weighs " + short_number(r.alpha) + " in its quarter"
           : "the present weighs 1/n in its quarter for n samples seen, at least " + short_number(r.alpha)});
  passes.push_back(bounds_pass(parameters));
  passes.push_back(
      {"picture", true,
       parameters.subpixel.scale > 1
           ? "each quarter of a pixel becomes a pixel: twice the width and height; what is not resolved is "
             "repeated 2x2"
           : "each pixel is the mean of its four quarters as they are now"});
  return passes;
}

PlannedPass bounds_pass(const Parameters& parameters) {
  const RecursiveParameters& r = parameters.recursive;
  if (!r.bounds()) return {"bounds", false, "neither blur nor residual is bounded"};
  std::string text;
  if (r.blur_limit > 0) {
    const bool four = parameters.accumulator == Accumulator::subpixel;
    text = "the present weighs more where blur would pass " + short_number(r.blur_limit) + " px^2, ";
    if (four && parameters.subpixel.bound == BlurBound::tabulated)
      text += "by a table of steady motions";
    else if (four || r.history_filter == HistoryFilter::bilinear || r.history_filter == HistoryFilter::cubic)
      text += "as each pixel's kernel came about";
    else
      text +=
          "which does not happen with this history filter: it keeps second moments, so that its blur is none of "
          "variance";
  }
  if (r.residual_limit > 0)
    text += (text.empty() ? "" : "; ") + std::string("the present weighs more where history lags by more than ") +
            short_number(r.residual_limit) + " of the light";
  return {"bounds", true, text};
}

void check_subpixel(const SequenceInfo& info, const Parameters& parameters) {
  const RecursiveParameters& r = parameters.recursive;
  const bool four = parameters.accumulator == Accumulator::subpixel;
  if (r.bounds() && !four && parameters.accumulator != Accumulator::recursive)
    throw Failure(
        ExitCode::usage,
        "--blur-limit and --residual-limit bound the weight of the present, which this --accumulator does not "
        "choose; give 0, or --accumulator recursive or subpixel");
  if (parameters.subpixel.scale > 1) check_scale(info, parameters);
  if (!four) return;
  if (r.sample_filter != SampleFilter::none || r.unjitter != Unjitter::none)
    throw Failure(ExitCode::usage,
                  "--accumulator subpixel takes samples where they lie; give --sample-filter none and --unjitter none");
  if (r.reject.tests_vectors())
    throw Failure(ExitCode::usage,
                  "--accumulator subpixel reads histories that are several frames old, whose vectors say nothing of "
                  "this one; leave --acceleration, --speed-difference and --direction-angle out");
  if (r.reject.on_reject != OnReject::restart)
    throw Failure(ExitCode::usage, "--accumulator subpixel drops what it does not believe; give --on-reject restart");
  const WeightParameters& w = r.weight;
  if (w.feedback != Feedback::fixed || w.speed_alpha > 0 || w.anti_flicker > 0 || w.weighing != Weighing::none)
    throw Failure(ExitCode::usage,
                  "--accumulator subpixel weighs by age and its bounds alone; give --feedback fixed --speed-alpha 0 "
                  "--anti-flicker 0 --weighing none with it, or --accumulator recursive");
  if (parameters.rectify.box != Box::none)
    for (const Subject& subject : info.first.subjects)
      if (!subject.companions.empty())
        throw Failure(
            ExitCode::usage,
            "--channels do not go by the weights of a color that a box moves with --accumulator subpixel; give "
            "--box none, or --channel-weights own");
  if (info.frames_with_jitter == int(info.frames.size())) return;
  const std::string known = info.frames_with_jitter == 0
                                ? "is not known"
                                : "is known for " + std::to_string(info.frames_with_jitter) + " of " +
                                      std::to_string(info.frames.size()) + " frames only";
  throw Failure(ExitCode::inconsistent,
                "--accumulator subpixel needs the jitter of every frame, which " + known +
                    "; give it with --jitter FILE or --jitter pixels, say which pattern the renderer used with "
                    "--assume-jitter halton23:16 or another, or give --preset salvi");
}

std::size_t subpixel_bytes_per_pixel(const Parameters& parameters, std::size_t companions) {
  const RecursiveParameters& r = parameters.recursive;
  // Color, total, spread, moments, way.
  const std::size_t buffer = 16 + 4 + 4 + 12 + 8 + 16 * companions + (r.disocclusion == Disocclusion::depth ? 4 : 0) +
                             (r.reject.id != IdTest::off ? 4 : 0) + (r.reject.normal_angle > 0 ? 12 : 0);
  const std::size_t residual = r.residual_limit > 0 ? 20 : 0;
  const std::size_t quarters = parameters.subpixel.scale > 1 ? 8 * 16 * (1 + companions) : 0;  // and as written
  return 5 * buffer + residual + quarters;  // one more while a sample is blended in
}

double subpixel_nanoseconds(const Parameters& parameters, std::size_t companions) {
  const bool second = parameters.subpixel.weights == SubpixelWeights::second_order;
  const double quarter = second ? 1400 : 700, plane = 120;  // set by one measurement of the whole program
  const double residual = parameters.recursive.residual_limit > 0 ? 12.0 * parameters.recursive.residual_window : 0.0;
  return 4 * (quarter + plane * double(companions)) + residual;
}

}  // namespace varve
