#include "reference/rectify_reference.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "reference/hull_reference.h"
#include "reference/shape_reference.h"

namespace varve::reference {
namespace {

Color color_of(const glm::vec4& c) { return {double(c.r), double(c.g), double(c.b), double(c.a)}; }

double knee_of(const Present& present) {
  std::vector<double> values;
  const Window& w = present.color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      for (int k = 0; k < 3; ++k)
        if (present.valid.at(x, y) > 0 && present.color.at(x, y)[k] != 0)
          values.push_back(std::abs(double(present.color.at(x, y)[k])));
  if (values.empty()) return 1.0 / 64;
  std::sort(values.begin(), values.end());
  return std::exp2(std::floor(std::log2(values[(values.size() - 1) / 2]))) / 64;
}

struct Space {
  BoxSpace kind;
  double knee;

  Color to(const Color& c) const {
    Color out = c;
    if (kind == BoxSpace::ycocg)
      out = {c[0] / 4 + c[1] / 2 + c[2] / 4, c[0] / 2 - c[2] / 2, -c[0] / 4 + c[1] / 2 - c[2] / 4, c[3]};
    if (kind == BoxSpace::log)
      for (std::size_t k = 0; k < 3; ++k) out[k] = (c[k] < 0 ? -1 : 1) * std::log1p(std::abs(c[k]) / knee);
    return out;
  }
  Color back(const Color& c) const {
    Color out = c;
    if (kind == BoxSpace::ycocg) out = {c[0] + c[1] - c[2], c[0] + c[2], c[0] - c[1] - c[2], c[3]};
    if (kind == BoxSpace::log)
      for (std::size_t k = 0; k < 3; ++k) out[k] = (c[k] < 0 ? -1 : 1) * std::expm1(std::abs(c[k])) * knee;
    return out;
  }
};

bool counts(const Present& present, int x, int y) {
  return present.color.window().contains(x, y) && present.valid.at(x, y) > 0;
}

/// How often each offset along one axis is met by the window, or by the three that make a bell.
std::vector<double> axis_weights(const RectifyParameters& p) {
  if (p.moments != WindowMoments::gaussian) return std::vector<double>(std::size_t(p.window), 1.0);
  int first = (p.window + 2) / 3;
  first += first % 2 == 0;
  const int rest = (p.window + 2 - first) / 2;
  std::vector<double> weights(std::size_t(p.window), 0.0);
  for (int a = 0; a < first; ++a)
    for (int b = 0; b < rest; ++b)
      for (int c = 0; c < rest; ++c) weights[std::size_t(a + b + c)] += 1;
  return weights;
}

double pyramid_weight(int level, int corner, int offset_from_corner, int centre) {
  // One axis: how much a pixel counts in the bilinear reading at the centre of another.
  const double size = std::exp2(level);
  const double position = (centre - corner + 0.5) / size - 0.5, node = std::floor(double(offset_from_corner) / size);
  return std::max(0.0, 1 - std::abs(position - node)) / size;
}

std::vector<Sample> dynamic_taps(const Present& present, const Space& space, int x, int y, bool with_centre) {
  const glm::vec2 v = present.motion.empty() ? glm::vec2(0.0f) : present.motion.at(x, y);
  const double speed = std::hypot(double(v.x), double(v.y));
  const double distance = 0.5 + std::min(1.0, 0.5 / speed) / 6;
  std::vector<Sample> taps;
  for (const int sy : {-1, 1})
    for (const int sx : {-1, 1}) {
      Sample tap{{}, 0};
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const double weight =
              std::max(0.0, 1 - std::abs(sx * distance - i)) * std::max(0.0, 1 - std::abs(sy * distance - j));
          if (weight <= 0 || !counts(present, x + i, y + j) || (!with_centre && i == 0 && j == 0)) continue;
          const Color c = space.to(color_of(present.color.at(x + i, y + j)));
          for (std::size_t k = 0; k < 4; ++k) tap.color[k] += weight * c[k];
          tap.weight += weight;
        }
      if (tap.weight <= 0) continue;
      for (double& k : tap.color) k /= tap.weight;
      taps.push_back({tap.color, 1});
    }
  return taps;
}

glm::dvec3 color3(const Color& c) { return {c[0], c[1], c[2]}; }

std::vector<glm::dvec3> points_of(const std::vector<Sample>& samples) {
  std::vector<glm::dvec3> points;
  for (const Sample& c : samples) points.push_back(color3(c.color));
  return points;
}

Color nearest_in_hull(const std::vector<Sample>& samples, const Statistics& s, const Color& h) {
  const double floor = 1e-6 * std::abs(s.mean[3]);
  const glm::dvec3 p = nearest_by_faces(points_of(samples), color3(h));
  return {p.x, p.y, p.z, std::clamp(h[3], s.low[3] - floor, s.high[3] + floor)};
}

Shape hull_shape(const std::vector<Sample>& samples, const Statistics& s) {
  Shape shape;
  shape.mean = shape.center = s.mean;
  shape.nearest = [=](const Color& h) { return nearest_in_hull(samples, s, h); };
  shape.inside = [=](const Color& h) { return nearest_in_hull(samples, s, h) == h; };
  return shape;
}

/// By the faces, since "inside" is no question to be asked of a flat hull two hundred times.
Color clip_to_hull(const std::vector<Sample>& samples, const Statistics& s, const Color& h, const Color& target) {
  const Color g = nearest_in_hull(samples, s, target);
  const glm::dvec3 way = color3(h) - color3(g);
  const double floor = 1e-6 * std::abs(s.mean[3]);
  double t = 1;
  if (glm::length(way) > 0)
    t = std::min(t, exit_by_faces(points_of(samples), color3(g), way, 1e-9 * (size_of(h) + size_of(g))));
  if (h[3] > s.high[3] + floor) t = std::min(t, (s.high[3] + floor - g[3]) / (h[3] - g[3]));
  if (h[3] < s.low[3] - floor) t = std::min(t, (g[3] - s.low[3] + floor) / (g[3] - h[3]));
  Color moved;
  for (std::size_t k = 0; k < 4; ++k) moved[k] = g[k] + t * (h[k] - g[k]);
  return moved;
}

std::optional<Shape> shape_of(const Present& present, const RectifyParameters& p, const Space& space,
                              const std::vector<Sample>& samples, const Statistics& s, int x, int y, bool with_centre) {
  const auto map = [&](const glm::vec4& c) { return space.to(color_of(c)); };
  Color low = s.low, high = s.high, mean = s.mean;
  RectifyParameters plain = p;
  plain.moments = WindowMoments::direct;
  switch (p.box) {
    case Box::none:
      return {};
    case Box::hull:
      return hull_shape(samples, s);
    case Box::kdop7:
    case Box::kdop13:
    case Box::pca:
      return slab_shape(samples, s, p.box);
    case Box::ellipsoid:
      return ellipsoid_shape(samples, s, p.gamma);
    case Box::minmax:
      for (std::size_t k = 0; k < 4; ++k) mean[k] = low[k] / 2 + high[k] / 2;
      return box_shape(low, high, mean);
    case Box::rounded: {
      std::vector<Sample> plus;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          if (std::abs(i) + std::abs(j) < 2 && counts(present, x + i, y + j) && (with_centre || i != 0 || j != 0))
            plus.push_back({map(present.color.at(x + i, y + j)), 1});
      if (plus.empty()) return box_shape(low, high, mean);
      const Statistics five = statistics(plus);
      for (std::size_t k = 0; k < 4; ++k) {
        low[k] = low[k] / 2 + five.low[k] / 2;
        high[k] = high[k] / 2 + five.high[k] / 2;
        mean[k] = mean[k] / 2 + five.mean[k] / 2;
      }
      return box_shape(low, high, mean);
    }
    case Box::dynamic4: {
      const std::vector<Sample> taps = dynamic_taps(present, space, x, y, with_centre);
      if (taps.empty()) return {};
      const Statistics four = statistics(taps);
      return box_shape(four.low, four.high, four.mean);
    }
    case Box::variance:
    case Box::variance_minmax: {
      const Statistics window = statistics(weighed_samples(present, plain, map, x, y, with_centre));
      for (std::size_t k = 0; k < 4; ++k) {
        low[k] = mean[k] - p.gamma * s.deviation[k];
        high[k] = mean[k] + p.gamma * s.deviation[k];
        if (p.box == Box::variance) continue;
        low[k] = std::max(low[k], window.low[k]);
        high[k] = std::min(high[k], window.high[k]);
      }
      return box_shape(low, high, mean);
    }
  }
  return {};
}

double length3(const Color& c) { return std::hypot(c[0], c[1], c[2]); }
Color minus(const Color& a, const Color& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}; }

}  // namespace

