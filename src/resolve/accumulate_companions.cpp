#include "resolve/accumulate_companions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace varve {
namespace {

PixelRows<const float> rows_of(const Plane<glm::vec4>& plane) {
  if (plane.empty()) return {nullptr, 0};
  return {&plane.row(plane.window().y0)->x, plane.stride() * 4};
}

bool is_color(const Present& present, std::size_t i) {
  return i >= present.companion_is_color.size() || present.companion_is_color[i] != 0;
}

void store(PixelRows<float> out, int x, int y, const glm::dvec4& value) {
  constexpr double most = std::numeric_limits<float>::max();
  float* to = out.origin + y * out.stride + 4 * x;
  for (int k = 0; k < 4; ++k) to[k] = float(std::clamp(value[k], -most, most));
}

/// What the blend did to the color beyond a plain mix by the weight, relative to it: its rounding, mostly.
glm::dvec4 rest_of(const glm::dvec4& value, const float* result) {
  glm::dvec4 rest(0.0);
  for (int k = 0; k < 4; ++k) {
    const double r = value[k] != 0 ? (double(result[k]) - value[k]) / value[k] : 0;
    if (std::abs(r) <= 1e3) rest[k] = r;
  }
  return rest;
}

}  // namespace

CompanionPass view_companions(const AccumulateView& view, const Present& present, const History& previous,
                              const Reconstruct& reconstruct, History& out) {
  CompanionPass pass;
  const std::size_t count = present.companions.size();
  if (count == 0) return pass;
  pass.reconstructed.resize(count);
  // The color's own pixels, not what its filter may have made of them to read between.
  pass.color = {rows_of(present.color), view.color, rows_of(previous.color), true};
  for (std::size_t i = 0; i < count; ++i) {
    const Plane<glm::vec4>& plane = present.companions[i];
    if (reconstruct) pass.reconstructed[i] = reconstruct(plane);
    const bool has_history = !previous.empty() && i < previous.companions.size();
    pass.planes.push_back({rows_of(plane), rows_of(reconstruct ? pass.reconstructed[i] : plane),
                           has_history ? rows_of(previous.companions[i]) : PixelRows<const float>{nullptr, 0},
                           is_color(present, i)});
    Plane<glm::vec4>& to = out.companions.emplace_back(plane.window());
    pass.out.push_back({&to.row(to.window().y0)->x, to.stride() * 4});
  }
  return pass;
}

void accumulate_companions(const AccumulateView& v, int y, const RowScratch& s, const RowPassView& passes,
                           const CompanionPass& pass) {
  for (int x = 0; x < v.width; ++x) {
    const bool has_history = s.total[x] > 0;
    const float* result = v.out_color.origin + y * v.out_color.stride + 4 * x;
    const double a = has_history ? 1 - double(v.out_weight.origin[y * v.out_weight.stride + x]) : 0;
    const unsigned standing = has_history ? standing_taps(passes, x, y) : 15;
    const CompanionMove move =
        find_move(v, pass.color, x, y, has_history, has_history ? s.history + 4 * x : result, standing);
    const auto blended = [&](const CompanionRows& plane, const glm::dvec4& history) {
      return history + (pixel_of(plane.present, x, y) - history) * a;
    };
    const glm::dvec4 rest = rest_of(blended(pass.color, move.value), result);
    for (std::size_t i = 0; i < pass.planes.size(); ++i) {
      const glm::dvec4 value = blended(pass.planes[i], apply_move(v, move, pass.planes[i], x, y));
      store(pass.out[i], x, y, pass.planes[i].color ? value + value * rest : value);
    }
  }
}

}  // namespace varve
