#include "gather/carry.h"

#include <algorithm>
#include <limits>

#include "gather/affine_fit.h"

namespace varve {
namespace {

constexpr int kWidest = 32;      // samples on each side
constexpr double kMisfit = 0.1;  // px: a field that is no plane cannot be followed there
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

/// Adds the samples of one surface in `part`, weighed by their distance from `at`. Blocks that cannot have one are
/// skipped.
template <class V>
void add_samples(AffineFit<typename Value<V>::Wide>& fit, const Plane<V>& field, const GatherSource& source,
                 const Window& part, glm::dvec2 at, SurfaceKey key, const SurfaceTest& test) {
  const Window& w = source.window();
  for (int y = part.y0; y < part.y1;) {
    const int row = (y - w.y0) / kSurfaceBlock, below = std::min(part.y1, w.y0 + (row + 1) * kSurfaceBlock);
    for (int x = part.x0; x < part.x1;) {
      const int column = (x - w.x0) / kSurfaceBlock, right = std::min(part.x1, w.x0 + (column + 1) * kSurfaceBlock);
      const bool possible =
          !source.blocks ||
          test.may_be_in(key, source.blocks->blocks[std::size_t(row * source.blocks->columns + column)]);
      for (int v = y; possible && v < below; ++v) {
        const SurfaceRow surfaces(*source.present, v);
        const V* values = field.row(v) - w.x0;
        for (int u = x; u < right; ++u) {
          if (!test.same(surfaces[u], key) || !(values[u].x == values[u].x)) continue;
          const glm::dvec2 d(u - at.x, v - at.y);
          fit.add(d, 1 / (0.25 + d.x * d.x + d.y * d.y), typename Value<V>::Wide(values[u]));
        }
      }
      x = right;
    }
    y = below;
  }
}

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
    const SurfaceRow above(p, by), below(p, by + 1);
    if (test.same(above[bx], key) && test.same(above[bx + 1], key) && test.same(below[bx], key) &&
        test.same(below[bx + 1], key)) {
      const V *upper = field.row(by) + (bx - w.x0), *lower = field.row(by + 1) + (bx - w.x0);
      const Wide top = Wide(upper[0]) + (Wide(upper[1]) - Wide(upper[0])) * fx,
                 bottom = Wide(lower[0]) + (Wide(lower[1]) - Wide(lower[0])) * fx;
      const Wide value = top + (bottom - top) * fy;
      // One of them cannot be followed: neither can what lies between, by them alone.
      if (value.x == value.x) return value;
    }
  }
  AffineFit<Wide> fit;
  Window searched{bx + 1, by + 1, bx + 1, by + 1};     // empty
  for (int reach = 2; reach <= kWidest; reach *= 2) {  // 4x4, 8x8 ... samples
    const Window wider = intersect(Window{bx + 1 - reach, by + 1 - reach, bx + 1 + reach, by + 1 + reach}, w);
    const auto add = [&](const Window& part) { add_samples(fit, field, source, part, {ux, uy}, key, test); };
    add({wider.x0, wider.y0, wider.x1, std::max(searched.y0, wider.y0)});
    add({wider.x0, std::min(searched.y1, wider.y1), wider.x1, wider.y1});
    const int y0 = std::max(searched.y0, wider.y0), y1 = std::min(searched.y1, wider.y1);
    add({wider.x0, y0, std::max(searched.x0, wider.x0), y1});
    add({std::min(searched.x1, wider.x1), y0, wider.x1, y1});
    searched = wider;
    // On a line the slope across it is unknown, but a wider window may have another line of the same surface; and a
    // surface that is hidden here is carried on by what is seen of it around.
    if (fit.count() > 0 && (reach == kWidest || (fit.spans_plane() && fit.is_around())))
      return fit.misfit() < kMisfit * kMisfit ? fit.value() : Wide(kNowhere);
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
    for (int x = w.x0; x < w.x1; ++x)
      field.at(x, y) =
          is_followed(present, x, y) ? glm::vec3(0, 0, depth.empty() ? 0.0f : depth.at(x, y)) : glm::vec3(kNowhere);
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
      if (!is_followed(source, x, y)) continue;
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
      // Infinitely far: differences of infinities are no numbers; extrapolated: never behind the camera.
      if (!(out.z > 0)) out.z = key.depth;
    }
  });
  return field;
}

}  // namespace varve
