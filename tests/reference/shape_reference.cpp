#include "reference/shape_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace varve::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

std::vector<Slab> slabs_of(const std::vector<Sample>& samples, Box box, double floor) {
  std::vector<std::array<double, 3>> directions;
  if (box == Box::pca) {
    const Axes axes = principal_axes(samples);
    directions.assign(axes.direction.begin(), axes.direction.end());
  } else {
    // One of each pair of opposite directions with components -1, 0, 1; 7-DOP: those with one or three of them.
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c)
          if ((a > 0 || (a == 0 && (b > 0 || (b == 0 && c > 0)))) &&
              (box == Box::kdop13 || std::abs(a) + std::abs(b) + std::abs(c) != 2))
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

}  // namespace

double size_of(const Color& c) { return std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])}); }

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

Shape slab_shape(const std::vector<Sample>& samples, const Statistics& s, Box box) {
  const double floor = 1e-6 * size_of(s.mean), alpha_floor = 1e-6 * std::abs(s.mean[3]);
  const std::vector<Slab> slabs = slabs_of(samples, box, floor);
  const double low = s.low[3] - alpha_floor, high = s.high[3] + alpha_floor;
  Shape shape;
  shape.mean = shape.center = s.mean;
  if (box == Box::pca) {
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

Shape ellipsoid_shape(const std::vector<Sample>& samples, const Statistics& s, double gamma) {
  const double floor = 1e-6 * size_of(s.mean), alpha = gamma * s.deviation[3] + 1e-6 * std::abs(s.mean[3]);
  const Axes axes = principal_axes(samples);
  std::array<double, 3> radius{};
  for (std::size_t k = 0; k < 3; ++k) radius[k] = gamma * std::sqrt(axes.variance[k]) + floor;
  const Color mean = s.mean;
  const auto along = [axes, mean](const Color& c, std::size_t i) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += axes.direction[i][k] * (c[k] - mean[k]);
    return sum;
  };
  // In radii; a black patch has none at all, and is one color.
  const auto out = [along, radius](const Color& c, std::size_t i) {
    const double way = along(c, i);
    return way == 0 ? 0.0 : way / radius[i];
  };
  Shape shape;
  shape.mean = shape.center = mean;
  shape.inside = [=](const Color& c) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(out(c, i), 2);
    return sum <= 1 && std::abs(c[3] - mean[3]) <= alpha;
  };
  shape.nearest = [=](const Color& c) {
    // The multiplier by bisection.
    double low = 0, high = 0, sum = 0;
    for (std::size_t i = 0; i < 3; ++i) high += radius[i] * std::abs(along(c, i)), sum += std::pow(out(c, i), 2);
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
        if (radius[i] > 0)
          n[k] += axes.direction[i][k] * along(c, i) * radius[i] * radius[i] / (radius[i] * radius[i] + high);
    }
    return n;
  };
  return shape;
}

}  // namespace varve::reference