std::vector<Sample> weighed_samples(const Present& present, const RectifyParameters& p,
                                    const std::function<Color(const glm::vec4&)>& map, int x, int y, bool with_centre) {
  std::vector<Sample> samples;
  const Window& w = present.color.window();
  const std::vector<double> axis = axis_weights(p);
  const double wanted = (double(p.window) * p.window - 1) / 3;
  int level = 0;
  while (std::exp2(2 * (level + 1)) <= wanted) ++level;
  const double upper = (wanted - std::exp2(2 * level)) / (3 * std::exp2(2 * level));
  for (int j = w.y0; j < w.y1; ++j)
    for (int i = w.x0; i < w.x1; ++i) {
      if (!counts(present, i, j) || (!with_centre && i == x && j == y)) continue;
      double weight = 0;
      if (p.moments == WindowMoments::pyramid) {
        for (const int l : {level, level + 1})
          weight += (l == level ? 1 - upper : upper) * pyramid_weight(l, w.x0, i - w.x0, x) *
                    pyramid_weight(l, w.y0, j - w.y0, y);
      } else if (std::abs(i - x) <= p.window / 2 && std::abs(j - y) <= p.window / 2) {
        weight = axis[std::size_t(i - x + p.window / 2)] * axis[std::size_t(j - y + p.window / 2)];
      }
      if (weight > 0) samples.push_back({map(present.color.at(i, j)), weight});
    }
  return samples;
}

