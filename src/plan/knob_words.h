// The words of the choices, as written on the command line and in presets. Included by the table of knobs only.
#pragma once

#include "plan/parameters.h"
#include "plan/value.h"

namespace varve {

constexpr Word<Accumulator> kAccumulators[] = {
    {"recursive", Accumulator::recursive, "a history that is carried from frame to frame; fast, looks back only"},
    {"two-sided", Accumulator::two_sided, "past and future histories merged, the present counted once"},
    {"gather", Accumulator::gather, "every sample of the frames around, carried here along its own motion, used once"},
    {"subpixel", Accumulator::subpixel,
     "four histories in the quarters of a pixel, one new in each frame; sharper than one, needs the jitter"},
};
constexpr Word<SubpixelWeights> kSubpixelWeights[] = {
    {"plain", SubpixelWeights::plain, "the tent, normalized; narrow ones let the picture drift in motion"},
    {"first-order", SubpixelWeights::first_order, "the tent by moving least squares: no drift"},
    {"second-order", SubpixelWeights::second_order,
     "likewise for parabolas: reading adds no blur variance; sharper, a little more noise"},
    {"bilinear", SubpixelWeights::bilinear, "one bilinear fetch in each history: a tent of one pixel; softer, faster"},
};
constexpr Word<BlurBound> kBlurBounds[] = {
    {"tracked", BlurBound::tracked, "the kernel of every pixel is known, and kept below the limit"},
    {"table", BlurBound::tabulated, "as published: the weight that a steady motion of that speed needs"},
};
constexpr Word<Dilation> kDilations[] = {
    {"none", Dilation::none, "the pixel's own vector"},
    {"nearest", Dilation::nearest, "the vector of the nearest depth among the 3x3 neighbors; needs depth"},
    {"longest", Dilation::longest, "the longest vector among the 3x3 neighbors"},
};
constexpr Word<DepthKind> kDepthKinds[] = {
    {"distance", DepthKind::distance, "larger is farther"},
    {"inverse", DepthKind::inverse, "one over the distance, larger is nearer"},
    {"negative", DepthKind::negative, "minus the distance, as along a camera's -Z"},
    {"ray", DepthKind::ray, "distance from the eye along the ray; made planar where the camera is known"},
};
constexpr Word<CameraUse> kCameraUses[] = {
    {"missing", CameraUse::missing, "only where a layer has depth but no vectors: what rests in the world moves"},
    {"background", CameraUse::background, "also background whose vectors are zero, such as a textured sky"},
    {"zoom", CameraUse::zoom, "also animated zoom and lens shift, where the vectors are found to lack them"},
    {"all", CameraUse::all, "missing, background and zoom"},
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
constexpr Word<RepairMotion> kRepairs[] = {
    {"off", RepairMotion::off, "vectors are believed"},
    {"check", RepairMotion::check, "vectors are tested and what is wrong is told; nothing is changed"},
    {"on", RepairMotion::on, "vectors that the pixels refute for a whole surface are replaced, or dropped"},
};
constexpr Word<Disocclusion> kDisocclusions[] = {
    {"window", Disocclusion::window, "only where the previous position lies outside the data window"},
    {"depth", Disocclusion::depth, "also where another surface lay there; needs depth"},
};
constexpr Word<IdTest> kIdTests[] = {
    {"off", IdTest::off, "ids are not looked at"},
    {"hard", IdTest::hard, "history of another id does not count"},
    {"soft", IdTest::soft, "history counts by the share of its four pixels that have the id: no hard edges"},
};
constexpr Word<OnReject> kOnRejects[] = {
    {"restart", OnReject::restart, "the pixel starts over; in half doubt its history counts half"},
    {"blur", OnReject::blur, "likewise, with a slightly blurred present mixed in by the doubt"},
    {"weight", OnReject::weight, "history stays, to be rectified, and the present counts --reject-alpha"},
};
constexpr Word<Feedback> kFeedbacks[] = {
    {"fixed", Feedback::fixed, "as --alpha says"},
    {"luma", Feedback::luma, "--feedback-high where the luma of history and present agree, --feedback-low where not"},
};
constexpr Word<YoungFilter> kYoungFilters[] = {
    {"blur", YoungFilter::blur, "the 3x3 mean of the present: noise and edges alike"},
    {"morphological", YoungFilter::morphological,
     "stairs along edges become slants, at the pixel centers where the jitter is known; flat areas stay"},
};
constexpr Word<MotionBlur> kMotionBlurs[] = {
    {"off", MotionBlur::off, "the resolve"},
    {"own", MotionBlur::own, "the present blurred along the vector of the pixel"},
    {"neighbors", MotionBlur::neighbors, "likewise along the longest vector of the 20 pixel tiles around"},
};
constexpr Word<Weighing> kWeighings[] = {
    {"none", Weighing::none, "light is averaged as it is: unbiased"},
    {"luminance", Weighing::luminance, "weights 1/(1+luma): calms fireflies, darkens; a 50 % edge of 16 loses 89 %"},
    {"log", Weighing::logarithm, "the mean of logarithms: darkens, brightens slowly"},
};
constexpr Word<SampleFilter> kSampleFilters[] = {
    {"none", SampleFilter::none, "every sample of a pixel counts the same"},
    {"tent", SampleFilter::tent, "falls linearly to zero at one pixel"},
    {"gaussian", SampleFilter::gaussian, "Gaussian"},
    {"blackman-harris", SampleFilter::blackman_harris, "narrow with very low side lobes, the usual film filter"},
    {"mitchell", SampleFilter::mitchell, "Mitchell-Netravali, with negative lobes"},
};
constexpr Word<bool> kGains[] = {
    {"on", true, "samples of other frames follow the light of their surface, and count less where it changed"},
    {"off", false, "samples are taken as they are"},
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

}  // namespace varve
