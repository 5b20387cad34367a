#include "resolve/blur_variance.h"

#include <algorithm>
#include <cmath>

#include "resolve/resampling_kernel.h"

namespace varve {

double kernel_variance(const RecursiveParameters& parameters, double v) {
  if (parameters.history_filter == HistoryFilter::bilinear) return v * (1 - v);
  if (parameters.history_filter != HistoryFilter::cubic) return 0;
  const CubicWeights k = cubic_weights(parameters.cubic_b, parameters.cubic_c, v);
  double moment = 0;
  for (int i = 0; i < 4; ++i) moment += k.w[i] * (i - 1 - v) * (i - 1 - v);
  return std::max(0.0, moment);
}

double history_variance(const RowPassView& pass, int x, int y) {
  const AccumulateView& v = pass.frame;
  const Plane<float>& blur = pass.previous.blur;
  const float* motion = v.motion.origin + y * v.motion.stride + 2 * x;
  const double hx = x + v.shift_x + double(motion[0]), hy = y + v.shift_y + double(motion[1]);
  const double bx = std::floor(hx), by = std::floor(hy), fx = hx - bx, fy = hy - by;
  const int x0 = int(bx), y0 = int(by);
  const unsigned standing = standing_taps(pass, x, y);
  const float* depth = v.depth.origin ? v.depth.origin + y * v.depth.stride + x : nullptr;
  double share = 0, before = 0, moment = 0;
  bool all = true;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
      if (!(weight > 0)) continue;
      const int tx = x0 + i, ty = y0 + j;
      const bool inside = tx >= 0 && ty >= 0 && tx < v.history_width && ty < v.history_height;
      bool counts =
          inside && (standing >> (i + 2 * j) & 1u) && v.history_total.origin[ty * v.history_total.stride + tx] > 0;
      if (counts && depth) {
        const double a = double(v.history_depth.origin[ty * v.history_depth.stride + tx]), b = double(*depth);
        counts = a == b || std::abs(a - b) <= v.depth_tolerance * std::min(a, b);
      }
      all = all && counts;
      if (!counts) continue;
      const double dx = i - fx, dy = j - fy;
      share += weight;
      moment += weight * (dx * dx + dy * dy) / 2;
      const Window& w = pass.previous.color.window();
      before += weight * (blur.empty() ? kPixelVariance : double(blur.at(tx + w.x0, ty + w.y0)));
    }
  if (!(share > 0)) return kPixelVariance;
  if (all) return before + (kernel_variance(pass.parameters, fx) + kernel_variance(pass.parameters, fy)) / 2;
  return (before + moment) / share;
}

}  // namespace varve
