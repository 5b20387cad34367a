#include "plan/knob.h"

#include <array>

#include "base/error.h"
#include "plan/expansive.h"

namespace varve {
namespace {

constexpr Word<Dilation> kDilations[] = {
    {"none", Dilation::none, "the pixel's own vector"},
    {"nearest", Dilation::nearest, "the vector of the nearest depth among the 3x3 neighbors; needs depth"},
    {"longest", Dilation::longest, "the longest vector among the 3x3 neighbors"},
};
constexpr Word<DepthKind> kDepthKinds[] = {
    {"distance", DepthKind::distance, "larger is farther"},
    {"inverse", DepthKind::inverse, "one over the distance, larger is nearer"},
    {"negative", DepthKind::negative, "minus the distance, as along a camera's -Z"},
};
constexpr Word<AlphaRule> kAlphaRules[] = {
    {"fixed", AlphaRule::fixed, "always --alpha"},
    {"mean", AlphaRule::mean, "the plain mean of the n frames seen so far until 1/n falls to --alpha"},
};
constexpr Word<HistoryFilter> kHistoryFilters[] = {
    {"bilinear", HistoryFilter::bilinear, "4 taps; soft, blurs a little more with every frame in motion"},
    {"catmull-rom", HistoryFilter::catmull_rom, "16 taps; sharp"},
    {"catmull-rom9", HistoryFilter::catmull_rom9, "9 bilinear taps with the result of 16"},
    {"catmull-rom5", HistoryFilter::catmull_rom5, "5 bilinear taps without the corners, renormalized"},
    {"cubic", HistoryFilter::cubic, "16 taps of Mitchell and Netravali with --cubic-b and --cubic-c"},
    {"bspline3", HistoryFilter::bspline3, "cubic B-spline through every pixel; sharper than Catmull-Rom, slower"},
    {"bspline5", HistoryFilter::bspline5, "quintic B-spline through every pixel; sharpest, slowest"},
};
constexpr Word<Unjitter> kUnjitters[] = {
    {"none", Unjitter::none, "the sample stands for its pixel, wherever it lies"},
    {"bilinear", Unjitter::bilinear, "read between the samples; no wobble, softer"},
};
constexpr Word<bool> kSwitches[] = {
    {"on", true, "no overshoot beside bright edges"},
    {"off", false, "the filter as it is"},
};
constexpr Word<Disocclusion> kDisocclusions[] = {
    {"window", Disocclusion::window, "only where the previous position lies outside the data window"},
    {"depth", Disocclusion::depth, "also where another surface lay there; needs depth"},
};
constexpr Word<SampleFilter> kSampleFilters[] = {
    {"none", SampleFilter::none, "every sample of a pixel counts the same"},
    {"tent", SampleFilter::tent, "falls linearly to zero at one pixel"},
    {"gaussian", SampleFilter::gaussian, "Gaussian"},
    {"blackman-harris", SampleFilter::blackman_harris, "narrow with very low side lobes, the usual film filter"},
    {"mitchell", SampleFilter::mitchell, "Mitchell-Netravali, with negative lobes"},
};
constexpr Word<Box> kBoxes[] = {
    {"none", Box::none, "history is used as it is"},
    {"minmax", Box::minmax, "least and greatest of the neighbors"},
    {"variance", Box::variance, "mean plus and minus --gamma standard deviations"},
    {"variance-minmax", Box::variance_minmax, "the variance box cut by the minmax box"},
};
constexpr Word<int> kWindows[] = {
    {"3", 3, "3x3 pixels: least ghosting"},
    {"5", 5, "5x5 pixels"},
    {"7", 7, "7x7 pixels: least noise"},
};
constexpr Word<BoxRule> kBoxRules[] = {
    {"clip", BoxRule::clip, "along the line to the anchor; keeps the hue of the anchor's side"},
    {"clamp", BoxRule::clamp, "each component by itself"},
};
constexpr Word<BoxAnchor> kBoxAnchors[] = {
    {"present", BoxAnchor::present, "towards the present pixel, held inside the box"},
    {"mean", BoxAnchor::mean, "towards the mean of the neighbors"},
};
constexpr Word<BoxSpace> kBoxSpaces[] = {
    {"rgb", BoxSpace::rgb, "red, green, blue"},
    {"ycocg", BoxSpace::ycocg, "luma and two chroma axes: a tighter box around natural colors"},
};

template <class At, class T, std::size_t N>
Value<Parameters> word(At at, const Word<T> (&words)[N]) {
  return word_value<Parameters>(at, std::span<const Word<T>>(words));
}

/// The words of history filters, and those that are filters but cannot be used, which say why.
Value<Parameters> history_filter() {
  Value<Parameters> value = word(
      [](auto& p) -> auto& { return p.recursive.history_filter; }, kHistoryFilters);
  value.read = [read = value.read](Parameters& parameters, std::string_view text) {
    if (text == "lanczos3" || text == "lanczos4")
      throw Failure(ExitCode::usage, expansive_filter_text(text, lanczos_gain(text == "lanczos3" ? 3 : 4)));
    return read(parameters, text);
  };
  return value;
}

template <class At>
Value<Parameters> number(At at, Range range) {
  return number_value<Parameters>(at, range);
}

}  // namespace

std::vector<Knob> knobs() {
  constexpr auto basic = Tier::basic, advanced = Tier::advanced, expert = Tier::expert;
  constexpr std::string_view motion = "Motion and depth", history = "History", rectify = "Rectification",
                             finish = "Finishing";
  return {
      {"dilation", "WORD", motion, advanced, "Whose vector a pixel follows.",
       word(
           [](auto& p) -> auto& { return p.motion.dilation; }, kDilations)},
      {"max-motion", "PIXELS", motion, expert,
       "Vectors longer than this many pixels count as unusable and restart their pixel.",
       number([](auto& p) -> auto& { return p.motion.max_length; }, {0, 1e6, true})},
      {"depth-kind", "WORD", motion, advanced, "What the numbers of the depth channel mean.",
       word(
           [](auto& p) -> auto& { return p.motion.depth_kind; }, kDepthKinds)},

      {"alpha", "WEIGHT", history, basic,
       "Weight of the present frame, the rest is history. Near 0 history decides: steady, slow to follow changes of "
       "light. 1 leaves the present as it is.",
       number([](auto& p) -> auto& { return p.recursive.alpha; }, {0, 1, true})},
      {"alpha-rule", "WORD", history, advanced, "How the weight of the present goes with the number of frames seen.",
       word(
           [](auto& p) -> auto& { return p.recursive.alpha_rule; }, kAlphaRules)},
      {"history-filter", "WORD", history, advanced,
       "Filter that reads history between pixels. History is read again every frame, so filters that amplify any wave "
       "(lanczos3, lanczos4, sharp cubics) are refused.",
       history_filter()},
      {"cubic-b", "B", history, expert,
       "B of --history-filter cubic. 0 meets the pixels; 1 is the cubic B-spline, which also blurs what stands still.",
       number([](auto& p) -> auto& { return p.recursive.cubic_b; }, {0, 1})},
      {"cubic-c", "C", history, expert,
       "C of --history-filter cubic. 0 is softest, 0.5 with a B of 0 is Catmull-Rom; more is sharper and refused where "
       "it amplifies.",
       number([](auto& p) -> auto& { return p.recursive.cubic_c; }, {0, 1})},
      {"dering", "WORD", history, expert,
       "Whether what a filter with negative weights reads is held between the nearest pixels.",
       word(
           [](auto& p) -> auto& { return p.recursive.dering; }, kSwitches)},
      {"disocclusion", "WORD", history, advanced, "Where history is dropped because the surface was not seen before.",
       word(
           [](auto& p) -> auto& { return p.recursive.disocclusion; }, kDisocclusions)},
      {"depth-tolerance", "RATIO", history, expert,
       "Depth difference, relative to the distance, that still is the same surface under --disocclusion depth. 0 asks "
       "for equal depths, 1 accepts nearly everything.",
       number([](auto& p) -> auto& { return p.recursive.depth_tolerance; }, {0, 1})},
      {"sample-filter", "WORD", history, advanced,
       "Weights each sample by its true position in the pixel; needs the jitter of the frames.",
       word(
           [](auto& p) -> auto& { return p.recursive.sample_filter; }, kSampleFilters)},

      {"unjitter", "WORD", history, advanced,
       "Whether the present is brought to the pixel centers before it is blended in; needs the jitter of the frames.",
       word(
           [](auto& p) -> auto& { return p.recursive.unjitter; }, kUnjitters)},

      {"box", "WORD", rectify, advanced, "The colors that history may have, made from the neighbors of the present.",
       word(
           [](auto& p) -> auto& { return p.rectify.box; }, kBoxes)},
      {"gamma", "SIGMAS", rectify, basic,
       "Half size of the variance box in standard deviations. Near 0 history is pulled to the mean of the neighbors: "
       "no ghosts, no steadiness. Large values let history through: steady, but ghosts stay.",
       number([](auto& p) -> auto& { return p.rectify.gamma; }, {0, 100})},
      {"window", "PIXELS", rectify, advanced, "Edge of the neighborhood that the box is made from.",
       word(
           [](auto& p) -> auto& { return p.rectify.window; }, kWindows)},
      {"rule", "WORD", rectify, advanced, "How history outside the box is brought onto it.",
       word(
           [](auto& p) -> auto& { return p.rectify.rule; }, kBoxRules)},
      {"anchor", "WORD", rectify, expert, "Where the line of --rule clip leads.",
       word(
           [](auto& p) -> auto& { return p.rectify.anchor; }, kBoxAnchors)},
      {"space", "WORD", rectify, expert, "Color space of the box.",
       word(
           [](auto& p) -> auto& { return p.rectify.space; }, kBoxSpaces)},

      {"sharpen", "STRENGTH", finish, advanced,
       "Sharpens what is written, never the history: 0 not at all, 1 most. Flat areas gain most, edges least, and no "
       "color leaves the range of its 3x3 neighbors.",
       number([](auto& p) -> auto& { return p.finish.sharpen; }, {0, 1})},
  };
}

}  // namespace varve
