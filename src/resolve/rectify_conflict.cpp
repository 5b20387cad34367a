// Which choices of the rectification do not go together.
#include "resolve/accumulate.h"

namespace varve {
namespace {

bool of_samples(Box box) {
  return box == Box::kdop7 || box == Box::kdop13 || box == Box::pca || box == Box::ellipsoid || box == Box::hull;
}
bool without_axes(Box box) { return of_samples(box) && box != Box::pca; }
bool without_center(Box box) { return box == Box::kdop7 || box == Box::kdop13 || box == Box::hull; }
bool of_places(Box box) { return box == Box::rounded || box == Box::dynamic4; }

}  // namespace

std::string conflict(const RectifyParameters& r, const RecursiveParameters& recursive, bool weight_by_age) {
  if (r.clip_discount && r.box == Box::none)
    return "a clip discount needs a box to clip history to; choose one with --box, or give --clip-discount off";
  if (r.box == Box::none) return "";
  if (r.window < 3 || r.window > 63 || r.window % 2 == 0)
    return "the window must be odd, from 3 to 63; give --window 3";
  if (r.rule == BoxRule::clamp && without_axes(r.box))
    return "clamping works on each component by itself, and this box has no side for each; give --rule project for the "
           "nearest color, or --rule clip";
  if (r.rule == BoxRule::clip && r.anchor == BoxAnchor::center && without_center(r.box))
    return "a k-DOP or a hull has no center of its own; give --anchor mean, or --anchor present";
  if (of_places(r.box) && r.window != 3)
    return "the rounded box and the four-tap box are made of the 3x3 neighbors; give --window 3, or another --box";
  if (r.moments != WindowMoments::direct && of_places(r.box))
    return "the rounded box and the four-tap box need no window moments; give --moments direct";
  if (r.moments != WindowMoments::direct && of_samples(r.box))
    return "this box is made of the samples themselves, not of window moments; give --moments direct, or --box "
           "variance";
  if (r.box == Box::minmax && (r.moments == WindowMoments::gaussian || r.moments == WindowMoments::pyramid))
    return "least and greatest know no weights; give --moments separable, or --box variance";
  if (r.clip_discount && weight_by_age && recursive.alpha_rule == AlphaRule::fixed)
    return "a clip discount acts through the weight of the history, which --alpha-rule fixed does not look at; give "
           "--alpha-rule mean, or --clip-discount off";
  return "";
}

}  // namespace varve
