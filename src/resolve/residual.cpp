#include "resolve/residual.h"

#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

namespace varve {

glm::vec4 difference_to(const glm::vec4& present, const glm::vec4& history) {
  // Halved, so that neither end of the range of float is left.
  glm::vec4 d(0.0f);
  for (int k = 0; k < 3; ++k) {
    d[k] = present[k] * 0.5f - history[k] * 0.5f;
    d.a = std::max({d.a, std::abs(present[k]) * 0.5f, std::abs(history[k]) * 0.5f});
  }
  return d;
}

Plane<float> residual_of(const Plane<glm::vec4>& differences, int window, Workers& workers) {
  const Window& w = differences.window();
  Plane<float> out(w);
  const int r = window / 2;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::dvec4 sum(0.0);
      for (int j = std::max(w.y0, y - r); j < std::min(w.y1, y + r + 1); ++j)
        for (int i = std::max(w.x0, x - r); i < std::min(w.x1, x + r + 1); ++i) sum += glm::dvec4(differences.at(i, j));
      const double change = std::max({std::abs(sum.r), std::abs(sum.g), std::abs(sum.b)});
      out.at(x, y) = sum.a > 0 ? float(change / sum.a) : 0.0f;
    }
  });
  return out;
}

double alpha_of_residual(double residual, double limit) {
  return limit > 0 && residual > limit ? 1 - limit / residual : 0;
}

double alpha_of_blur(double moment, double own, double limit) {
  if (!(limit > 0) || !(moment > limit)) return 0;
  return limit > own ? (moment - limit) / (moment - own) : 1;
}

}  // namespace varve
