#include "reference/rectify_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace varve::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

struct Statistics {
  Color mean{}, deviation{}, low{}, high{};
  double noise = 0;
};

Statistics statistics(const std::vector<Sample>& samples) {
  Statistics s;
  for (std::size_t k = 0; k < 4; ++k) {
    long double sum = 0, weight = 0, m2 = 0;
    s.low[k] = kInfinity, s.high[k] = -kInfinity;
    for (const Sample& c : samples) {
      sum += static_cast<long double>(c.weight) * c.color[k];
      weight += c.weight;
      s.low[k] = std::min(s.low[k], c.color[k]);
      s.high[k] = std::max(s.high[k], c.color[k]);
    }
    const long double mean = sum / weight;
    for (const Sample& c : samples) m2 += c.weight * (c.color[k] - mean) * (c.color[k] - mean);
    s.mean[k] = double(mean);
    s.deviation[k] = double(std::sqrt(m2 / weight));
    if (k < 3) s.noise += double(m2 / weight);
  }
  return s;
}

double size_of(const Color& c) { return std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])}); }

struct Shape {
  std::function<bool(const Color&)> inside;
  std::function<Color(const Color&)> nearest;
  Color mean{}, center{};
};

Shape box_shape(Color low, Color high, const Color& mean) {
  const double floor = 1e-6 * size_of(mean);
  for (std::size_t k = 0; k < 4; ++k) {
    low[k] -= k < 3 ? floor : 1e-6 * std::abs(mean[3]);
    high[k] += k < 3 ? floor : 1e-6 * std::abs(mean[3]);
  }
  Shape s;
  s.mean = mean;
  for (std::size_t k = 0; k < 4; ++k) s.center[k] = low[k] / 2 + high[k] / 2;
  s.inside = [low, high](const Color& c) {
    bool in = true;
    for (std::size_t k = 0; k < 4; ++k) in = in && c[k] >= low[k] && c[k] <= high[k];
    return in;
  };
  s.nearest = [low, high](const Color& c) {
    Color n;
    for (std::size_t k = 0; k < 4; ++k) n[k] = std::clamp(c[k], low[k], high[k]);
    return n;
  };
  return s;
}

/// A slab: low <= n . color <= high.
struct Slab {
  std::array<double, 3> n;
  double low, high;

  double at(const Color& c) const { return n[0] * c[0] + n[1] * c[1] + n[2] * c[2]; }
};

/// The point where up to three planes n . x = b meet that is nearest to h, by the normal equations; false when the
/// planes do not meet in one such point.
bool nearest_on_planes(const std::vector<std::pair<std::array<double, 3>, double>>& planes, const Color& h, Color& x) {
  using Real = long double;
  const std::size_t n = planes.size();
  Real m[3][4] = {};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < 3; ++k) m[i][j] += static_cast<Real>(planes[i].first[k]) * planes[j].first[k];
    m[i][3] = -planes[i].second;
    for (std::size_t k = 0; k < 3; ++k) m[i][3] += static_cast<Real>(planes[i].first[k]) * h[k];
  }
  for (std::size_t i = 0; i < n; ++i) {  // positive definite: no pivoting is needed
    if (m[i][i] < 1e-9L) return false;
    for (std::size_t j = 0; j < n; ++j)
      if (j != i)
        for (std::size_t k = 4; k-- > i;) m[j][k] -= m[j][i] / m[i][i] * m[i][k];
  }
  x = h;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) x[k] -= double(m[i][3] / m[i][i] * planes[i].first[k]);
  return true;
}

/// Of all points where up to three sides of the slabs meet, the nearest to h that is inside them all.
Color nearest_in_slabs(const std::vector<Slab>& slabs, const Color& h) {
  double size = 0, best = kInfinity;
  for (const Slab& s : slabs) size = std::max({size, std::abs(s.low), std::abs(s.high)});
  Color nearest = h;
  const auto consider = [&](const Color& x) {
    for (const Slab& s : slabs)
      if (s.at(x) < s.low - 1e-12 * size || s.at(x) > s.high + 1e-12 * size) return;
    const double distance = std::hypot(x[0] - h[0], x[1] - h[1], x[2] - h[2]);
    if (distance < best) best = distance, nearest = x;
  };
  consider(h);
  const std::size_t sides = 2 * slabs.size();
  const auto side = [&](std::size_t i) {
    return std::make_pair(slabs[i / 2].n, i % 2 ? slabs[i / 2].high : slabs[i / 2].low);
  };
  Color x;
  for (std::size_t i = 0; i < sides; ++i) {
    if (nearest_on_planes({side(i)}, h, x)) consider(x);
    for (std::size_t j = i + 1; j < sides; ++j) {
      if (nearest_on_planes({side(i), side(j)}, h, x)) consider(x);
      for (std::size_t k = j + 1; k < sides; ++k)
        if (nearest_on_planes({side(i), side(j), side(k)}, h, x)) consider(x);
    }
  }
  return nearest;
}

std::vector<Slab> slabs_of(const std::vector<Sample>& samples, const RectifyParameters& p, double floor) {
  std::vector<std::array<double, 3>> directions;
  if (p.box == Box::pca) {
    const Axes axes = principal_axes(samples);
    directions.assign(axes.direction.begin(), axes.direction.end());
  } else {
    // One of each pair of opposite directions with components -1, 0, 1; 7-DOP: those with one or three of them.
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c)
          if ((a > 0 || (a == 0 && (b > 0 || (b == 0 && c > 0)))) &&
              (p.box == Box::kdop13 || std::abs(a) + std::abs(b) + std::abs(c) != 2))
            directions.push_back({double(a), double(b), double(c)});
  }
  std::vector<Slab> slabs;
  for (const auto& n : directions) {
    Slab s{n, kInfinity, -kInfinity};
    for (const Sample& c : samples) s.low = std::min(s.low, s.at(c.color)), s.high = std::max(s.high, s.at(c.color));
    const double wide = floor * std::hypot(n[0], n[1], n[2]);
    s.low -= wide;
    s.high += wide;
    slabs.push_back(s);
  }
  return slabs;
}

