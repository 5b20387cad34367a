#include "plan/plan.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/parallel.h"
#include "plan/camera_plan.h"
#include "plan/check_possible.h"
#include "plan/cost.h"
#include "plan/deep_plan.h"
#include "plan/describe_rectify.h"
#include "plan/gather_plan.h"
#include "plan/layers_plan.h"
#include "plan/repair_plan.h"
#include "plan/samples_plan.h"
#include "plan/subpixel_plan.h"
#include "plan/two_sided_plan.h"
#include "plan/value.h"

namespace varve {
namespace {

std::size_t count_if(const SequenceInfo& info, bool (*has)(const Subject&)) {
  return std::size_t(std::count_if(info.first.subjects.begin(), info.first.subjects.end(), has));
}
bool has_depth(const Subject& s) { return s.depth.has_value(); }
bool only_forward(const Subject& s) { return !s.backward && s.forward; }
bool has_motion(const Subject& s) { return s.backward || s.forward; }

/// Adds the passes in running order and remembers what they need.
class Planner {
 public:
  Planner(const SequenceInfo& info, const Parameters& parameters, const OutputRequest& output, Plan& plan)
      : info_(info), parameters_(parameters), output_(output), plan_(plan), subjects_(info.first.subjects.size()) {}

  void motion() {
    const std::size_t moving = count_if(info_, has_motion), inverted = count_if(info_, only_forward);
    const std::size_t by_camera = moved_by_camera(info_);
    plan_.use_motion = moving + by_camera > 0;
    if (moving == 0 && by_camera > 0) {
      add("motion", true,
          "there are no vectors: what rests in the world is carried by its depth and the cameras" + share(by_camera));
      if (parameters_.accumulator != Accumulator::gather)
        add("invert forward", false, "vectors made from cameras lead both ways");
      return;
    }
    if (moving == 0) {
      add("motion", false, "no vectors, so every pixel follows itself");
      if (parameters_.accumulator != Accumulator::gather) add("invert forward", false, "no vectors");
      return;
    }
    const auto moves = std::find_if(info_.first.subjects.begin(), info_.first.subjects.end(), has_motion);
    add("motion", true, "vectors of convention " + moves->convention + " are decoded to pixels" + share(moving));
    if (parameters_.accumulator == Accumulator::gather) return;  // it says itself what it makes of them
    if (inverted == 0) {
      add("invert forward", false, "there are vectors to the previous frame");
      return;
    }
    const bool depth = std::any_of(info_.first.subjects.begin(), info_.first.subjects.end(),
                                   [](const Subject& s) { return only_forward(s) && s.depth; });
    if (depth) plan_.use_depth = true;
    add("invert forward", true,
        std::string("only vectors to the next frame are there: those of the frame before are carried forward") +
            share(inverted) + (depth ? "; depth tells which surface is in front" : ""));
  }

  void gather() {
    refuse_spill();
    for (PlannedPass& pass : gather_passes(info_, parameters_, plan_)) plan_.passes.push_back(std::move(pass));
  }

  void refuse_spill() const {
    if (!output_.spill_folder.empty())
      throw Failure(ExitCode::usage, "--spill keeps the future of --accumulator two-sided; leave it out");
  }

  void sides() {
    const bool two_sided = parameters_.accumulator == Accumulator::two_sided;
    if (!two_sided) return refuse_spill();
    plan_.use_forward = true;
    const auto inverts = [](const Subject& s) { return has_motion(s) && !(s.backward && s.forward); };
    const std::size_t inverted = count_if(info_, inverts);
    const bool depth = std::any_of(info_.first.subjects.begin(), info_.first.subjects.end(),
                                   [&](const Subject& s) { return inverts(s) && s.depth; });
    if (depth) plan_.use_depth = true;
    plan_.passes.push_back(motion_of_both_sides(count_if(info_, has_motion) > 0, inverted > 0, depth,
                                                parameters_.two_sided.return_tolerance > 0, share(inverted)));
    plan_.passes.push_back(past_and_future(parameters_, output_));
  }

  void dilate() {
    const Dilation asked = parameters_.motion.dilation;
    const std::size_t with_depth = count_if(info_, has_depth);
    if (!plan_.use_motion) return add("dilate", false, "no vectors");
    if (asked == Dilation::none) return add("dilate", false, "each pixel follows its own vector, as asked");
    if (asked == Dilation::longest)
      return add("dilate", true, "the longest of the 3x3 vectors, so that soft edges move with what moves");
    if (with_depth > 0) plan_.use_depth = true;
    if (with_depth == subjects_)
      return add("dilate", true, "the vector of the nearest of 3x3 surfaces, so that soft edges move with the front");
    add("dilate", true,
        "the longest of the 3x3 vectors where depth is missing, since nearest needs depth" +
            (with_depth > 0 ? "; nearest elsewhere" : std::string()));
    plan_.notes.push_back("dilation by nearest depth was asked for, but " +
                          (with_depth == 0 ? std::string("there is no depth")
                                           : std::to_string(subjects_ - with_depth) + " of the layers have no depth") +
                          "; the longest vector is taken there");
  }

