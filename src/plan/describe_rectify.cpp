#include "plan/describe_rectify.h"

#include "plan/value.h"

namespace varve {
namespace {

std::string kind_of(const RectifyParameters& r) {
  const std::string gamma = "gamma " + number_text(r.gamma);
  switch (r.box) {
    case Box::none:
      return "none";
    case Box::minmax:
      return "least and greatest";
    case Box::rounded:
      return "mean of least and greatest of 3x3 and of the plus of five";
    case Box::dynamic4:
      return "least and greatest of four taps, nearer at speed";
    case Box::variance:
      return "variance, " + gamma;
    case Box::variance_minmax:
      return "variance, " + gamma + ", cut by least and greatest";
    case Box::kdop7:
      return "least and greatest along 7 directions";
    case Box::kdop13:
      return "least and greatest along 13 directions";
    case Box::pca:
      return "least and greatest along the principal axes";
    case Box::ellipsoid:
      return "ellipsoid, " + gamma;
    case Box::hull:
      return "exact convex hull" +
             (r.hull_passes < 64 ? ", at most " + std::to_string(r.hull_passes) + " passes" : std::string());
  }
  return "";
}

std::string anchor_of(BoxAnchor anchor) {
  return anchor == BoxAnchor::present ? "present" : anchor == BoxAnchor::mean ? "mean" : "center of the box";
}

}  // namespace

std::string describe_box(const RectifyParameters& r) {
  const std::string edge = std::to_string(r.window), size = edge + "x" + edge;
  const std::string space = r.space == BoxSpace::ycocg ? "YCoCg" : r.space == BoxSpace::log ? "log RGB" : "RGB";
  std::string how;
  if (r.moments == WindowMoments::separable) how = ", by sliding windows";
  if (r.moments == WindowMoments::gaussian) how = ", weighed by a bell";
  if (r.moments == WindowMoments::pyramid) how = ", from a pyramid that blurs about as wide";
  return kind_of(r) + ", of " + size + " pixels in " + space + how;
}

std::string describe_rule(const RectifyParameters& r) {
  const bool sides =
      r.box != Box::pca && r.box != Box::kdop7 && r.box != Box::kdop13 && r.box != Box::ellipsoid && r.box != Box::hull;
  std::string text;
  switch (r.rule) {
    case BoxRule::clip:
      text = "history is clipped towards the " + anchor_of(r.anchor) + ", which removes what is no longer there";
      break;
    case BoxRule::clamp:
      text = std::string("history is clamped, each component by itself") +
             (r.box == Box::pca ? " along the box's own axes" : "") + "; no anchor is needed";
      break;
    case BoxRule::project:
      text = std::string("history moves to the nearest color of the box") +
             (sides ? ", which for a box with sides along the axes is the same as clamp" : "") +
             "; no anchor is needed";
      break;
    case BoxRule::off:
      text = "history keeps its color; its distance to the nearest color of the box is measured";
      break;
  }
  if (r.clip_discount) text += "; what had to move counts less, by how far against the local noise";
  return text;
}

}  // namespace varve
