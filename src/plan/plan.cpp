#include "plan/plan.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/error.h"
#include "base/parallel.h"
#include "diagnose/aov.h"
#include "plan/cost.h"
#include "plan/expansive.h"

namespace varve {
namespace {

std::string layer_text(const Subject& subject) {
  std::string text = subject.layer.empty() ? "the main layer" : "layer " + subject.layer;
  if (!subject.view.empty()) text += " of view " + subject.view;
  return text;
}

std::string short_number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%g", value);
  return digits;
}

std::size_t count_if(const SequenceInfo& info, bool (*has)(const Subject&)) {
  return std::size_t(std::count_if(info.first.subjects.begin(), info.first.subjects.end(), has));
}
bool has_depth(const Subject& s) { return s.depth.has_value(); }
bool only_forward(const Subject& s) { return !s.backward && s.forward; }
bool has_motion(const Subject& s) { return s.backward || s.forward; }

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

// What was asked for outright and cannot be done. Falling back silently would change the picture without a word.
void check_possible(const SequenceInfo& info, const Parameters& parameters) {
  check_filters(parameters.recursive);
  if (parameters.recursive.disocclusion == Disocclusion::depth)
    for (const Subject& subject : info.first.subjects)
      if (!subject.depth)
        throw Failure(ExitCode::inconsistent,
                      "the depth test needs a depth, and " + layer_text(subject) +
                          " has none; name it with --map depth=CHANNEL or --depth-file FILE, or "
                          "give --disocclusion window");
  const bool weigh = parameters.recursive.sample_filter != SampleFilter::none;
  if ((!weigh && parameters.recursive.unjitter == Unjitter::none) || info.frames_with_jitter == int(info.frames.size()))
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

/// Adds the passes in running order and remembers what they need.
class Planner {
 public:
  Planner(const SequenceInfo& info, const Parameters& parameters, const OutputRequest& output, Plan& plan)
      : info_(info), parameters_(parameters), output_(output), plan_(plan), subjects_(info.first.subjects.size()) {}

  void motion() {
    const std::size_t moving = count_if(info_, has_motion), inverted = count_if(info_, only_forward);
    plan_.use_motion = moving > 0;
    if (moving == 0) {
      add("motion", false, "no vectors, so every pixel follows itself");
      add("invert forward", false, "no vectors");
      return;
    }
    const auto moves = std::find_if(info_.first.subjects.begin(), info_.first.subjects.end(), has_motion);
    add("motion", true, "vectors of convention " + moves->convention + " are decoded to pixels" + share(moving));
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
    if (info_.frames.size() < 2) {
      add("history", false, "there is one frame only, so nothing came before");
      add("window test", false, "no history");
      add("depth test", false, "no history");
      return;
    }
    add("history", true,
        plan_.use_motion ? "one frame back along the vectors, " + filter : "one frame back at the same pixel");
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
    if (info_.frames.size() < 2) {
      add("neighborhood box", false, "no history to hold against it");
      add("rectify", false, "no history");
      return;
    }
    const std::string edge = std::to_string(r.window), size = edge + "x" + edge;
    const std::string space = r.space == BoxSpace::ycocg ? "YCoCg" : "RGB";
    const std::string gamma = "gamma " + short_number(r.gamma);
    const std::string kind = r.box == Box::minmax     ? "least and greatest"
                             : r.box == Box::variance ? "variance, " + gamma
                                                      : "variance, " + gamma + ", cut by least and greatest";
    add("neighborhood box", true, "what history may say: " + kind + ", of " + size + " pixels in " + space);
    add("rectify", true,
        std::string(r.rule == BoxRule::clip ? "history is clipped towards the " : "history is clamped, anchor ") +
            (r.anchor == BoxAnchor::present ? "present" : "mean") + ", which removes what is no longer there");
  }

  void blend() {
    const RecursiveParameters& r = parameters_.recursive;
    add("blend", true,
        r.alpha_rule == AlphaRule::fixed
            ? "the present weighs " + short_number(r.alpha)
            : "the present weighs 1/n for n frames seen, at least " + short_number(r.alpha));
  }

  void finish() {
    const double strength = parameters_.finish.sharpen;
    add("sharpen", strength > 0,
        strength > 0 ? "strength " + short_number(strength) + ", of what is written only" : "not asked for");
  }

  void outputs() {
    std::string names;
    for (const std::string& name : output_.aovs) {
      if (name != "all" && !find_aov(name))
        throw Failure(ExitCode::usage,
                      "--aov " + name + ": there is no such diagnostic plane; varve help aovs lists them");
      names += (names.empty() ? "" : ", ") + name;
    }
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
      if (plan_.use_depth) read(subject.depth);
      const std::optional<VectorChannels>& vector = subject.backward ? subject.backward : subject.forward;
      if (vector) read((*vector)[0]), read((*vector)[1]);
    }
    std::sort(plan_.channels.begin(), plan_.channels.end(), [](const ChannelRef& a, const ChannelRef& b) {
      return std::array{a.file, a.part, a.channel} < std::array{b.file, b.part, b.channel};
    });
  }

  void add(const char* name, bool runs, std::string reason) { plan_.passes.push_back({name, runs, std::move(reason)}); }

 private:
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
  planner.add("sanitize", true, "pixels that are not finite are kept from spreading");
  planner.motion();
  planner.dilate();
  planner.history();
  planner.sample_weights();
  planner.rectify();
  planner.blend();
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
  plan.bytes = estimate_bytes(info, plan, parameters, output);
  plan.seconds_per_frame = estimate_seconds(info, plan, parameters, output, threads > 0 ? threads : Workers().count());
  return plan;
}

}  // namespace varve
