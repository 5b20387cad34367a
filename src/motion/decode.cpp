#include <atomic>
#include <cmath>
#include <limits>

#include "motion/motion.h"

namespace varve {

Plane<glm::vec2> decode_motion(const Plane<float>& x, const Plane<float>& y, const MotionEncoding& encoding,
                               const Window& display_window, double max_length, Workers& workers,
                               std::size_t& unusable) {
  const Window& window = x.window();
  Plane<glm::vec2> motion(window);

  // One factor and one offset per axis: pixels = v * factor + offset.
  double unit_x = 1, unit_y = 1;
  if (encoding.unit != MotionUnit::pixel) {
    const double share = encoding.unit == MotionUnit::ndc ? 0.5 : 1.0;
    unit_x = share * display_window.width();
    unit_y = share * display_window.height();
  }
  const double factor_x = encoding.sign_x * encoding.scale / encoding.shutter * unit_x;
  const double factor_y = encoding.sign_y * encoding.scale / encoding.shutter * unit_y;

  std::atomic<std::size_t> bad = 0;
  workers.for_rows(window.y0, window.y1, [&](int row) {
    const float* from_x = x.row(row);
    const float* from_y = y.row(row);
    glm::vec2* to = motion.row(row);
    std::size_t bad_here = 0;
    for (int i = 0; i < window.width(); ++i) {
      const double dx = (double(from_x[i]) - encoding.bias) * factor_x;
      const double dy = (double(from_y[i]) - encoding.bias) * factor_y;
      to[i] = glm::vec2(float(dx), float(dy));
      if (!(dx * dx + dy * dy <= max_length * max_length)) {
        to[i] = glm::vec2(std::numeric_limits<float>::quiet_NaN());
        ++bad_here;
      }
    }
    bad += bad_here;
  });
  unusable += bad;
  return motion;
}

void canonical_depth(Plane<float>& depth, DepthKind kind, double background, Workers& workers) {
  const Window& window = depth.window();
  workers.for_rows(window.y0, window.y1, [&](int row) {
    float* z = depth.row(row);
    for (int i = 0; i < window.width(); ++i) {
      float distance = z[i];
      if (kind == DepthKind::negative) distance = -distance;
      if (kind == DepthKind::inverse) distance = 1.0f / distance;  // 0 and denormals: infinitely far
      if (!(distance > 0 && double(distance) < background)) distance = std::numeric_limits<float>::infinity();
      z[i] = distance;
    }
  });
}

}  // namespace varve