Shape slab_shape(const std::vector<Sample>& samples, const Statistics& s, const RectifyParameters& p) {
  const double floor = 1e-6 * size_of(s.mean), alpha_floor = 1e-6 * std::abs(s.mean[3]);
  const std::vector<Slab> slabs = slabs_of(samples, p, floor);
  const double low = s.low[3] - alpha_floor, high = s.high[3] + alpha_floor;
  Shape shape;
  shape.mean = shape.center = s.mean;
  if (p.box == Box::pca) {
    Color center{0, 0, 0, low / 2 + high / 2};
    for (const Slab& slab : slabs)
      for (std::size_t k = 0; k < 3; ++k) center[k] += slab.n[k] * (slab.low / 2 + slab.high / 2);
    shape.center = center;
  }
  shape.inside = [=](const Color& c) {
    bool in = c[3] >= low && c[3] <= high;
    for (const Slab& slab : slabs) in = in && slab.at(c) >= slab.low && slab.at(c) <= slab.high;
    return in;
  };
  shape.nearest = [=](const Color& c) {
    Color n = nearest_in_slabs(slabs, c);
    n[3] = std::clamp(c[3], low, high);
    return n;
  };
  return shape;
}

Shape ellipsoid_shape(const std::vector<Sample>& samples, const Statistics& s, const RectifyParameters& p) {
  const double floor = 1e-6 * size_of(s.mean), alpha = p.gamma * s.deviation[3] + 1e-6 * std::abs(s.mean[3]);
  const Axes axes = principal_axes(samples);
  std::array<double, 3> radius{};
  for (std::size_t k = 0; k < 3; ++k) radius[k] = p.gamma * std::sqrt(axes.variance[k]) + floor;
  const Color mean = s.mean;
  const auto along = [axes, mean](const Color& c, std::size_t i) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += axes.direction[i][k] * (c[k] - mean[k]);
    return sum;
  };
  Shape shape;
  shape.mean = shape.center = mean;
  shape.inside = [=](const Color& c) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(along(c, i) / radius[i], 2);
    return sum <= 1 && std::abs(c[3] - mean[3]) <= alpha;
  };
  shape.nearest = [=](const Color& c) {
    // The multiplier by bisection.
    double low = 0, high = 0, sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      high += radius[i] * std::abs(along(c, i)), sum += std::pow(along(c, i) / radius[i], 2);
    Color n = c;
    n[3] = std::clamp(c[3], mean[3] - alpha, mean[3] + alpha);
    if (sum <= 1) return n;
    for (int step = 0; step < 300; ++step) {
      const double t = (low + high) / 2;
      double f = 0;
      for (std::size_t i = 0; i < 3; ++i) f += std::pow(radius[i] * along(c, i) / (radius[i] * radius[i] + t), 2);
      (f > 1 ? low : high) = t;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      n[k] = mean[k];
      for (std::size_t i = 0; i < 3; ++i)
        n[k] += axes.direction[i][k] * along(c, i) * radius[i] * radius[i] / (radius[i] * radius[i] + high);
    }
    return n;
  };
  return shape;
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

std::optional<Shape> shape_of(const Present& present, const RectifyParameters& p, const Space& space,
                              const std::vector<Sample>& samples, const Statistics& s, int x, int y, bool with_centre) {
  const auto map = [&](const glm::vec4& c) { return space.to(color_of(c)); };
  Color low = s.low, high = s.high, mean = s.mean;
  RectifyParameters plain = p;
  plain.moments = WindowMoments::direct;
  switch (p.box) {
    case Box::none:
    case Box::hull:  // see hull_reference
      return {};
    case Box::kdop7:
    case Box::kdop13:
    case Box::pca:
      return slab_shape(samples, s, p);
    case Box::ellipsoid:
      return ellipsoid_shape(samples, s, p);
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

Axes principal_axes(const std::vector<Sample>& samples) {
  using Real = long double;
  Real mean[3] = {}, a[3][3] = {}, v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Real n = static_cast<Real>(samples.size());
  for (const Sample& s : samples)
    for (std::size_t k = 0; k < 3; ++k) mean[k] += s.color[k] / n;
  for (const Sample& s : samples)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) a[i][j] += (s.color[i] - mean[i]) * (s.color[j] - mean[j]) / n;
  for (int turn = 0; turn < 60; ++turn) {
    int p = 0, q = 1;
    if (std::abs(a[0][2]) > std::abs(a[p][q])) p = 0, q = 2;
    if (std::abs(a[1][2]) > std::abs(a[p][q])) p = 1, q = 2;
    if (a[p][q] == 0) break;
    const Real angle = std::atan2(2 * a[p][q], a[q][q] - a[p][p]) / 2, c = std::cos(angle), s = std::sin(angle);
    for (int k = 0; k < 3; ++k) {
      const Real x = a[k][p], y = a[k][q];
      a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 3; ++k) {
      const Real x = a[p][k], y = a[q][k];
      a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
      const Real e = v[p][k], f = v[q][k];
      v[p][k] = c * e - s * f, v[q][k] = s * e + c * f;
    }
  }
  Axes axes;
  for (std::size_t i = 0; i < 3; ++i) {
    axes.variance[i] = std::max(0.0, double(a[i][i]));
    for (std::size_t k = 0; k < 3; ++k) axes.direction[i][k] = double(v[i][k]);
  }
  return axes;
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
  if (p.rule == BoxRule::clip) {
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
