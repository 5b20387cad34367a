#include "motion/seen_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace varve {
namespace {

/// Binary exponents of the light in a frame, summed: whole numbers, so that order does not matter.
struct Exponents {
  long long sum = 0, count = 0;
};

Exponents exponents_of(const Plane<float>& light, Workers& workers) {
  const Window& w = light.window();
  std::vector<Exponents> rows(std::size_t(w.height()));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    Exponents& e = rows[std::size_t(y - w.y0)];
    for (int x = 0; x < w.width(); ++x)
      if (light.row(y)[x] > 0) e.sum += std::ilogb(light.row(y)[x]), ++e.count;
  });
  Exponents all;
  for (const Exponents& e : rows) all.sum += e.sum, all.count += e.count;
  return all;
}

Plane<float> toned(const Plane<float>& light, double middle, Workers& workers) {
  const Window& w = light.window();
  Plane<float> plane(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = 0; x < w.width(); ++x) {
      const double v = double(light.row(y)[x]);
      plane.row(y)[x] = float(v / (v + middle));
    }
  });
  return plane;
}

/// Least or greatest of the 3x3; what lies outside the window has no say.
template <class Pick>
Plane<float> of_neighbors(const Plane<float>& plane, Workers& workers, Pick pick) {
  const Window& w = plane.window();
  Plane<float> across(w), out(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const float* from = plane.row(y);
    float* to = across.row(y);
    const int n = w.width();
    for (int x = 0; x < n; ++x) to[x] = from[x];
    for (int x = 1; x < n; ++x) to[x] = pick(to[x], from[x - 1]);
    for (int x = 0; x + 1 < n; ++x) to[x] = pick(to[x], from[x + 1]);
  });
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const float *up = across.row(std::max(y - 1, w.y0)), *own = across.row(y),
                *down = across.row(std::min(y + 1, w.y1 - 1));
    for (int x = 0; x < w.width(); ++x) out.row(y)[x] = pick(own[x], pick(up[x], down[x]));
  });
  return out;
}

}  // namespace

Plane<float> light_of(const Plane<glm::vec4>& color, Workers& workers) {
  const Window& w = color.window();
  Plane<float> light(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = 0; x < w.width(); ++x) {
      const glm::vec4& c = color.row(y)[x];
      const float v = 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
      light.row(y)[x] = v > 0 && v <= std::numeric_limits<float>::max() ? v : 0.0f;
    }
  });
  return light;
}

SeenPair::SeenPair(const SeenFrame& here, const SeenFrame& there, double depth_tolerance, Workers& workers)
    : here_(here), there_(there), tolerance_(float(depth_tolerance)) {
  const Exponents a = exponents_of(*here.light, workers), b = exponents_of(*there.light, workers);
  const long long count = a.count + b.count;
  const double middle = count > 0 ? std::ldexp(1.0, int(std::floor(double(a.sum + b.sum) / double(count)))) : 1.0;
  light_ = toned(*here.light, middle, workers);
  other_ = toned(*there.light, middle, workers);
  low_ = of_neighbors(other_, workers, [](float p, float q) { return std::min(p, q); });
  high_ = of_neighbors(other_, workers, [](float p, float q) { return std::max(p, q); });
}

Meeting SeenPair::meet_around(int x, int y, int u, int v) const {
  const Meeting middle = meet(x, y, u, v);
  if (middle == Meeting::same || middle == Meeting::outside) return middle;
  bool hidden = middle == Meeting::hidden;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const Meeting m = meet(x, y, u + i, v + j);
      if (m == Meeting::same) return m;
      hidden = hidden || m == Meeting::hidden;
    }
  return hidden ? Meeting::hidden : Meeting::absent;
}

}  // namespace varve
