// Which pixels of the history a companion is made from: those of the color.

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/common.hpp>

#include "resolve/companion_taps.h"
#include "resolve/resampling_kernel.h"

namespace varve {
namespace {

typedef float Float4 __attribute__((vector_size(16)));
typedef double Double4 __attribute__((vector_size(32)));

/// Catmull-Rom weights of the pixels -1..2 around a fraction.
void catmull_rom(double f, double (&w)[4]) {
  w[0] = ((-0.5 * f + 1.0) * f - 0.5) * f;
  w[1] = (1.5 * f - 2.5) * f * f + 1.0;
  w[2] = ((-1.5 * f + 2.0) * f + 0.5) * f;
  w[3] = (0.5 * f - 0.5) * f * f;
}

bool same_depth(float a, float b, double tolerance) {
  if (a == b) return true;
  const double difference = std::abs(double(a) - double(b));
  return difference <= tolerance * (double(a) < double(b) ? double(a) : double(b));
}

/// The four around the position that pass the tests of the fetch, as a bilinear mean. Returns false when any failed.
bool test_inner(const AccumulateView& v, const float* depth, double fx, double fy, unsigned standing,
                CompanionTaps& t) {
  bool all = true;
  double share = 0, heaviest = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double w = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
      const int x = t.x + i, y = t.y + j;
      t.inner[j][i] = 0;
      if (!(w > 0)) continue;
      const bool inside = x >= 0 && y >= 0 && x < v.history_width && y < v.history_height;
      const bool passed =
          inside && (standing >> (i + 2 * j) & 1u) && v.history_total.origin[y * v.history_total.stride + x] > 0 &&
          (!depth || same_depth(v.history_depth.origin[y * v.history_depth.stride + x], *depth, v.depth_tolerance));
      if (!passed) {
        all = false;
        continue;
      }
      t.inner[j][i] = w;
      share += w;
      if (w > heaviest) heaviest = w, t.nearest_x = x, t.nearest_y = y;
    }
  t.found = share > 0;
  for (auto& row : t.inner)
    for (double& w : row) w = t.found ? w / share : 0;
  return all;
}

void set_wide(const AccumulateView& v, double fx, double fy, CompanionTaps& t) {
  double wx[4], wy[4];
  if (v.filter == HistoryFilter::cubic) {
    std::copy_n(cubic_weights(v.cubic_b, v.cubic_c, fx).w, 4, wx);
    std::copy_n(cubic_weights(v.cubic_b, v.cubic_c, fy).w, 4, wy);
  } else {
    catmull_rom(fx, wx);
    catmull_rom(fy, wy);
  }
  const bool cornerless = v.filter == HistoryFilter::catmull_rom5;
  const double left = cornerless ? 1 - (wx[0] + wx[3]) * (wy[0] + wy[3]) : 1;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const bool corner = (i == 0 || i == 3) && (j == 0 || j == 3);
      t.weight[j][i] = cornerless && corner ? 0 : wx[i] * wy[j] / left;
    }
  t.wide = true;
  t.holds_wide = v.filter == HistoryFilter::cubic;
}

}  // namespace

CompanionTaps find_taps(const AccumulateView& v, int x, int y, unsigned standing) {
  CompanionTaps t;
  const float* motion = v.motion.origin + y * v.motion.stride + 2 * x;
  const double hx = x + v.shift_x + double(motion[0]), hy = y + v.shift_y + double(motion[1]);
  if (!(hx >= -0.5 && hy >= -0.5 && hx <= v.history_width - 0.5 && hy <= v.history_height - 0.5)) return t;
  t.x = int(std::floor(hx));
  t.y = int(std::floor(hy));
  // Fractions are those of the fetch, which holds them as floats.
  const double fx = double(float(hx - t.x)), fy = double(float(hy - t.y));
  const float* depth = v.depth.origin ? v.depth.origin + y * v.depth.stride + x : nullptr;
  const bool inside = t.x >= 1 && t.y >= 1 && t.x + 2 < v.history_width && t.y + 2 < v.history_height;
  bool plain = inside;
  for (int j = -1; plain && j <= 2; ++j)
    for (int i = -1; plain && v.history_rows_valid[t.y + j] == 0 && i <= 2; ++i)
      plain = v.history_total.origin[(t.y + j) * v.history_total.stride + t.x + i] > 0;
  const bool all_passed = test_inner(v, depth, fx, fy, standing, t);
  if (!plain || !all_passed || v.filter == HistoryFilter::bilinear) return t;
  t.nearest_x = t.x + (fx >= 0.5);
  t.nearest_y = t.y + (fy >= 0.5);
  set_wide(v, fx, fy, t);
  return t;
}

glm::dvec4 wide_mean(const CompanionTaps& t, const CompanionRows& plane) {
  const std::ptrdiff_t stride = plane.history.stride;
  Float4 pixel;
  std::memcpy(&pixel, plane.history.origin + t.nearest_y * stride + 4 * t.nearest_x, sizeof pixel);
  const Double4 nearest = __builtin_convertvector(pixel, Double4);
  const float* row = plane.history.origin + (t.y - 1) * stride + 4 * (t.x - 1);
  Double4 sum{0, 0, 0, 0};
  for (int j = 0; j < 4; ++j, row += stride)
    for (int i = 0; i < 4; ++i) {
      std::memcpy(&pixel, row + 4 * i, sizeof pixel);
      sum += (__builtin_convertvector(pixel, Double4) - nearest) * t.weight[j][i];
    }
  const Double4 value = nearest + sum;
  return {value[0], value[1], value[2], value[3]};
}

glm::dvec4 inner_mean(const CompanionTaps& t, const CompanionRows& plane) {
  const glm::dvec4 nearest = pixel_of(plane.history, t.nearest_x, t.nearest_y);
  glm::dvec4 sum(0.0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      if (t.inner[j][i] > 0) sum += (pixel_of(plane.history, t.x + i, t.y + j) - nearest) * t.inner[j][i];
  return nearest + sum;
}

glm::dvec4 held_by_nearest4(const CompanionTaps& t, const CompanionRows& plane, const glm::dvec4& value) {
  glm::dvec4 low = pixel_of(plane.history, t.x, t.y), high = low;
  for (int tap = 1; tap < 4; ++tap) {
    const glm::dvec4 c = pixel_of(plane.history, t.x + (tap & 1), t.y + (tap >> 1));
    low = glm::min(low, c);
    high = glm::max(high, c);
  }
  for (int j = 0; t.holds_wide && j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      if (!(t.weight[1][i] > 0 && t.weight[j][1] > 0)) continue;  // each axis by itself: two lobes make a plus
      const glm::dvec4 c = pixel_of(plane.history, t.x + i - 1, t.y + j - 1);
      low = glm::min(low, c);
      high = glm::max(high, c);
    }
  return glm::min(glm::max(value, low), high);
}

glm::dvec4 held_as_color(const AccumulateView& v, CompanionTaps& t, const CompanionRows& color) {
  glm::dvec4 value = wide_mean(t, color);
  const glm::dvec4 held = held_by_nearest4(t, color, value);
  if (v.dering && held != value) {
    // The mean lies between the least and the greatest: what is held lies between the filter's value and the mean.
    const glm::dvec4 mean = inner_mean(t, color);
    for (int k = 0; k < 3; ++k)
      if (held[k] != value[k] && mean[k] != value[k]) {
        t.hold[k] = glm::min(1.0, (held[k] - value[k]) / (mean[k] - value[k]));
        t.holds = true;
      }
    value = held;
  }
  value.a = held.a;
  return value;
}

}  // namespace varve
