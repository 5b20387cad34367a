#include "resolve/remainder.h"

#include <cmath>
#include <cstring>

namespace varve {
namespace {

/// Remainder of the history pixel that (x, y) has read as it is; 0 where there is none.
glm::vec4 remainder_at(const RowPassView& pass, int x, int y, const float* fetched) {
  const Plane<glm::vec4>& remainder = pass.previous.remainder;
  if (remainder.empty()) return glm::vec4(0.0f);
  const AccumulateView& v = pass.frame;
  const float* motion = v.motion.origin + y * v.motion.stride + 2 * x;
  const double hx = x + v.shift_x + double(motion[0]), hy = y + v.shift_y + double(motion[1]);
  const bool inside = hx >= 0 && hy >= 0 && hx < v.history_width && hy < v.history_height;
  if (!inside || hx != std::floor(hx) || hy != std::floor(hy)) return glm::vec4(0.0f);
  const Window& w = remainder.window();
  const glm::vec4& color = pass.previous.color.row(w.y0 + int(hy))[int(hx)];
  if (std::memcmp(&color, fetched, sizeof color) != 0) return glm::vec4(0.0f);
  return remainder.row(w.y0 + int(hy))[int(hx)];
}

}  // namespace

bool keeps_remainder(const RecursiveParameters& p) {
  return p.alpha < 0.01 && p.weight.weighing != Weighing::logarithm && p.reject.on_reject != OnReject::blur;
}

void blend_remainder(const RowPassView& pass, int y, const RowScratch& s, const RowPassScratch& extra,
                     Plane<glm::vec4>& remainder) {
  const AccumulateView& v = pass.frame;
  glm::vec4* left = remainder.row(remainder.window().y0 + y);
  for (int x = 0; x < v.width; ++x) {
    left[x] = glm::vec4(0.0f);
    if (!(s.total[x] > 0)) continue;
    const float* history = s.history + 4 * x;
    const glm::vec4 before = remainder_at(pass, x, y, history);
    const double w = !(v.weight.origin[y * v.weight.stride + x] > 0) ? 0.0
                     : v.sample_weight.origin ? double(v.sample_weight.origin[y * v.sample_weight.stride + x])
                                              : 1.0;
    const double a = w > 0 ? extra.present_weight[x] : 0.0;
    const float* present = v.color.origin + y * v.color.stride + 4 * x;
    float* out = v.out_color.origin + y * v.out_color.stride + 4 * x;
    for (int k = 0; k < 4; ++k) {
      const double past = double(history[k]) + double(before[k]);
      const double blended = past + (double(present[k]) - past) * a;
      if (!(std::abs(blended) <= 3.4028234663852886e38)) continue;  // the blend without it is within the floats
      out[k] = float(blended);
      left[x][k] = float(blended - double(out[k]));
    }
  }
}

}  // namespace varve
