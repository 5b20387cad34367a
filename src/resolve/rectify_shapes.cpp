#include "resolve/rectify_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resolve/axis_box.h"
#include "resolve/color_ellipsoid.h"
#include "resolve/k_dop.h"
#include "resolve/pca_box.h"
#include "resolve/shape_rules.h"

namespace varve {
namespace {

constexpr double kFloor = 1e-6;  // of the mean's size: what rounding may do to a flat patch

bool by_variance(Box box) { return box == Box::variance || box == Box::variance_minmax; }
bool by_extremes(Box box) { return box == Box::minmax || box == Box::variance_minmax; }
/// Least and greatest alone need no moments, unless for the noise that a discount is measured by.
bool needs_moments(const RectifyParameters& r) { return r.box != Box::minmax || r.clip_discount; }
/// Boxes of samples at fixed places around the pixel, whatever the window.
bool by_place(Box box) { return box == Box::rounded || box == Box::dynamic4; }

/// The window without one of its samples. What is left may be less than the rounding of what was there: then false.
bool take_out(Moments& m, const glm::dvec4& sample) {
  const Moments all = m;
  m.n = all.n - 1;
  if (m.n < 1) return false;
  for (int k = 0; k < 4; ++k) {
    const double d = sample[k] - all.mean[k];
    m.mean[k] = all.mean[k] - d / m.n;
    m.m2[k] = all.m2[k] - d * d * all.n / m.n;
    if (!(m.m2[k] >= 1e-6 * all.m2[k])) return false;
  }
  return true;
}

bool at_an_extreme(const Extremes& e, const glm::dvec4& sample) {
  for (int k = 0; k < 4; ++k)
    if (double(e.low[k]) == sample[k] || double(e.high[k]) == sample[k]) return true;
  return false;
}

/// One pixel's window: how many samples, their moments and extremes, and the samples themselves where the shape is made
/// of them.
struct Local {
  Moments moments;
  Extremes extremes;
};

class PixelRectifier {
 public:
  PixelRectifier(const AccumulateView& view, const ShapeRules& rules, const WindowContents& contents,
                 ShapeScratch& scratch)
      : v_(view), rules_(rules), r_(rules.rectify), contents_(contents), s_(scratch) {}

  /// History in the space of the box, brought onto the shape; false when no neighbor has a say.
  bool operator()(int x, int y, glm::dvec4& h) {
    if (!look_around(x, y)) return false;
    const glm::dvec3 mean(here_.moments.mean[0], here_.moments.mean[1], here_.moments.mean[2]);
    const double floor = kFloor * color_size(mean);
    const glm::dvec4 whole_mean(mean, here_.moments.mean[3]);
    const Interval alpha = alpha_interval();
    switch (r_.box) {
      case Box::none:
        return false;
      case Box::minmax:
      case Box::rounded:
      case Box::dynamic4:
      case Box::variance:
      case Box::variance_minmax: {
        AxisBox box;
        if (!axis_box(x, y, box)) return false;
        widen(box);
        const glm::dvec4 center = box.low * 0.5 + box.high * 0.5;
        h = bring_onto(box, {box.low.a, box.high.a}, r_.rule, h, target(x, y, box.mean, center), false);
        return true;
      }
      case Box::kdop7:
      case Box::kdop13: {
        const KDop dop = make_k_dop(s_.samples, r_.box == Box::kdop7 ? 7 : 13, floor);
        h = bring_onto(dop, alpha, r_.rule, h, target(x, y, whole_mean, whole_mean), false);
        return true;
      }
      case Box::pca: {
        const PcaBox box = make_pca_box(s_.samples, here_.moments, floor);
        const glm::dvec4 center(box.center(), (alpha.low + alpha.high) * 0.5);
        h = bring_onto(box, alpha, r_.rule, h, target(x, y, whole_mean, center), false);
        return true;
      }
      case Box::ellipsoid: {
        const ColorEllipsoid ellipsoid = make_ellipsoid(s_.samples, here_.moments, r_.gamma, floor);
        h = bring_onto(ellipsoid, alpha, r_.rule, h, target(x, y, whole_mean, whole_mean), false);
        return true;
      }
      case Box::hull: {
        make_hull(s_.samples, s_.hull);
        const bool held = r_.anchor == BoxAnchor::mean || (rules_.present_is_sample && counts_itself(v_, x, y));
        h = bring_onto(CappedHull{s_.hull, r_.hull_passes, here_.extremes}, alpha, r_.rule, h,
                       target(x, y, whole_mean, whole_mean), held);
        return true;
      }
    }
    return false;
  }