  void history() {
    constexpr std::array<const char*, 7> kFilters = {
        "bilinear", "16-tap Catmull-Rom", "9-tap Catmull-Rom", "5-tap Catmull-Rom",
        "cubic",    "cubic B-spline",     "quintic B-spline"};
    std::string filter = kFilters[std::size_t(parameters_.recursive.history_filter)];
    if (parameters_.recursive.history_filter == HistoryFilter::cubic)
      filter += " with B " + short_number(parameters_.recursive.cubic_b) + " and C " +
                short_number(parameters_.recursive.cubic_c);
    if (stands_alone()) {
      add("history", false, "there is one frame only, so nothing came before");
      add("window test", false, "no history");
      add("depth test", false, "no history");
      return;
    }
    const std::string way =
        parameters_.accumulator == Accumulator::two_sided ? "one frame back, and one ahead, " : "one frame back ";
    add("history", true, plan_.use_motion ? way + "along the vectors, " + filter : way + "at the same pixel");
    add("window test", true,
        "history outside the data window is no data" + std::string(info_.windows_move ? ", and the window moves" : ""));
    const bool test = parameters_.recursive.disocclusion == Disocclusion::depth;
    if (test) plan_.use_depth = true;
    const bool any_depth = count_if(info_, has_depth) > 0;
    add("depth test", test,
        test ? "history starts over where depth differs by more than " +
                   short_number(parameters_.recursive.depth_tolerance * 100) + " %"
        : any_depth ? "not asked for; --disocclusion depth turns it on"
                    : "there is no depth");
  }

  // Names of the tests with their numbers, or why there are none.
  void rejection() {
    const RejectParameters& r = parameters_.recursive.reject;
    std::string tests;
    const auto test = [&](bool asked, const std::string& text) {
      if (asked) tests += (tests.empty() ? "" : ", ") + text;
      return asked && has_others(info_);
    };
    plan_.use_normal = test(r.normal_angle > 0, "normals by " + short_number(r.normal_angle) + " degrees");
    if (test(r.id != IdTest::off, r.id == IdTest::soft ? "ids with soft edges" : "ids")) plan_.use_id = true;
    test(r.speed > 0, "lengths of vectors by " + short_number(r.speed) + " px");
    test(r.direction > 0, "directions by " + short_number(r.direction) + " degrees");
    test(r.acceleration > 0, "vectors from " + short_number(std::min(r.acceleration_low, r.acceleration)) + " to " +
                                 short_number(r.acceleration) + " px");
    constexpr std::array<const char*, 3> kThen = {"start over", "start over blurred", "converge faster"};
    if (tests.empty()) return add("rejection", false, "no further test asked for");
    if (!has_others(info_)) return add("rejection", false, "no history");
    add("rejection", true, "pixels " + std::string(kThen[std::size_t(r.on_reject)]) + " where these differ: " + tests);
  }

  void weights() {
    if (parameters_.accumulator == Accumulator::two_sided)
      return add("weights", false, "both sides weigh by what they have seen; masks have no say");
    const WeightParameters& w = parameters_.recursive.weight;
    const bool reactive = std::any_of(info_.first.subjects.begin(), info_.first.subjects.end(),
                                      [](const Subject& s) { return s.reactive.has_value(); });
    const bool responsive = std::any_of(info_.first.subjects.begin(), info_.first.subjects.end(),
                                        [](const Subject& s) { return s.responsive.has_value(); });
    const bool history = has_others(info_);
    plan_.use_reactive = history && reactive && w.reactive > 0;
    plan_.use_responsive = history && responsive;
    std::string by;
    const auto add_if = [&](bool used, const char* text) {
      if (used) by += std::string(by.empty() ? "" : ", ") + text;
    };
    add_if(w.feedback == Feedback::luma, "agreement of luma");
    add_if(w.speed_alpha > parameters_.recursive.alpha, "speed");
    add_if(w.anti_flicker > 0, "nearness to the wall of the box");
    add_if(plan_.use_reactive, "the reactive mask");
    add_if(plan_.use_responsive, "the responsive mask");
    add_if(w.weighing == Weighing::luminance, "brightness, which darkens");
    add_if(w.weighing == Weighing::logarithm, "logarithms, which darkens");
    if (by.empty()) return add("weights", false, "every pixel of the present weighs the same");
    if (!history) return add("weights", false, "no history");
    add("weights", true, "the present weighs by " + by);
  }

