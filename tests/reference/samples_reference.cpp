#include "reference/samples_reference.h"

#include <cmath>

#include "resolve/sample_weights.h"

namespace varve::reference {
namespace {

bool is_valid(const Present& p, int x, int y) { return p.color.window().contains(x, y) && p.valid.at(x, y) > 0; }

/// Sum of w c and of w over every sample of the picture.
void weigh(const std::vector<Present>& samples, SampleFilter filter, int x, int y, bool positive_only,
           glm::dvec4& color, double& weight) {
  color = glm::dvec4(0), weight = 0;
  for (const Present& p : samples) {
    const Window& w = p.color.window();
    for (int j = w.y0; j < w.y1; ++j)
      for (int i = w.x0; i < w.x1; ++i) {
        const glm::dvec2 from_center = glm::dvec2(i - x, j - y) + *p.jitter;
        const double k = reconstruction_kernel(filter, from_center.x) * reconstruction_kernel(filter, from_center.y);
        if (!is_valid(p, i, j) || (positive_only && k < 0)) continue;
        color += glm::dvec4(p.color.at(i, j)) * k;
        weight += k;
      }
  }
}

}  // namespace

ResolvedPixel resolved_pixel(const std::vector<Present>& samples, SampleFilter filter, int x, int y) {
  ResolvedPixel r;
  const double n = double(samples.size());
  glm::dvec4 sum(0), all(0);
  double count = 0;
  for (const Present& p : samples) {
    all += glm::dvec4(p.color.at(x, y));
    if (is_valid(p, x, y)) sum += glm::dvec4(p.color.at(x, y)), count += 1;
  }
  r.color = count > 0 ? sum / count : all / n;
  if (filter != SampleFilter::none) {
    glm::dvec4 color;
    double weight = 0;
    weigh(samples, filter, x, y, false, color, weight);
    if (weight / n < 0.1) weigh(samples, filter, x, y, true, color, weight);
    r.weight = weight > 0 ? weight / n : 0;
    if (weight > 0) r.color = color / weight;
  }

  // Those with weight and a vector before those with weight, before the rest.
  int best_class = -1;
  double longest = 0, nearest = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Present& p = samples[s];
    const glm::dvec2 v = p.motion.empty() ? glm::dvec2(0) : glm::dvec2(p.motion.at(x, y));
    const bool finite = std::isfinite(v.x) && std::isfinite(v.y);
    double weight = is_valid(p, x, y) ? 1 : 0;
    if (filter != SampleFilter::none)
      weight *= reconstruction_kernel(filter, p.jitter->x) * reconstruction_kernel(filter, p.jitter->y);
    const int own_class = 2 * (weight > 0) + finite;
    const double length = finite ? v.x * v.x + v.y * v.y : 0;
    const double depth = p.depth.empty() ? 0 : double(p.depth.at(x, y));
    const bool wins = own_class != best_class ? own_class > best_class
                      : length != longest     ? length > longest
                                              : depth < nearest;
    if (s > 0 && !wins) continue;
    best_class = own_class, longest = length, nearest = depth;
    r.chosen = s;
  }
  return r;
}

}  // namespace varve::reference
