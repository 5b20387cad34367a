#include "diagnose/stuck_detail.h"

#include <cmath>
#include <vector>

namespace varve {
namespace {

constexpr double kMoves = 2;  // px

double detail_at(const Plane<float>& p, int x, int y) {
  return double(p.at(x, y)) -
         (double(p.at(x - 1, y)) + double(p.at(x + 1, y)) + double(p.at(x, y - 1)) + double(p.at(x, y + 1))) / 4;
}

struct Sums {
  double aa = 0, bb = 0, ab = 0;
  std::size_t pixels = 0;
};

}  // namespace

StuckDetail stuck_detail(const Plane<float>& now, const Plane<float>& before, const Plane<glm::vec2>& motion,
                         Workers& workers) {
  if (motion.empty() || now.empty() || before.empty()) return {};
  const Window w = intersect(now.window(), before.window());
  const int y0 = w.y0 + 1, y1 = w.y1 - 1;
  if (w.width() < 3 || y1 <= y0) return {};
  std::vector<Sums> rows(std::size_t(y1 - y0));
  workers.for_rows(y0, y1, [&](int y) {
    Sums& s = rows[std::size_t(y - y0)];
    for (int x = w.x0 + 1; x + 1 < w.x1; ++x) {
      const glm::dvec2 m(motion.at(x, y));
      if (!(m.x * m.x + m.y * m.y >= kMoves * kMoves)) continue;
      const double a = detail_at(now, x, y), b = detail_at(before, x, y);
      if (!(std::isfinite(a) && std::isfinite(b))) continue;
      s.aa += a * a, s.bb += b * b, s.ab += a * b;
      ++s.pixels;
    }
  });
  Sums all;
  for (const Sums& s : rows) all.aa += s.aa, all.bb += s.bb, all.ab += s.ab, all.pixels += s.pixels;
  return {all.aa > 0 && all.bb > 0 ? all.ab / std::sqrt(all.aa * all.bb) : 0, all.pixels};
}

}  // namespace varve
