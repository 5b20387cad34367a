#include "diagnose/sharpness.h"

#include <algorithm>
#include <limits>

#include "diagnose/row_sums.h"

namespace varve {
namespace {

double tone_mapped(const glm::vec4& color) {
  const double l = std::max(0.0, double(luminance(color)));
  return l / (1 + l);
}

void add_step(Sharpness& sums, const ColorPair& pair, int x, int y, int nx, int ny) {
  if (nx >= pair.window().x1 || ny >= pair.window().y1 || pair.bad.at(x, y) || pair.bad.at(nx, ny)) return;
  const double a = tone_mapped(pair.a.at(nx, ny)) - tone_mapped(pair.a.at(x, y));
  const double b = tone_mapped(pair.b.at(nx, ny)) - tone_mapped(pair.b.at(x, y));
  sums.product += a * b;
  sums.squares += a * a;
}

}  // namespace

double Sharpness::share() const { return squares > 0 ? product / squares : std::numeric_limits<double>::quiet_NaN(); }

Sharpness sharpness_of(const ColorPair& pair, Workers& workers) {
  const Window window = pair.window();
  return sum_rows<Sharpness>(window, workers, [&](int y) {
    Sharpness sums;
    for (int x = window.x0; x < window.x1; ++x) {
      add_step(sums, pair, x, y, x + 1, y);
      add_step(sums, pair, x, y, x, y + 1);
    }
    return sums;
  });
}

}  // namespace varve
