#include "vector_residual_reference.h"

#include <algorithm>
#include <cmath>

namespace varve::reference {
namespace {

/// A power of two near the geometric mean of the light above 0 of both frames.
double middle_of(const Plane<float>& a, const Plane<float>& b) {
  double sum = 0, count = 0;
  for (const Plane<float>* plane : {&a, &b})
    for (int y = plane->window().y0; y < plane->window().y1; ++y)
      for (int x = plane->window().x0; x < plane->window().x1; ++x)
        if (plane->at(x, y) > 0) sum += std::floor(std::log2(double(plane->at(x, y)))), ++count;
  return count > 0 ? std::exp2(std::floor(sum / count)) : 1;
}

bool near(double a, double b, double tolerance) { return a == b || std::fabs(a - b) <= tolerance * std::min(a, b); }

bool inside(const SeenFrame& here, int x, int y) {
  const Window& w = here.light->window();
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (!w.contains(x + i, y + j)) return false;
      if (here.id && here.id->at(x + i, y + j) != here.id->at(x, y)) return false;
      if (here.depth && !near(double(here.depth->at(x + i, y + j)), double(here.depth->at(x, y)), 0.1)) return false;
    }
  return true;
}

}  // namespace

Judged judge_vector(const SeenFrame& here, const SeenFrame& there, double depth_tolerance, int x, int y,
                    glm::vec2 vector, const Plane<glm::vec2>& back, double doubt) {
  if (!(vector.x == vector.x)) return {0, VectorVerdict::wrong};
  const bool ids = here.id && there.id, depths = here.depth && there.depth;
  const double m = middle_of(*here.light, *there.light);
  const auto toned = [&](double light) { return light / (light + m); };
  const int u = int(std::floor(x + 0.5 + double(vector.x) + (here.jitter.x - there.jitter.x)));
  const int v = int(std::floor(y + 0.5 + double(vector.y) + (here.jitter.y - there.jitter.y)));
  const Window& w = there.light->window();
  if (!w.contains(u, v)) return {0, VectorVerdict::untestable};
  bool same = false, hidden = false;
  double low = 1, high = 0;
  for (int j = v - 1; j <= v + 1; ++j)
    for (int i = u - 1; i <= u + 1; ++i) {
      if (!w.contains(i, j)) continue;
      low = std::min(low, toned(double(there.light->at(i, j))));
      high = std::max(high, toned(double(there.light->at(i, j))));
      const double own = depths ? double(here.depth->at(x, y)) : 0, other = depths ? double(there.depth->at(i, j)) : 0;
      const bool is_same = ids      ? here.id->at(x, y) == there.id->at(i, j)
                           : depths ? near(own, other, depth_tolerance)
                                    : true;
      same = same || is_same;
      hidden = hidden || (!is_same && depths && other < own);
    }
  if (!same && hidden) return {0, VectorVerdict::untestable};
  if (!same && !depths) return {1, VectorVerdict::untestable};
  if (!same) return {1, inside(here, x, y) ? VectorVerdict::wrong : VectorVerdict::doubtful};
  const double light = toned(double(here.light->at(x, y)));
  const double residual = std::max({0.0, light - high, low - light});
  bool one_way = false;
  if (!back.empty() && back.window().contains(u, v)) {
    const glm::dvec2 a(vector), b(back.at(u, v));
    const double miss = std::hypot(a.x + b.x, a.y + b.y), lengths = std::hypot(a.x, a.y, std::hypot(b.x, b.y));
    one_way = miss * miss > 0.25 * 0.25 + 0.01 * 0.01 * lengths * lengths;
  }
  return {residual, residual > doubt || one_way ? VectorVerdict::doubtful : VectorVerdict::trusted};
}

}  // namespace varve::reference