  /// Variance of one sample around (x, y): all three components together, and never less than the floor of the box.
  double noise() const {
    const Moments& m = here_.moments;
    const double floor = kFloor * color_size({m.mean[0], m.mean[1], m.mean[2]});
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += m.m2[k] / m.n + floor * floor;
    return sum;
  }

 private:
  /// When passes run out the upper bound counts, and the minmax box where that is tighter: the fewer the passes, the
  /// more the hull is like a box. (The lower bound would drop good history: on a pan one pass of it cost 4 dB.)
  struct CappedHull {
    const Hull& hull;
    int passes;
    const Extremes& extremes;
    double crossing(const glm::dvec3& g, const glm::dvec3& h) const {
      const Hull::Crossing found = hull.crossing(g, h, passes);
      if (found.high - found.low <= 1e-6) return found.low;
      return std::min(found.high, minmax_box(extremes).crossing(g, h));
    }
    glm::dvec3 nearest(const glm::dvec3& h) const { return hull.nearest(h); }
  };

  /// False when no neighbor counts.
  bool look_around(int x, int y) {
    if (r_.moments == WindowMoments::direct || by_place(r_.box)) return look_at_each(x, y);
    if (by_extremes(r_.box)) here_.extremes = contents_.extremes.at(x, y);
    if (!needs_moments(r_))
      here_.moments.n = here_.extremes.low[0] <= here_.extremes.high[0] ? 1 : 0;
    else
      here_.moments = contents_.pyramid.levels.empty() ? contents_.moments.at(x, y)
                                                       : sample_pyramid(contents_.pyramid, s_.pyramid, x);
    if (!(here_.moments.n > 0)) return false;
    if (!v_.leave_present_out || !(v_.weight.origin[y * v_.weight.stride + x] > 0)) return true;
    const glm::dvec4 own = color_at(v_.neighbors, x, y);
    if ((needs_moments(r_) && !take_out(here_.moments, own)) ||
        (by_extremes(r_.box) && at_an_extreme(here_.extremes, own)))
      return look_at_each(x, y);
    return true;
  }

  bool look_at_each(int x, int y) {
    gather_samples(v_, by_place(r_.box) ? 1 : r_.window / 2, x, y, s_.samples);
    here_.moments = moments_of(s_.samples);
    if (r_.box != Box::variance && r_.box != Box::ellipsoid) here_.extremes = extremes_of(s_.samples);
    return here_.moments.n > 0;
  }

  bool axis_box(int x, int y, AxisBox& box) {
    switch (r_.box) {
      case Box::rounded:
        box = rounded_box(v_, x, y, s_.samples);
        return true;
      case Box::dynamic4:
        return dynamic_box(v_, x, y, box);
      case Box::minmax:
        box = minmax_box(here_.extremes);
        return true;
      default:
        box = variance_box(here_.moments, r_.gamma, r_.box == Box::variance_minmax ? &here_.extremes : nullptr);
        return true;
    }
  }

  /// Alpha of shapes that live in three dimensions: like the color, by deviation or by extremes.
  Interval alpha_interval() const {
    const Moments& m = here_.moments;
    const double floor = kFloor * std::abs(m.mean[3]), reach = r_.gamma * std::sqrt(m.m2[3] / m.n);
    if (r_.box == Box::ellipsoid) return {m.mean[3] - reach - floor, m.mean[3] + reach + floor};
    return {double(here_.extremes.low[3]) - floor, double(here_.extremes.high[3]) + floor};
  }

  glm::dvec4 target(int x, int y, const glm::dvec4& mean, const glm::dvec4& center) const {
    switch (r_.anchor) {
      case BoxAnchor::present:
        return to_box_space(rules_.space, color_at(v_.color, x, y));
      case BoxAnchor::mean:
        return mean;
      case BoxAnchor::center:
        return center;
    }
    return mean;
  }