  void sample_weights() {
    const bool weigh = parameters_.recursive.sample_filter != SampleFilter::none;
    const bool unjitter = parameters_.recursive.unjitter != Unjitter::none;
    plan_.use_jitter = weigh || unjitter;
    add("unjitter", unjitter,
        unjitter ? "the jitter is known: the present is read at the pixel centers, between its samples"
                 : "not asked for; samples stand for their pixels");
    add("sample weights", weigh,
        weigh ? "the jitter is known: samples count by their distance from the pixel center"
        : info_.frames_with_jitter > 0
            ? "the jitter is known, but no sample filter is asked for; --sample-filter NAME turns it on"
            : "the jitter is not known");
  }

  void rectify() {
    const RectifyParameters& r = parameters_.rectify;
    if (r.box == Box::none) {
      add("neighborhood box", false, "no rectification, as asked");
      add("rectify", false, "no box");
      return;
    }
    if (stands_alone()) {
      add("neighborhood box", false, "no history to hold against it");
      add("rectify", false, "no history");
      return;
    }
    add("neighborhood box", true, "what history may say: " + describe_box(r));
    add("rectify", true, describe_rule(r));
    if (r.moments == WindowMoments::direct && r.window > 7)
      plan_.notes.push_back("each pixel looks at " + std::to_string(r.window * r.window) +
                            " neighbors, which is slow; --moments separable gives the variance box of that window at a "
                            "cost that does not grow with it");
  }

  void blend() {
    const RecursiveParameters& r = parameters_.recursive;
    if (parameters_.accumulator == Accumulator::two_sided) return add("blend", true, blend_of_both_sides(parameters_));
    add("blend", true,
        r.alpha_rule == AlphaRule::fixed
            ? "the present weighs " + short_number(r.alpha)
            : "the present weighs 1/n for n frames seen, at least " + short_number(r.alpha));
  }

  void companions() {
    std::size_t channels = 0;
    for (const Subject& subject : info_.first.subjects)
      for (const Companion& companion : subject.companions)
        channels += std::size_t(std::count_if(companion.channels.begin(), companion.channels.end(),
                                              [](const auto& channel) { return channel.has_value(); }));
    const std::string alike = parameters_.accumulator == Accumulator::gather
                                  ? "the same samples of the frames around, weighed alike"
                                  : "the same pixels of the history, moved as far, blended alike";
    add("companions", channels > 0,
        channels == 0 ? "no channels go by the weights of a color; --channels names some"
                      : std::to_string(channels) + " channels go by the weights of their color: " + alike +
                            "; lights that add up to the color still do, and each frame reports how well");
  }

  void fallback() {
    const FallbackParameters& f = parameters_.fallback;
    std::string what;
    if (f.motion_blur != MotionBlur::off && plan_.use_motion)
      what = "what moves by " + short_number(f.blur_from) + " to " + short_number(f.blur_to) +
             " px and more is shown blurred along its motion";
    if (f.young_frames > 0)
      what += (what.empty() ? "" : "; ") + std::string("the first ") + std::to_string(f.young_frames) +
              (f.young_filter == YoungFilter::blur ? " frames of a history are shown soft"
                                                   : " frames of a history are shown with smoothed edges");
    add("fallback", !what.empty(),
        !what.empty()                      ? what + "; history is not touched"
        : f.motion_blur != MotionBlur::off ? "no vectors"
                                           : "the resolve is shown as it is");
  }

  void finish() {
    const double strength = parameters_.finish.sharpen;
    add("sharpen", strength > 0,
        strength > 0 ? "strength " + short_number(strength) + ", of what is written only" : "not asked for");
  }

  void outputs() {
    planned_aovs(output_, parameters_.accumulator);
    std::string names;
    for (const std::string& name : output_.aovs) names += (names.empty() ? "" : ", ") + name;
    add("diagnostics", !names.empty(),
        names.empty() ? "none asked for"
                      : names + (output_.diagnostics_apart ? ", in files of their own" : ", in the output"));
    add("write", true,
        output_.keep_channels ? "resolved color; other channels and parts as they are" : "resolved color only");
  }

