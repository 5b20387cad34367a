#include "plan/knob.h"

#include <array>

#include "base/error.h"
#include "plan/expansive.h"
#include "plan/knob_words.h"

namespace varve {
namespace {

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
  constexpr std::string_view motion = "Motion and depth", history = "History", rectify = "Rectification",
                             around = "Gather (--accumulator gather)",
                             quarters = "Sub-pixel histories (--accumulator subpixel)",
                             sides = "Past and future (--accumulator two-sided)", reject = "Rejection",
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
      {"camera-motion", "WORD", motion, advanced, "Which motion is taken from the cameras, where --camera finds them.",
       word(
           [](auto& p) -> auto& { return p.motion.camera; }, kCameraUses)},

      {"repair-motion", "WORD", motion, basic, "What is done about vectors that are wrong.",
       word(
           [](auto& p) -> auto& { return p.repair.mode; }, kRepairs)},
      {"repair-limit", "FACTOR", motion, expert,
       "Misfit of an 8x8 block that makes its vectors suspicious, as a multiple of the misfit of the frame's good "
       "vectors. Small values suspect noise, large ones overlook slow things.",
       number([](auto& p) -> auto& { return p.repair.misfit_limit; }, {1, 1000})},
      {"repair-share", "SHARE", motion, expert,
       "Share of the testable pixels of an object that must be suspicious before its vectors are replaced. Shadows and "
       "highlights that slide over an object touch a small part of it.",
       number([](auto& p) -> auto& { return p.repair.share; }, {0, 1})},
      {"repair-gain", "SHARE", motion, expert,
       "Share of the misfit that may remain with the motion found instead. 1 replaces at the least advantage, 0 never.",
       number([](auto& p) -> auto& { return p.repair.gain; }, {0, 1})},
      {"repair-reach", "PIXELS", motion, expert,
       "Farthest motion that is searched for; a thing with an id of its own is found at any distance.",
       number([](auto& p) -> auto& { return p.repair.reach; }, {8, 1024})},

      {"accumulator", "WORD", history, basic, "How frames are combined.",
       word(
           [](auto& p) -> auto& { return p.accumulator; }, kAccumulators)},
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

      {"blur-limit", "PX2", history, advanced,
       "Variance of the blur that reading history between pixels may build up, in square pixels; the present weighs "
       "more "
       "where it would be more. A box of one pixel has 0.083. Small values alias, large ones blur; 0 sets no limit. Of "
       "the accumulators recursive and subpixel.",
       number([](auto& p) -> auto& { return p.recursive.blur_limit; }, {0, 1000})},
      {"residual-limit", "RATIO", history, advanced,
       "Relative difference to the present that may stay in history where the light changes; the present weighs more "
       "where it would be more. Small values alias, large ones lag; 0 sets no limit.",
       number([](auto& p) -> auto& { return p.recursive.residual_limit; }, {0, 2})},
      {"residual-window", "PIXELS", history, expert,
       "Edge of the window over which that difference is averaged, with its sign: 3, or 7 for noisy frames.",
       odd_number([](auto& p) -> auto& { return p.recursive.residual_window; }, {3, 15})},

      {"subpixel-radius", "PIXELS", quarters, expert,
       "Half width of the tent through which the samples of the four histories are seen. Small ones are sharper; where "
       "one does not hold enough samples it is widened.",
       number([](auto& p) -> auto& { return p.subpixel.radius; }, {0.5, 1})},
      {"subpixel-weights", "WORD", quarters, advanced, "How those samples are weighed.",
       word(
           [](auto& p) -> auto& { return p.subpixel.weights; }, kSubpixelWeights)},
      {"blur-bound", "WORD", quarters, expert, "What --blur-limit goes by.",
       word(
           [](auto& p) -> auto& { return p.subpixel.bound; }, kBlurBounds)},
      {"scale", "FACTOR", quarters, advanced,
       "Size of the picture: 1 writes the mean of the four quarters of a pixel, 2 each quarter as a pixel of its own. "
       "Then channels that are not resolved, and planes of --aov, are repeated 2x2, and vectors that count pixels are "
       "doubled with them; pictures of --preview stay at the size of the frames. Of --accumulator subpixel only.",
       number([](auto& p) -> auto& { return p.subpixel.scale; }, {1, 2})},
      {"look-ahead", "FRAMES", sides, advanced,
       "Frames that are looked at, at least, before and after each one; also the length of the blocks they are worked "
       "in. "
       "0 takes as many as hold 99 % of the weight: 44 at --alpha 0.1.",
       number([](auto& p) -> auto& { return p.two_sided.look_ahead; }, {0, 10000})},
      {"return-tolerance", "PIXELS", sides, expert,
       "How far a vector and the vector that leads back may miss each other, besides a hundredth of their lengths; "
       "beyond that the surface is hidden there, and the pixel follows a neighbor or restarts. 0: no test. Needs "
       "vectors "
       "in both directions.",
       number([](auto& p) -> auto& { return p.two_sided.return_tolerance; }, {0, 1000})},