  const AccumulateView& v_;
  const ShapeRules& rules_;
  const RectifyParameters& r_;
  const WindowContents& contents_;
  ShapeScratch& s_;
  Local here_;
};

double relative_distance(const glm::dvec4& before, const glm::dvec4& after) {
  const double scale = std::max(glm::length(glm::dvec3(before)), glm::length(glm::dvec3(after)));
  return scale > 0 ? glm::length(glm::dvec3(after) - glm::dvec3(before)) / scale : 0;
}

/// The weight of a history that had to be moved by d: r/W is its variance, d its bias, r that of one sample.
double discounted(double weight, double distance2, double noise) {
  const double left = weight * noise, lost = weight * distance2;
  // Never nothing: the pixel keeps its history, it only counts for no more than that.
  return std::max(left < std::numeric_limits<double>::min() ? 0.0 : left / (noise + lost), 1e-30);
}

}  // namespace

bool needs_shapes(const RectifyParameters& r) {
  if (r.box == Box::none) return false;
  return !(by_variance(r.box) || by_extremes(r.box)) || r.window > 7 || r.moments != WindowMoments::direct ||
         r.rule == BoxRule::project || r.rule == BoxRule::off || r.anchor == BoxAnchor::center ||
         r.space == BoxSpace::log || r.clip_discount;
}

int band_rows(const ShapeRules& rules, int height) {
  const bool slides = rules.rectify.moments == WindowMoments::separable ||
                      rules.rectify.moments == WindowMoments::gaussian || by_extremes(rules.rectify.box);
  if (rules.rectify.moments == WindowMoments::direct || !slides) return height;
  const int bands = (height + kWindowBandRows - 1) / kWindowBandRows;
  return (height + bands - 1) / bands;  // of equal size
}

void prepare_frame(const AccumulateView& view, const ShapeRules& rules, WindowContents& contents, Workers& workers) {
  if (rules.rectify.moments == WindowMoments::pyramid && by_variance(rules.rectify.box))
    contents.pyramid = make_pyramid(view, rules.rectify.window, workers);
}

void prepare_band(const AccumulateView& view, const ShapeRules& rules, int begin, int end, WindowContents& contents,
                  Workers& workers) {
  const RectifyParameters& r = rules.rectify;
  if (r.moments == WindowMoments::direct || by_place(r.box)) return;
  if (r.moments != WindowMoments::pyramid && needs_moments(r))
    gather_band(view, r.window, slid_widths(r.window, r.moments), begin, end, contents.moments, workers);
  if (by_extremes(r.box)) gather_band(view, r.window, {r.window, 1, 1}, begin, end, contents.extremes, workers);
}

void rectify_shapes(const AccumulateView& v, const ShapeRules& rules, const WindowContents& contents, int y,
                    const RowScratch& row, ShapeScratch& scratch, RowCounts& counts) {
  constexpr double kLimit = std::numeric_limits<float>::max();
  if (!contents.pyramid.levels.empty()) mix_pyramid_row(contents.pyramid, v, y, scratch.pyramid);
  PixelRectifier rectify(v, rules, contents, scratch);
  float* distances = v.out_clip.origin ? v.out_clip.origin + y * v.out_clip.stride : nullptr;
  const double most = (1 - rules.alpha) / rules.alpha;
  for (int x = 0; x < v.width; ++x) {
    if (distances) distances[x] = 0;
    if (!(row.total[x] > 0)) continue;
    float* history = row.history + 4 * x;
    const glm::dvec4 before = color_at({row.history, 0}, x, 0);
    const glm::dvec4 there = to_box_space(rules.space, before);
    glm::dvec4 moved = there;
    if (!rectify(x, y, moved) || moved == there) continue;
    const glm::dvec4 after = glm::clamp(from_box_space(rules.space, moved), -kLimit, kLimit);
    if (distances) distances[x] = float(relative_distance(before, after));
    if (rules.rectify.clip_discount) {
      const glm::dvec3 d = glm::dvec3(moved) - glm::dvec3(there);
      row.total[x] = float(discounted(std::min(double(row.total[x]), most), glm::dot(d, d), rectify.noise()));
    }
    if (rules.rectify.rule == BoxRule::off) continue;
    ++counts.clipped;
    for (int k = 0; k < 4; ++k) history[k] = float(after[k]);
  }
}

}  // namespace varve
