#include "resolve/sharpen.h"

#include <algorithm>
#include <cmath>

namespace varve {
namespace {

/// A channel of the pixels around one pixel, itself included.
struct Surroundings {
  double low, high;
  double difference = 0;  ///< sum of pixel minus neighbor over the four nearest that hold data
  int nearest = 0;        ///< how many do
};

glm::vec4 sharpen_pixel(const Plane<glm::vec4>& color, const Plane<float>& total, double strength, int x, int y) {
  const Window& w = color.window();
  const glm::vec4 own = color.at(x, y);
  Surroundings around[3];
  for (int k = 0; k < 3; ++k) around[k].low = around[k].high = double(own[k]);
  for (int j = std::max(y - 1, w.y0); j <= std::min(y + 1, w.y1 - 1); ++j)
    for (int i = std::max(x - 1, w.x0); i <= std::min(x + 1, w.x1 - 1); ++i) {
      if ((i == x && j == y) || !(total.at(i, j) > 0)) continue;
      const glm::vec4& neighbor = color.at(i, j);
      for (int k = 0; k < 3; ++k) {
        const double v = double(neighbor[k]);
        around[k].low = std::min(around[k].low, v);
        around[k].high = std::max(around[k].high, v);
        if (i != x && j != y) continue;
        around[k].difference += double(own[k]) - v;
        ++around[k].nearest;
      }
    }
  glm::vec4 out = own;
  for (int k = 0; k < 3; ++k) {
    const Surroundings& a = around[k];
    const double size = std::abs(a.high) + std::abs(a.low);
    if (!(a.nearest > 0 && size > 0)) continue;
    const double room = 1 - (a.high - a.low) / size;
    out[k] = float(std::clamp(double(own[k]) + strength * room * (a.difference / a.nearest), a.low, a.high));
  }
  return out;
}

}  // namespace

Plane<glm::vec4> sharpen(const Plane<glm::vec4>& color, const Plane<float>& total, double strength, Workers& workers) {
  const Window& w = color.window();
  Plane<glm::vec4> out(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x)
      out.at(x, y) = total.at(x, y) > 0 ? sharpen_pixel(color, total, strength, x, y) : color.at(x, y);
  });
  return out;
}

}  // namespace varve