std::optional<Rectified> rectify(const Present& present, const RectifyParameters& p, const Color& h, const Color& now,
                                 int x, int y, bool with_centre) {
  const Space space{p.space, p.space == BoxSpace::log ? knee_of(present) : 1};
  const auto map = [&](const glm::vec4& c) { return space.to(color_of(c)); };
  const std::vector<Sample> samples = weighed_samples(present, p, map, x, y, with_centre);
  if (samples.empty()) return {};
  const Statistics s = statistics(samples);
  const std::optional<Shape> shape = shape_of(present, p, space, samples, s, x, y, with_centre);
  if (!shape) return {};
  const double floor = 1e-6 * size_of(s.mean);
  Rectified out{h, 0, 0, s.noise + 3 * floor * floor};
  const Color there = space.to(h);
  if (shape->inside(there)) return out;
  Color moved;
  if (p.rule == BoxRule::clip && p.box == Box::hull) {
    moved = clip_to_hull(samples, s, there, p.anchor == BoxAnchor::present ? space.to(now) : s.mean);
  } else if (p.rule == BoxRule::clip) {
    Color g = p.anchor == BoxAnchor::present ? space.to(now)
              : p.anchor == BoxAnchor::mean  ? shape->mean
                                             : shape->center;
    if (!shape->inside(g)) {
      g = shape->nearest(g);  // on the surface; a hair within, so that rounding does not ask "outside"
      for (std::size_t k = 0; k < 4; ++k) g[k] = shape->mean[k] + (1 - 1e-9) * (g[k] - shape->mean[k]);
    }
    double low = 0, high = 1;  // the largest part of the way that stays inside
    for (int step = 0; step < 200; ++step) {
      const double t = (low + high) / 2;
      for (std::size_t k = 0; k < 4; ++k) moved[k] = g[k] + t * (there[k] - g[k]);
      (shape->inside(moved) ? low : high) = t;
    }
    for (std::size_t k = 0; k < 4; ++k) moved[k] = g[k] + low * (there[k] - g[k]);
  } else {
    moved = shape->nearest(there);
  }
  const Color after = space.back(moved);
  const double scale = std::max(length3(h), length3(after));
  out.clip = scale > 0 ? length3(minus(after, h)) / scale : 0;
  out.distance = length3(minus(moved, there));
  if (p.rule != BoxRule::off) out.color = after;
  return out;
}

}  // namespace varve::reference
