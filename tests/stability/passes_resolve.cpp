#include "plan/knob_words.h"
#include "resolve/fallback.h"
#include "resolve/sample_weights.h"
#include "resolve/sharpen.h"
#include "resolve/two_sided.h"
#include "stability/passes.h"

namespace varve::stability {
namespace {

constexpr DiagnosticsWanted kWanted{true, true, false, false};

Planes recurse(const RawShot& shot, const Settings& s, bool companions, Workers& workers) {
  Planes planes;
  History history;
  for (const RawFrame& frame : shot) {
    Accumulated done = accumulate(present_of(frame, workers, companions), history, s.recursive, s.rectify, frame.jitter,
                                  1, kWanted, workers);
    history = std::move(done.history);
    planes.colors.push_back(history.color.clone());
    for (const Plane<glm::vec4>& companion : history.companions) planes.colors.push_back(companion.clone());
    planes.numbers.push_back(history.total.clone());
    planes.numbers.push_back(history.spread.clone());
    planes.numbers.push_back(std::move(done.diagnostics.weight));
  }
  return planes;
}

Planes both_sides(const RawShot& shot, const Settings& s, Workers& workers) {
  Planes planes;
  std::vector<StrictSide> futures(shot.size());
  History state;
  for (std::size_t i = shot.size(); i-- > 0;) {
    SideStep step = accumulate_side(turned_present(shot[i], workers), state, s.recursive, s.rectify, shot[i].jitter, 1,
                                    kWanted, workers);
    futures[i] = std::move(step.strict), state = std::move(step.state);
  }
  state = {};
  for (std::size_t i = 0; i < shot.size(); ++i) {
    MergedStep step = accumulate_both(present_of(shot[i], workers), state, futures[i], s.recursive, s.rectify,
                                      shot[i].jitter, 1, kWanted, workers);
    planes.colors.push_back(std::move(step.resolved.history.color));
    planes.numbers.push_back(std::move(step.resolved.history.total));
    planes.numbers.push_back(std::move(step.resolved.history.spread));
    state = std::move(step.state);
  }
  return planes;
}

template <class Set>
Settings settings(const Set& set) {
  Settings s;
  set(s);
  return s;
}

Pass recursive_pass(std::string name, const Settings& s, bool companions = false) {
  Pass pass{std::move(name),
            [s, companions](const RawShot& shot, Workers& w) { return recurse(shot, s, companions, w); }};
  if (!companions) pass.recursive = s;
  pass.support = s.rectify.window / 2 + 3;
  if (s.rectify.moments == WindowMoments::pyramid && s.rectify.box != Box::none) {
    pass.support = 3 * s.rectify.window;
    pass.mirror = -1;  // squares are counted from the window's corner
  }
  // Logarithms of alpha and light meet on one segment: a few steps of float more.
  if (s.rectify.space == BoxSpace::log) pass.mirror = 2e-4;
  // Coefficients fade by .27 (degree 3) and .43 (degree 5) a pixel; what is changed is of the size of the picture.
  if (s.recursive.history_filter == HistoryFilter::bspline3) pass.support += 24;
  if (s.recursive.history_filter == HistoryFilter::bspline5) pass.support += 36;
  return pass;
}

void add_boxes(std::vector<Pass>& passes) {
  for (const Word<Box>& box : kBoxes)
    for (const Word<BoxRule>& rule : kBoxRules)
      for (const Word<BoxAnchor>& anchor : kBoxAnchors)
        for (const Word<BoxSpace>& space : kBoxSpaces) {
          Settings s;
          s.rectify.box = box.value, s.rectify.rule = rule.value;
          s.rectify.anchor = anchor.value, s.rectify.space = space.value;
          s.rectify.gamma = 0.75;
          // Anchors matter to clipping alone, and the spaces are taken in turn with the other rules.
          if (rule.value != BoxRule::clip && anchor.value != BoxAnchor::present) continue;
          if (box.value == Box::none && (rule.value != BoxRule::clip || space.value != BoxSpace::rgb)) continue;
          if (!conflict(s.rectify, s.recursive).empty()) continue;
          passes.push_back(recursive_pass("accumulate box " + std::string(box.word) + " " + std::string(rule.word) +
                                              " " + std::string(anchor.word) + " " + std::string(space.word),
                                          s));
        }
}

void add_windows(std::vector<Pass>& passes) {
  for (const Word<WindowMoments>& moments : kMoments)
    for (const int window : {3, 7, 15, 63})
      for (const Box box : {Box::variance, Box::variance_minmax, Box::minmax}) {
        if (moments.value == WindowMoments::direct && window > 7) continue;
        Settings s;
        s.rectify.box = box, s.rectify.moments = moments.value, s.rectify.window = window;
        if (!conflict(s.rectify, s.recursive).empty()) continue;
        const char* const word = box == Box::variance ? "variance" : box == Box::minmax ? "minmax" : "variance-minmax";
        passes.push_back(recursive_pass(
            "accumulate moments " + std::string(moments.word) + " " + std::to_string(window) + " " + word, s));
      }
}

void add_histories(std::vector<Pass>& passes) {
  for (const Word<HistoryFilter>& filter : kHistoryFilters)
    for (const bool dering : {true, false}) {
      const Settings s = settings([&](Settings& t) {
        t.recursive.history_filter = filter.value, t.recursive.dering = dering;
        t.recursive.alpha = 0.2;
      });
      Pass pass = recursive_pass("accumulate filter " + std::string(filter.word) + (dering ? "" : " no dering"), s);
      // Far beyond the last float there is nothing exact to keep; the law of constancy holds for the rest.
      passes.push_back(pass);
      Settings open = s;
      open.rectify.box = Box::none;
      pass = recursive_pass("accumulate filter " + std::string(filter.word) + (dering ? "" : " no dering") + " no box",
                            open);
      passes.push_back(pass);
    }
  for (const double gamma : {0.0, 1e-6, 100.0})
    for (const double alpha : {1e-6, 0.1, 1.0})
      for (const Word<AlphaRule>& rule : kAlphaRules)
        passes.push_back(recursive_pass("accumulate gamma " + std::to_string(gamma) + " alpha " +
                                            std::to_string(alpha) + " " + std::string(rule.word),
                                        settings([&](Settings& t) {
                                          t.rectify.gamma = gamma, t.recursive.alpha = alpha;
                                          t.recursive.alpha_rule = rule.value;
                                        })));
  for (const bool shapes : {false, true})
    passes.push_back(recursive_pass(shapes ? "accumulate clip discount ellipsoid" : "accumulate clip discount",
                                    settings([&](Settings& t) {
                                      t.rectify.clip_discount = true;
                                      if (shapes) t.rectify.box = Box::ellipsoid;
                                    })));
}

void add_tests_and_weights(std::vector<Pass>& passes) {
  for (const Word<OnReject>& then : kOnRejects) {
    const auto add = [&](const char* name, const auto& set) {
      Settings s;
      s.recursive.reject.on_reject = then.value;
      s.recursive.weight.reactive = 0;
      set(s.recursive);
      passes.push_back(recursive_pass("reject " + std::string(name) + " " + std::string(then.word), s));
    };
    add("depth", [](auto& p) { p.disocclusion = Disocclusion::depth; });
    add("slope", [](auto& p) { p.disocclusion = Disocclusion::depth, p.reject.depth_slope = 1.5; });
    add("normal", [](auto& p) { p.reject.normal_angle = 25; });
    add("id", [](auto& p) { p.reject.id = IdTest::hard; });
    add("soft id", [](auto& p) { p.reject.id = IdTest::soft; });
    add("speed", [](auto& p) { p.reject.speed = 0.8; });
    add("direction", [](auto& p) { p.reject.direction = 50; });
    add("acceleration", [](auto& p) { p.reject.acceleration = 5, p.reject.acceleration_low = 1; });
  }
  const auto add = [&](const char* name, const auto& set) {
    Settings s;
    set(s.recursive.weight);
    passes.push_back(recursive_pass("weight " + std::string(name), s));
  };
  add("luma", [](auto& p) { p.feedback = Feedback::luma; });
  add("speed", [](auto& p) { p.speed_alpha = 0.7, p.full_speed = 4; });
  add("anti-flicker", [](auto& p) { p.anti_flicker = 1; });
  add("masks", [](auto& p) { p.reactive = 0.9; });
  for (const Word<Weighing>& weighing : kWeighings)
    for (const double exposure : {0.0, -100.0, 100.0}) {
      Settings s;
      s.recursive.weight.weighing = weighing.value, s.recursive.weight.exposure = exposure;
      Pass pass =
          recursive_pass("weighing " + std::string(weighing.word) + " exposure " + std::to_string(int(exposure)), s);
      pass.scales = weighing.value == Weighing::none;  // the others know what is bright
      pass.mirror = 1e-4;
      passes.push_back(pass);
    }
}

void add_samples(std::vector<Pass>& passes) {
  for (const Word<SampleFilter>& filter : kSampleFilters) {
    if (filter.value == SampleFilter::none) continue;
    Pass pass{"weigh_samples " + std::string(filter.word), [filter](const RawShot& shot, Workers& w) {
                Planes planes;
                for (const RawFrame& frame : shot) {
                  WeighedPresent out = weigh_samples(present_of(frame, w), filter.value, frame.jitter, w);
                  planes.colors.push_back(std::move(out.color)), planes.numbers.push_back(std::move(out.sample_weight));
                }
                return planes;
              }};
    pass.constant = false;  // to half a step of float: see the test of its own
    passes.push_back(pass);
    pass = recursive_pass("accumulate samples " + std::string(filter.word),
                          settings([&](Settings& s) { s.recursive.sample_filter = filter.value; }));
    pass.constant = false;
    passes.push_back(pass);
  }
  passes.push_back({"unjitter_bilinear", [](const RawShot& shot, Workers& w) {
                      Planes planes;
                      for (const RawFrame& frame : shot)
                        planes.colors.push_back(unjitter_bilinear(present_of(frame, w), frame.jitter, w));
                      return planes;
                    }});
  passes.push_back(
      recursive_pass("accumulate unjitter", settings([](Settings& s) { s.recursive.unjitter = Unjitter::bilinear; })));
}

void add_companions(std::vector<Pass>& passes) {
  for (const Word<HistoryFilter>& filter : kHistoryFilters) {
    if (filter.value == HistoryFilter::bspline3 || filter.value == HistoryFilter::bspline5) continue;
    for (const BoxRule rule : {BoxRule::clip, BoxRule::clamp}) {
      Pass pass = recursive_pass(
          "companions " + std::string(filter.word) + (rule == BoxRule::clip ? " clip" : " clamp"),
          settings([&](Settings& s) { s.recursive.history_filter = filter.value, s.rectify.rule = rule; }), true);
      // Values that stand alone do not scale, and each companion has a constant of its own.
      pass.scales = false, pass.constant = false;
      // A companion goes as far as its color went, a ratio of differences: where those are rounding, anything between
      // the ends may come of it.
      if (rule == BoxRule::clamp) pass.mirror_share = 0.01;
      passes.push_back(pass);
    }
  }
}

void add_other(std::vector<Pass>& passes) {
  passes.push_back({"sanitize",
                    [](const RawShot& shot, Workers& w) {
                      Planes planes;
                      for (const RawFrame& frame : shot) planes.colors.push_back(present_of(frame, w).color.clone());
                      return planes;
                    },
                    1});
  passes.push_back({"predict",
                    [](const RawShot& shot, Workers& w) {
                      Planes planes;
                      const Settings s;
                      History h;
                      for (const RawFrame& frame : shot) {
                        const Present present = present_of(frame, w);
                        History said = predict(present, h, s.recursive, s.rectify, w);
                        planes.colors.push_back(std::move(said.color)), planes.numbers.push_back(std::move(said.total));
                        h = accumulate(present, h, s.recursive, s.rectify, {}, 1, {}, w).history;
                      }
                      return planes;
                    },
                    4, true, false});
  for (const double strength : {0.3, 1.0})
    passes.push_back({"sharpen " + std::to_string(strength), [strength](const RawShot& shot, Workers& w) {
                        Planes planes;
                        for (const RawFrame& frame : shot) {
                          const Present present = present_of(frame, w);
                          const Settings s;
                          const History h = accumulate(present, {}, s.recursive, s.rectify, {}, 1, {}, w).history;
                          planes.colors.push_back(sharpen(h.color, h.total, strength, w));
                        }
                        return planes;
                      }});
  for (const Word<MotionBlur>& blur : kMotionBlurs) {
    FallbackParameters p;
    p.motion_blur = blur.value, p.young_frames = 2, p.blur_from = 1, p.blur_to = 3;
    passes.push_back({"fallback " + std::string(blur.word),
                      [p](const RawShot& shot, Workers& w) {
                        Planes planes;
                        History h;
                        const Settings s;
                        for (const RawFrame& frame : shot) {
                          const Present present = present_of(frame, w);
                          h = accumulate(present, h, s.recursive, s.rectify, {}, 1, {}, w).history;
                          planes.colors.push_back(fall_back(present, h, p, w));
                        }
                        return planes;
                      },
                      4});
    // Tiles of 20 pixels are counted from the corner.
    if (blur.value == MotionBlur::neighbors) passes.back().mirror = -1;
  }
}

void add_two_sided(std::vector<Pass>& passes) {
  const auto add = [&](const std::string& name, const auto& set) {
    Settings s;
    s.rectify.clip_discount = true;
    set(s);
    Pass pass{"two-sided " + name, [s](const RawShot& shot, Workers& w) { return both_sides(shot, s, w); }};
    pass.two_sided = s;
    pass.support = s.rectify.window / 2 + 4;
    // A clip that ends within rounding of its start is discounted or not.
    pass.mirror = 1e-4, pass.mirror_share = 0.002;
    passes.push_back(pass);
  };
  for (const Word<HistoryFilter>& filter : kHistoryFilters) {
    if (filter.value == HistoryFilter::bspline3 || filter.value == HistoryFilter::bspline5) continue;
    add("filter " + std::string(filter.word), [&](Settings& s) { s.recursive.history_filter = filter.value; });
  }
  for (const Word<Box>& box : kBoxes) {
    if (box.value == Box::none) continue;
    add("box " + std::string(box.word), [&](Settings& s) { s.rectify.box = box.value; });
  }
  for (const double alpha : {1e-6, 1.0})
    for (const Word<AlphaRule>& rule : kAlphaRules)
      add("alpha " + std::to_string(alpha) + " " + std::string(rule.word),
          [&](Settings& s) { s.recursive.alpha = alpha, s.recursive.alpha_rule = rule.value; });
  add("no box", [](Settings& s) { s.rectify.box = Box::none, s.rectify.clip_discount = false; });
  add("gamma 0", [](Settings& s) { s.rectify.gamma = 0; });
  add("depth and speed", [](Settings& s) {
    s.recursive.disocclusion = Disocclusion::depth;
    s.recursive.reject.depth_slope = 1, s.recursive.reject.acceleration = 6, s.recursive.reject.speed = 5;
  });
}

}  // namespace

std::vector<Pass> resolve_passes() {
  std::vector<Pass> passes;
  add_other(passes);
  add_samples(passes);
  add_boxes(passes);
  add_windows(passes);
  add_histories(passes);
  add_tests_and_weights(passes);
  add_companions(passes);
  add_two_sided(passes);
  return passes;
}

}  // namespace varve::stability
