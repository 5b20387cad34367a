#include "plan/knob.h"

#include <array>

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
    {"rounded", Box::rounded, "mean of the minmax boxes of 3x3 and of the plus of five"},
    {"dynamic4", Box::dynamic4, "minmax of four taps, 2/3 pixel away at rest and 1/2 at speed"},
    {"variance", Box::variance, "mean plus and minus --gamma standard deviations"},
    {"variance-minmax", Box::variance_minmax, "the variance box cut by the minmax box"},
    {"kdop7", Box::kdop7, "minmax along 7 directions: the axes and the diagonals of the color cube"},
    {"kdop13", Box::kdop13, "minmax along 13 directions: also the diagonals of its faces"},
    {"pca", Box::pca, "minmax along the neighbors' own principal axes"},
    {"ellipsoid", Box::ellipsoid, "within --gamma standard deviations of the mean in every direction"},
    {"hull", Box::hull, "the exact convex hull of the neighbors"},
};
constexpr Word<WindowMoments> kMoments[] = {
    {"direct", WindowMoments::direct, "every neighbor is looked at: cost grows with the window's area"},
    {"separable", WindowMoments::separable, "the same box, at a cost that does not grow with the window"},
    {"gaussian", WindowMoments::gaussian, "neighbors weigh less towards the edge, by a bell; cost does not grow"},
    {"pyramid", WindowMoments::pyramid,
     "halved pictures, read between two levels: soft, approximate; cost does not grow"},
};
constexpr Word<BoxRule> kBoxRules[] = {
    {"clip", BoxRule::clip, "along the line to the anchor; keeps the hue of the anchor's side"},
    {"clamp", BoxRule::clamp, "each component by itself"},
    {"project", BoxRule::project, "to the nearest color of the box, in the space of the box"},
    {"off", BoxRule::off, "history keeps its color; only the clip distance is measured (and discounts)"},
};
constexpr Word<BoxAnchor> kBoxAnchors[] = {
    {"present", BoxAnchor::present, "towards the present pixel, held inside the box"},
    {"mean", BoxAnchor::mean, "towards the mean of the neighbors"},
    {"center", BoxAnchor::center, "towards the center of the box"},
};
constexpr Word<BoxSpace> kBoxSpaces[] = {
    {"rgb", BoxSpace::rgb, "red, green, blue"},
    {"ycocg", BoxSpace::ycocg, "luma and two chroma axes: a tighter box around natural colors"},
    {"log", BoxSpace::log,
     "logarithm of red, green, blue; linear around zero, from six stops below the frame's median"},
};
constexpr Word<bool> kDiscounts[] = {
    {"on", true, "history that had to be moved weighs less, by how far against the local noise"},
    {"off", false, "clipped or not, history keeps its weight"},
};

template <class At, class T, std::size_t N>
Value<Parameters> word(At at, const Word<T> (&words)[N]) {
  return word_value<Parameters>(at, std::span<const Word<T>>(words));
}

template <class At>
Value<Parameters> number(At at, Range range) {
  return number_value<Parameters>(at, range);
}

/// A window has a middle.
template <class At>
Value<Parameters> odd_number(At at, Range range) {
  Value<Parameters> value = number_value<Parameters>(at, range);
  value.allowed = "an odd" + value.allowed.substr(1);  // "a whole number from ..."
  value.read = [read = value.read](Parameters& parameters, std::string_view text) {
    return !text.empty() && (text.back() - '0') % 2 == 1 && read(parameters, text);
  };
  return value;
}

}  // namespace

std::vector<Knob> knobs() {
  constexpr auto basic = Tier::basic, advanced = Tier::advanced, expert = Tier::expert;
  constexpr std::string_view motion = "Motion and depth", history = "History", rectify = "Rectification";
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
      {"history-filter", "WORD", history, advanced, "Filter that reads history between pixels.",
       word(
           [](auto& p) -> auto& { return p.recursive.history_filter; }, kHistoryFilters)},
      {"dering", "WORD", history, expert,
       "Whether what the Catmull-Rom filters read is held between the four nearest pixels.",
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

      {"box", "WORD", rectify, advanced, "The colors that history may have, made from the neighbors of the present.",
       word(
           [](auto& p) -> auto& { return p.rectify.box; }, kBoxes)},
      {"gamma", "SIGMAS", rectify, basic,
       "Half size of the variance box in standard deviations. Near 0 history is pulled to the mean of the neighbors: "
       "no ghosts, no steadiness. Large values let history through: steady, but ghosts stay.",
       number([](auto& p) -> auto& { return p.rectify.gamma; }, {0, 100})},
      {"window", "PIXELS", rectify, advanced,
       "Edge of the neighborhood that the box is made from: 3 has the fewest ghosts, large windows the least noise.",
       odd_number([](auto& p) -> auto& { return p.rectify.window; }, {3, 63})},
      {"moments", "WORD", rectify, advanced,
       "How mean and deviation of the window are found, and least and greatest in windows beyond 3x3.",
       word(
           [](auto& p) -> auto& { return p.rectify.moments; }, kMoments)},
      {"rule", "WORD", rectify, advanced, "How history outside the box is brought onto it.",
       word(
           [](auto& p) -> auto& { return p.rectify.rule; }, kBoxRules)},
      {"anchor", "WORD", rectify, expert, "Where the line of --rule clip leads.",
       word(
           [](auto& p) -> auto& { return p.rectify.anchor; }, kBoxAnchors)},
      {"space", "WORD", rectify, expert, "Color space of the box.",
       word(
           [](auto& p) -> auto& { return p.rectify.space; }, kBoxSpaces)},
      {"hull-passes", "NUMBER", rectify, expert,
       "Refinements that --box hull may take under --rule clip, for speed. The exact answer needs 4 on average, 6 "
       "nearly "
       "always; with fewer more colors pass, down to 1, which is little more than the minmax box.",
       number([](auto& p) -> auto& { return p.rectify.hull_passes; }, {1, 64})},
      {"clip-discount", "WORD", rectify, advanced, "Whether a clipped history loses weight to the present.",
       word(
           [](auto& p) -> auto& { return p.rectify.clip_discount; }, kDiscounts)},
  };
}

}  // namespace varve