  void channels() {
    const auto read = [&](const std::optional<ChannelRef>& ref) {
      if (ref && std::find(plan_.channels.begin(), plan_.channels.end(), *ref) == plan_.channels.end())
        plan_.channels.push_back(*ref);
    };
    for (const Subject& subject : info_.first.subjects) {
      for (const std::optional<ChannelRef>& channel : subject.color) read(channel);
      for (const Companion& companion : subject.companions)
        for (const std::optional<ChannelRef>& channel : companion.channels) read(channel);
      if (plan_.use_depth) read(subject.depth);
      if (plan_.use_id) read(subject.id);
      if (plan_.use_normal && subject.normal)
        for (const ChannelRef& axis : *subject.normal) read(axis);
      if (plan_.use_reactive) read(subject.reactive);
      if (plan_.use_responsive) read(subject.responsive);
      if (subject.transmittance)
        for (const ChannelRef& channel : subject.transmittance->channels) read(channel);
      const std::optional<VectorChannels>& vector = subject.backward ? subject.backward : subject.forward;
      if (vector) read((*vector)[0]), read((*vector)[1]);
      if (plan_.use_forward && subject.forward) read((*subject.forward)[0]), read((*subject.forward)[1]);
    }
    std::sort(plan_.channels.begin(), plan_.channels.end(), [](const ChannelRef& a, const ChannelRef& b) {
      return std::array{a.file, a.part, a.channel} < std::array{b.file, b.part, b.channel};
    });
  }

  void add(const char* name, bool runs, std::string reason) { plan_.passes.push_back({name, runs, std::move(reason)}); }

 private:
  // One frame, and none around it to look at.
  bool stands_alone() const { return !has_others(info_) && parameters_.accumulator == Accumulator::recursive; }

  // " (2 of 3 layers)" when a pass does not concern all.
  std::string share(std::size_t count) const {
    return count == subjects_ ? "" : " (" + std::to_string(count) + " of " + std::to_string(subjects_) + " layers)";
  }

  const SequenceInfo& info_;
  const Parameters& parameters_;
  const OutputRequest& output_;
  Plan& plan_;
  std::size_t subjects_;
};

}  // namespace

Plan make_plan(const SequenceInfo& info, const Parameters& parameters, const OutputRequest& output, int threads) {
  check_possible(info, parameters);
  Plan plan;
  Planner planner(info, parameters, output, plan);
  planner.add("read", true, "");
  if (std::optional<PlannedPass> flatten = flatten_pass(info)) plan.passes.push_back(std::move(*flatten));
  planner.add("sanitize", true, "pixels that are not finite are kept from spreading");
  for (PlannedPass& pass : samples_passes(info, parameters, plan.notes)) plan.passes.push_back(std::move(pass));
  planner.motion();
  plan.passes.push_back(camera_pass(info, parameters, plan));
  plan.passes.push_back(repair_pass(info, parameters, plan));
  if (!composites_after(info) && info.first.sample_jitter.empty()) plan.passes.push_back(layers_pass(info));
  if (parameters.accumulator == Accumulator::gather) {
    planner.gather();
  } else {
    planner.sides();
    planner.dilate();
  }
  if (parameters.accumulator == Accumulator::subpixel) {
    for (PlannedPass& pass : subpixel_passes(info, parameters, plan)) plan.passes.push_back(std::move(pass));
  } else if (parameters.accumulator != Accumulator::gather) {
    planner.history();
    planner.rejection();
    planner.sample_weights();
    planner.rectify();
    planner.weights();
    planner.blend();
    if (parameters.accumulator == Accumulator::recursive) plan.passes.push_back(bounds_pass(parameters));
  }
  if (composites_after(info)) plan.passes.push_back(layers_pass(info));
  planner.companions();
  planner.fallback();
  planner.finish();
  planner.outputs();
  planner.channels();
  std::size_t present = 0;
  for (const FileHeader& file : info.first.files)
    for (const Part& part : file.parts) present += part.channels.size();
  plan.passes.front().reason =
      std::to_string(plan.channels.size()) + " of " + std::to_string(present) + " channels are needed";
  for (const Subject& subject : info.first.subjects)
    for (const std::string& note : subject.notes)
      plan.notes.push_back((subject.view.empty() ? "" : "view " + subject.view + ": ") + note);
  for (const ColorOutput& made : info.first.outputs)
    for (const std::string& note : made.subject.notes)
      if (made.combine != Combine::alone)
        plan.notes.push_back((made.subject.view.empty() ? "" : "view " + made.subject.view + ": ") + note);
  plan.bytes = estimate_bytes(info, plan, parameters, output);
  plan.seconds_per_frame = estimate_seconds(info, plan, parameters, output, threads > 0 ? threads : Workers().count());
  return plan;
}

}  // namespace varve
