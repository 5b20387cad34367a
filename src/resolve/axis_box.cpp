#include "resolve/axis_box.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace varve {
namespace {

glm::dvec4 vector_of(const float (&v)[4]) { return {double(v[0]), double(v[1]), double(v[2]), double(v[3])}; }
glm::dvec4 vector_of(const double (&v)[4]) { return {v[0], v[1], v[2], v[3]}; }

/// The valid ones of the four pixels around a position (pixel centres are integers), bilinear; false when there are
/// none.
bool tap(const AccumulateView& v, int x, int y, double tap_x, double tap_y, glm::dvec4& color) {
  const int bx = int(std::floor(tap_x)), by = int(std::floor(tap_y));
  const double fx = tap_x - bx, fy = tap_y - by;
  double weights = 0;
  glm::dvec4 pivot(0), sum(0);
  for (int j = by; j <= by + 1; ++j)
    for (int i = bx; i <= bx + 1; ++i) {
      const double weight = (i > bx ? fx : 1 - fx) * (j > by ? fy : 1 - fy);
      if (!(v.weight.origin[j * v.weight.stride + i] > 0) || (v.leave_present_out && i == x && j == y)) continue;
      const glm::dvec4 c = color_at(v.neighbors, i, j);
      if (weights == 0) pivot = c;
      sum += (c - pivot) * weight;
      weights += weight;
    }
  if (weights > 0) color = pivot + sum / weights;
  return weights > 0;
}

}  // namespace

double AxisBox::crossing(const glm::dvec3& g, const glm::dvec3& h) const {
  double t = 1;
  for (int k = 0; k < 3; ++k) {
    if (h[k] > high[k]) t = std::min(t, (high[k] - g[k]) / (h[k] - g[k]));
    if (h[k] < low[k]) t = std::min(t, (low[k] - g[k]) / (h[k] - g[k]));
  }
  return std::max(t, 0.0);
}

glm::dvec3 AxisBox::nearest(const glm::dvec3& h) const { return glm::clamp(h, glm::dvec3(low), glm::dvec3(high)); }

double color_size(const glm::dvec3& c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

AxisBox minmax_box(const Extremes& extremes) {
  AxisBox box{vector_of(extremes.low), vector_of(extremes.high), glm::dvec4(0)};
  box.mean = box.low * 0.5 + box.high * 0.5;
  return box;
}

AxisBox rounded_box(const AccumulateView& view, int x, int y, Samples& samples) {
  gather_samples(view, 1, x, y, samples);
  const AxisBox square = minmax_box(extremes_of(samples));
  const Moments all = moments_of(samples);
  samples.clear();
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const bool left_out = view.leave_present_out && i == 0 && j == 0;
      if ((i != 0 && j != 0) || left_out || !(view.weight.origin[(y + j) * view.weight.stride + x + i] > 0)) continue;
      samples.push_back(color_at(view.neighbors, x + i, y + j));
    }
  AxisBox box = square;
  box.mean = vector_of(all.mean);
  if (samples.empty()) return box;
  const AxisBox plus = minmax_box(extremes_of(samples));
  box.low = square.low * 0.5 + plus.low * 0.5;
  box.high = square.high * 0.5 + plus.high * 0.5;
  box.mean = box.mean * 0.5 + vector_of(moments_of(samples).mean) * 0.5;
  return box;
}

bool dynamic_box(const AccumulateView& view, int x, int y, AxisBox& box) {
  const float* motion = view.motion.origin + y * view.motion.stride + 2 * x;
  const double speed = std::hypot(double(motion[0]), double(motion[1]));
  const double distance = 0.5 + (speed > 0.5 ? 0.5 / speed : 1.0) / 6;
  int taps = 0;
  glm::dvec4 first(0), sum(0);
  for (const double dy : {-distance, distance})
    for (const double dx : {-distance, distance}) {
      glm::dvec4 c;
      if (!tap(view, x, y, x + dx, y + dy, c)) continue;
      if (taps == 0) first = box.low = box.high = c;
      box.low = glm::min(box.low, c);
      box.high = glm::max(box.high, c);
      sum += c - first;
      ++taps;
    }
  if (taps > 0) box.mean = first + sum / double(taps);
  return taps > 0;
}

AxisBox variance_box(const Moments& moments, double gamma, const Extremes* extremes) {
  AxisBox box;
  box.mean = vector_of(moments.mean);
  for (int k = 0; k < 4; ++k) {
    const double reach = gamma * std::sqrt(moments.m2[k] / moments.n);
    box.low[k] = box.mean[k] - reach;
    box.high[k] = box.mean[k] + reach;
  }
  if (extremes) {
    box.low = glm::max(box.low, vector_of(extremes->low));
    box.high = glm::min(box.high, vector_of(extremes->high));
  }
  return box;
}

void widen(AxisBox& box) {
  const double color = 1e-6 * color_size(glm::dvec3(box.mean));
  const glm::dvec4 floor(color, color, color, 1e-6 * std::abs(box.mean.a));
  box.low -= floor;
  box.high += floor;
}

}  // namespace varve