      {"reach", "FRAMES", around, basic,
       "Frames on each side of the resolved one that take part. More frames, less noise and aliasing; cost grows with "
       "them.",
       number([](auto& p) -> auto& { return p.gather.reach; }, {0, kMostReach})},
      {"cells", "COUNT", around, advanced,
       "Cells on a pixel's edge. Each cell has the same say in the pixel, however many samples fall into it.",
       number([](auto& p) -> auto& { return p.gather.cells; }, {1, 8})},
      {"sigma", "PIXELS", around, expert,
       "Width of the Gaussian by which a cell weighs the samples around it. Near 0 only the nearest counts; wide ones "
       "blur. It is widened where there are few frames.",
       number([](auto& p) -> auto& { return p.gather.sigma; }, {0.01, 2})},
      {"change-limit", "SIGMAS", around, expert,
       "Standard errors by which the light of frames further off may differ in a pixel before they count less, as "
       "under "
       "a highlight that slides by. 0: no test. Small values shrink the window everywhere.",
       number([](auto& p) -> auto& { return p.gather.change_limit; }, {0, 1000})},
      {"firefly-limit", "SIGMAS", around, advanced,
       "Deviations from the median of a pixel's samples beyond which a brighter one is held back. 0 holds back none; "
       "small values, such as 6, take energy away, which the plane removed shows.",
       number([](auto& p) -> auto& { return p.gather.firefly_limit; }, {0, 1e6})},
      {"gain", "WORD", around, advanced, "What is done about light that changes.",
       word(
           [](auto& p) -> auto& { return p.gather.gain; }, kGains)},
      {"gain-window", "PIXELS", around, expert, "Edge of the window, odd, in which light is measured.",
       number([](auto& p) -> auto& { return p.gather.gain_window; }, {1, 127})},
      {"gain-dead-zone", "RATIO", around, expert,
       "Relative change of light that counts as noise. 0 follows every change, noise too.",
       number([](auto& p) -> auto& { return p.gather.gain_dead_zone; }, {0, 10})},
      {"gain-weight", "RATIO", around, expert,
       "Relative change of light at which a frame counts half. Small values leave out frames of other light, large "
       "ones trust the gain.",
       number([](auto& p) -> auto& { return p.gather.gain_weight; }, {0, 1000, true})},

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
      {"clip-discount", "WORD", rectify, advanced,
       "Whether history loses weight where rectification moved it; with --accumulator two-sided past and future each.",
       word(
           [](auto& p) -> auto& { return p.rectify.clip_discount; }, kDiscounts)},

