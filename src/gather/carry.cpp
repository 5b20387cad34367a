#include "gather/carry.h"

#include <algorithm>
#include <limits>

namespace varve {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

template <class V>
struct Value;
template <>
struct Value<glm::vec2> {
  using Wide = glm::dvec2;
};
template <>
struct Value<glm::vec3> {
  using Wide = glm::dvec3;
};

/// Weighted affine fit of a field around `at`: value = constant + slope * (position - at), its constant.
/// The slope is held back a little, so that samples on a line, or a single one, give what they know.
template <class Wide>
class AffineFit {
 public:
  void add(glm::dvec2 d, double weight, const Wide& value) {
    w_ += weight;
    x_ += weight * d.x, y_ += weight * d.y;
    xx_ += weight * d.x * d.x, xy_ += weight * d.x * d.y, yy_ += weight * d.y * d.y;
    // Shifted by the first value, so that nothing cancels.
    if (count_++ == 0) first_ = value;
    const Wide v = value - first_;
    v_ += weight * v, vx_ += weight * d.x * v, vy_ += weight * d.y * v;
  }
  int count() const { return count_; }
  Wide value() const {
    const double mx = x_ / w_, my = y_ / w_;
    const Wide mean = v_ / w_;
    double sxx = xx_ / w_ - mx * mx, sxy = xy_ / w_ - mx * my, syy = yy_ / w_ - my * my;
    const double ridge = 1e-3 * (sxx + syy) + 1e-6;
    sxx += ridge, syy += ridge;
    const Wide cx = vx_ / w_ - mx * mean, cy = vy_ / w_ - my * mean;
    const double det = sxx * syy - sxy * sxy;
    const Wide gx = (cx * syy - cy * sxy) / det, gy = (cy * sxx - cx * sxy) / det;
    return first_ + mean - gx * mx - gy * my;
  }

 private:
  double w_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
  Wide first_{0}, v_{0}, vx_{0}, vy_{0};
  int count_ = 0;
};

/// The field at a position, from samples of one surface.
template <class V>
typename Value<V>::Wide read_field(const Plane<V>& field, const GatherSource& source, glm::dvec2 at, SurfaceKey key,
                                   const SurfaceTest& test) {
  using Wide = typename Value<V>::Wide;
  const Window& w = source.window();
  const Present& p = *source.present;
  const double ux = at.x - 0.5 - source.jitter.x, uy = at.y - 0.5 - source.jitter.y;  // on the grid of samples
  // Half a pixel beyond the outermost samples there is nothing to follow.
  if (!(ux >= w.x0 - 1.0 && uy >= w.y0 - 1.0 && ux <= double(w.x1) && uy <= double(w.y1))) return Wide(kNowhere);
  const int bx = int(std::floor(ux)), by = int(std::floor(uy));
  const double fx = ux - bx, fy = uy - by;
  if (bx >= w.x0 && by >= w.y0 && bx + 1 < w.x1 && by + 1 < w.y1) {
    Wide corner[4];
    bool all = true;
    for (int k = 0; k < 4 && all; ++k) {
      const int x = bx + (k & 1), y = by + (k >> 1);
      corner[k] = Wide(field.at(x, y));
      all = corner[k].x == corner[k].x && test.same(surface_at(p, x, y), key);
    }
    if (all) {
      const Wide top = corner[0] + (corner[1] - corner[0]) * fx, bottom = corner[2] + (corner[3] - corner[2]) * fx;
      return top + (bottom - top) * fy;
    }
  }
  for (int reach = 2; reach <= 8; reach *= 2) {  // 4x4, 8x8, 16x16 samples
    AffineFit<Wide> fit;
    const int x0 = std::max(bx + 1 - reach, w.x0), x1 = std::min(bx + reach, w.x1 - 1);
    const int y0 = std::max(by + 1 - reach, w.y0), y1 = std::min(by + reach, w.y1 - 1);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const V v = field.at(x, y);
        if (!(v.x == v.x) || !test.same(surface_at(p, x, y), key)) continue;
        const glm::dvec2 d(x - ux, y - uy);
        fit.add(d, 1 / (0.25 + d.x * d.x + d.y * d.y), Wide(v));
      }
    // A fit that only reaches to one side needs more than it takes to span a plane.
    if (fit.count() >= (reach == 2 ? 6 : reach == 4 ? 5 : 1)) return fit.value();
  }
  return Wide(kNowhere);
}

}  // namespace

glm::dvec2 read_between(const Plane<glm::vec2>& field, const GatherSource& source, glm::dvec2 at, SurfaceKey key,
                        const SurfaceTest& test) {
  return read_field(field, source, at, key, test);
}

Carried carry_present(const GatherSource& present, Workers& workers) {
  const Window& w = present.window();
  Carried field(w);
  const Plane<float>& depth = present.present->depth;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) field.at(x, y) = glm::vec3(0, 0, depth.empty() ? 0.0f : depth.at(x, y));
  });
  return field;
}

Carried carry(const GatherSource& source, bool to_future, const SurfaceTest& test, Followed nearer, Followed beyond,
              Workers& workers) {
  const Window& w = source.window();
  Carried field(w);
  const Plane<glm::vec2>* vectors = to_future ? source.forward : source.backward;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::vec3& out = field.at(x, y);
      out = glm::vec3(kNowhere);
      const glm::dvec2 v = vectors ? glm::dvec2(vectors->at(x, y)) : glm::dvec2(0);
      if (!(v.x == v.x)) continue;
      const glm::dvec2 from = source.position(x, y);
      const SurfaceKey key = surface_at(*source.present, x, y);
      glm::dvec2 step = v;
      glm::dvec3 rest = read_field(*nearer.field, *nearer.source, from + step, key, test);
      if (!(rest.x == rest.x) && beyond.field) {
        step = 2.0 * v;
        rest = read_field(*beyond.field, *beyond.source, from + step, key, test);
      }
      if (!(rest.x == rest.x)) continue;
      out = glm::vec3(glm::dvec3(step, 0) + rest);
      if (!(out.z == out.z)) out.z = key.depth;  // infinitely far: differences of infinities are no numbers
    }
  });
  return field;
}

}  // namespace varve
