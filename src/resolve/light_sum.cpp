#include "resolve/light_sum.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace varve {
namespace {

bool is_color(const Present& present, std::size_t i) {
  return i >= present.companion_is_color.size() || present.companion_is_color[i] != 0;
}

double residual(const Present& present, const Plane<glm::vec4>& color, const std::vector<Plane<glm::vec4>>& companions,
                int x, int y) {
  double worst = 0, light = 0;
  for (int k = 0; k < 3; ++k) {
    double sum = 0, size = std::abs(double(color.at(x, y)[k]));
    for (std::size_t i = 0; i < companions.size(); ++i) {
      if (!is_color(present, i)) continue;
      sum += double(companions[i].at(x, y)[k]);
      size += std::abs(double(companions[i].at(x, y)[k]));
    }
    worst = std::max(worst, std::abs(sum - double(color.at(x, y)[k])));
    light = std::max(light, size);
  }
  return light > 0 ? worst / light : 0;
}

}  // namespace

LightSum operator+(const LightSum& a, const LightSum& b) {
  return {a.pixels + b.pixels, a.adding_up + b.adding_up, std::max(a.input, b.input), std::max(a.resolved, b.resolved)};
}

LightSum measure_light_sum(const Present& present, const History& resolved, Workers& workers) {
  const Window& w = present.color.window();
  std::vector<LightSum> rows(std::size_t(std::max(0, w.height())));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    LightSum& row = rows[std::size_t(y - w.y0)];
    for (int x = w.x0; x < w.x1; ++x) {
      if (!(present.valid.at(x, y) > 0)) continue;
      ++row.pixels;
      const double input = residual(present, present.color, present.companions, x, y);
      if (!(input <= kLightSumTolerance)) continue;
      ++row.adding_up;
      row.input = std::max(row.input, input);
      row.resolved = std::max(row.resolved, residual(present, resolved.color, resolved.companions, x, y));
    }
  });
  LightSum sum;
  for (const LightSum& row : rows) sum = sum + row;
  return sum;
}

}  // namespace varve
