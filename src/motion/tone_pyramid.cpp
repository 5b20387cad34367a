#include <algorithm>
#include <cmath>
#include <vector>

#include "motion/patch_match.h"

#include <utility>

#include "base/median.h"

namespace varve {
namespace {

double brightness(const glm::vec4& c) { return std::max(0.0, (double(c.x) + double(c.y) + double(c.z)) / 3); }

// Binomial 3x3, edges repeated: takes the worst of aliasing and of pixel locking away.
Plane<float> blurred(const Plane<float>& sharp, Workers& workers) {
  const Window& w = sharp.window();
  Plane<float> soft(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const float* above = sharp.row(std::max(y - 1, w.y0));
    const float* here = sharp.row(y);
    const float* below = sharp.row(std::min(y + 1, w.y1 - 1));
    const auto column = [&](int x) { return above[x] + 2 * here[x] + below[x]; };
    for (int x = 0; x < w.width(); ++x)
      soft.row(y)[x] = (column(std::max(x - 1, 0)) + 2 * column(x) + column(std::min(x + 1, w.width() - 1))) / 16;
  });
  return soft;
}

int half_up(int v) { return v >= 0 ? (v + 1) / 2 : v / 2; }
int half_down(int v) { return v >= 0 ? v / 2 : (v - 1) / 2; }

Plane<float> halved(const Plane<float>& fine, Workers& workers) {
  const Window& w = fine.window();
  const Window half{half_up(w.x0), half_up(w.y0), half_down(w.x1), half_down(w.y1)};
  Plane<float> coarse(half);
  workers.for_rows(half.y0, half.y1, [&](int y) {
    for (int x = half.x0; x < half.x1; ++x)
      coarse.at(x, y) = (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) + fine.at(2 * x, 2 * y + 1) +
                         fine.at(2 * x + 1, 2 * y + 1)) /
                        4;
  });
  return coarse;
}

}  // namespace

double middle_brightness(const Plane<glm::vec4>& color) {
  // A few thousand pixels tell the median well enough.
  const Window& w = color.window();
  const int step = std::max(1, int(std::sqrt(double(w.pixels()) / 10000)));
  std::vector<double> positive;
  for (int y = w.y0; y < w.y1; y += step)
    for (int x = w.x0; x < w.x1; x += step)
      if (const double b = brightness(color.at(x, y)); b > 0) positive.push_back(b);
  return upper_median(std::move(positive), 1.0);
}

TonePyramid tone_pyramid(const Plane<glm::vec4>& color, double middle, Workers& workers, std::size_t levels) {
  const Window& w = color.window();
  Plane<float> tone(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = 0; x < w.width(); ++x) {
      const double b = brightness(color.row(y)[x]);
      tone.row(y)[x] = float(b / (b + middle));
    }
  });
  TonePyramid pyramid;
  pyramid.levels.push_back(blurred(tone, workers));
  while (pyramid.levels.size() < levels &&
         std::min(pyramid.levels.back().window().width(), pyramid.levels.back().window().height()) >= 80)
    pyramid.levels.push_back(halved(pyramid.levels.back(), workers));
  return pyramid;
}

}  // namespace varve