      {"depth-slope", "FACTOR", reject, expert,
       "Depth difference allowed under --disocclusion depth besides --depth-tolerance, as a multiple of how much the "
       "depth of the present changes over a pixel: slanted floors stay whole. 0 allows none, 10 is SVGF's.",
       number([](auto& p) -> auto& { return p.recursive.reject.depth_slope; }, {0, 1000})},
      {"normal-angle", "DEGREES", reject, advanced,
       "Drop history of a surface turned by more than this; needs a normal. 0 does not test.",
       number([](auto& p) -> auto& { return p.recursive.reject.normal_angle; }, {0, 180})},
      {"id-test", "WORD", reject, advanced,
       "Drop history of another object; needs an id. A stencil is an id: --map id=CHANNEL.",
       word(
           [](auto& p) -> auto& { return p.recursive.reject.id; }, kIdTests)},
      {"speed-difference", "PIXELS", reject, expert,
       "Drop history whose vector was longer or shorter by more than this. Opposite vectors look the same to it. 0 "
       "does "
       "not test.",
       number([](auto& p) -> auto& { return p.recursive.reject.speed; }, {0, 16384})},
      {"direction-angle", "DEGREES", reject, expert,
       "Drop history whose vector led elsewhere by more than this; vectors below half a pixel have no direction. 0 "
       "does "
       "not test.",
       number([](auto& p) -> auto& { return p.recursive.reject.direction; }, {0, 180})},
      {"acceleration", "PIXELS", reject, advanced,
       "Drop history whose vector differs by this much, as that of another surface does. Blind where an occluder "
       "leaves "
       "what rests. 0 does not test.",
       number([](auto& p) -> auto& { return p.recursive.reject.acceleration; }, {0, 16384})},
      {"acceleration-low", "PIXELS", reject, expert,
       "Difference where the doubt of --acceleration begins, which grows linearly from there.",
       number([](auto& p) -> auto& { return p.recursive.reject.acceleration_low; }, {0, 16384})},
      {"on-reject", "WORD", reject, advanced, "What is done where a test rejects history.",
       word(
           [](auto& p) -> auto& { return p.recursive.reject.on_reject; }, kOnRejects)},
      {"reject-alpha", "WEIGHT", reject, expert, "Weight of the present under --on-reject weight.",
       number([](auto& p) -> auto& { return p.recursive.reject.alpha; }, {0, 1, true})},
      {"reactive", "STRENGTH", reject, advanced,
       "How much of history the mask mapped with --map reactive=CHANNEL takes away where it is 1. 0 ignores the mask. "
       "A mask mapped with --map responsive=CHANNEL is a factor on the weight of the present.",
       number([](auto& p) -> auto& { return p.recursive.weight.reactive; }, {0, 1})},
      {"speed-alpha", "WEIGHT", reject, expert,
       "Weight of the present at --full-speed and beyond, where it is above --alpha. 0: speed does not matter.",
       number([](auto& p) -> auto& { return p.recursive.weight.speed_alpha; }, {0, 1})},
      {"full-speed", "PIXELS", reject, expert, "Length of the vector at which --speed-alpha is reached, linearly.",
       number([](auto& p) -> auto& { return p.recursive.weight.full_speed; }, {0, 16384, true})},
      {"feedback", "WORD", reject, advanced, "What the weight of history goes by.",
       word(
           [](auto& p) -> auto& { return p.recursive.weight.feedback; }, kFeedbacks)},
      {"feedback-low", "WEIGHT", reject, expert, "Weight of history under --feedback luma where luma disagrees.",
       number([](auto& p) -> auto& { return p.recursive.weight.feedback_low; }, {0, 1})},
      {"feedback-high", "WEIGHT", reject, expert, "Weight of history under --feedback luma where luma agrees.",
       number([](auto& p) -> auto& { return p.recursive.weight.feedback_high; }, {0, 1})},
      {"anti-flicker", "STRENGTH", reject, expert,
       "Attenuate the weight of the present where history is near the wall of the box, before it is clipped. 1 is the "
       "published form, which freezes a pixel at the wall; 0 does not attenuate.",
       number([](auto& p) -> auto& { return p.recursive.weight.anti_flicker; }, {0, 1})},
      {"weighing", "WORD", reject, expert,
       "What is averaged. All but none darken bright detail and depend on the exposure.",
       word(
           [](auto& p) -> auto& { return p.recursive.weight.weighing; }, kWeighings)},
      {"exposure", "STOPS", reject, expert, "Exposure at which --weighing takes its 1 as white.",
       number([](auto& p) -> auto& { return p.recursive.weight.exposure; }, {-100, 100})},
      {"motion-blur", "WORD", reject, advanced,
       "What is written of what moves fast; history does not see it. A look for displays, no step towards the truth.",
       word(
           [](auto& p) -> auto& { return p.fallback.motion_blur; }, kMotionBlurs)},
      {"motion-blur-from", "PIXELS", reject, expert, "Speed at which --motion-blur sets in.",
       number([](auto& p) -> auto& { return p.fallback.blur_from; }, {0, 16384})},
      {"motion-blur-to", "PIXELS", reject, expert, "Speed from which on nothing else is seen.",
       number([](auto& p) -> auto& { return p.fallback.blur_to; }, {0, 16384, true})},
      {"blur-young", "FRAMES", reject, advanced,
       "Write pixels whose history is younger than this slightly blurred, less with each frame: calms the first frames "
       "after a cut and what was just uncovered. History does not see it. 0 writes them as they are.",
       number([](auto& p) -> auto& { return p.fallback.young_frames; }, {0, 1000})},
      {"young-filter", "WORD", reject, expert, "What --blur-young writes.",
       word(
           [](auto& p) -> auto& { return p.fallback.young_filter; }, kYoungFilters)},

      {"sharpen", "STRENGTH", finish, advanced,
       "Sharpens what is written, never the history: 0 not at all, 1 most. Flat areas gain most, edges least, and no "
       "color leaves the range of its 3x3 neighbors.",
       number([](auto& p) -> auto& { return p.finish.sharpen; }, {0, 1})},
  };
}

}  // namespace varve
