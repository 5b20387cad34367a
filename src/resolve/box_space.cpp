#include "resolve/box_space.h"

#include <array>
#include <cmath>
#include <vector>

namespace varve {
namespace {

constexpr int kLowest = -149, kExponents = 277;  // of float, denormals included
constexpr int kStopsBelow = 6;

using ExponentCounts = std::array<std::size_t, kExponents>;

/// Exponent of the median magnitude of the valid color values that are not 0; 0 when there are none.
int median_exponent(const Present& present, Workers& workers) {
  const Window& w = present.color.window();
  std::vector<ExponentCounts> counts(std::size_t(workers.count()), ExponentCounts{});
  workers.for_each(std::size_t(w.height()), [&](std::size_t row, int worker) {
    ExponentCounts& mine = counts[std::size_t(worker)];
    const int y = w.y0 + int(row);
    const glm::vec4* color = present.color.row(y);
    const float* valid = present.valid.row(y);
    for (int x = 0; x < w.width(); ++x)
      for (int k = 0; k < 3; ++k)
        if (valid[x] > 0 && color[x][k] != 0) ++mine[std::size_t(std::ilogb(color[x][k]) - kLowest)];
  });
  ExponentCounts sum{};
  std::size_t all = 0;
  for (const ExponentCounts& c : counts)
    for (std::size_t e = 0; e < c.size(); ++e) sum[e] += c[e], all += c[e];
  std::size_t below = 0;
  for (std::size_t e = 0; e < sum.size(); ++e) {
    below += sum[e];
    if (all > 0 && 2 * below >= all) return int(e) + kLowest;
  }
  return 0;
}

double signed_log(double x, double knee) { return std::copysign(std::log1p(std::abs(x) / knee), x); }
double signed_exp(double y, double knee) { return std::copysign(std::expm1(std::abs(y)) * knee, y); }

glm::vec4 rotate_to_ycocg(const glm::vec4& c) {
  const float rb = c.r * 0.25f + c.b * 0.25f;
  return {rb + c.g * 0.5f, c.r * 0.5f - c.b * 0.5f, c.g * 0.5f - rb, c.a};
}

}  // namespace

BoxSpaceMap box_space_map(BoxSpace space, const Present& present, Workers& workers) {
  BoxSpaceMap map{space, 1};
  if (space == BoxSpace::log) map.knee = std::ldexp(1.0, median_exponent(present, workers) - kStopsBelow);
  return map;
}

glm::dvec4 to_box_space(const BoxSpaceMap& map, const glm::dvec4& c) {
  switch (map.space) {
    case BoxSpace::rgb:
      return c;
    case BoxSpace::ycocg: {
      const double rb = c.r * 0.25 + c.b * 0.25;
      return {rb + c.g * 0.5, c.r * 0.5 - c.b * 0.5, c.g * 0.5 - rb, c.a};
    }
    case BoxSpace::log:
      return {signed_log(c.r, map.knee), signed_log(c.g, map.knee), signed_log(c.b, map.knee), c.a};
  }
  return c;
}

glm::dvec4 from_box_space(const BoxSpaceMap& map, const glm::dvec4& c) {
  switch (map.space) {
    case BoxSpace::rgb:
      return c;
    case BoxSpace::ycocg:
      return {c.x - c.z + c.y, c.x + c.z, c.x - c.z - c.y, c.a};
    case BoxSpace::log:
      return {signed_exp(c.r, map.knee), signed_exp(c.g, map.knee), signed_exp(c.b, map.knee), c.a};
  }
  return c;
}

Plane<glm::vec4> plane_in_box_space(const BoxSpaceMap& map, const Plane<glm::vec4>& color, Workers& workers) {
  if (map.space == BoxSpace::rgb) return {};
  const Window& w = color.window();
  const int b = color.border();
  Plane<glm::vec4> out(w, b);
  workers.for_rows(w.y0 - b, w.y1 + b, [&](int y) {
    const glm::vec4* from = color.row(y) - b;
    glm::vec4* to = out.row(y) - b;
    for (int x = 0; x < w.width() + 2 * b; ++x)
      to[x] =
          map.space == BoxSpace::ycocg ? rotate_to_ycocg(from[x]) : glm::vec4(to_box_space(map, glm::dvec4(from[x])));
  });
  return out;
}

}  // namespace varve
