#include "reference/subpixel_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace varve::reference {
namespace {

struct Sample {
  glm::dvec2 place, center;
  double tent = 0, weight = 0;
  const SubpixelBuffer* buffer = nullptr;
  int x = 0, y = 0;
};

bool is_same_surface(const SubpixelBuffer& q, const Present& p, const RecursiveParameters& r, int qx, int qy, int x,
                     int y) {
  if (r.disocclusion == Disocclusion::depth && !q.depth.empty() && !p.depth.empty()) {
    const double a = double(q.depth.at(qx, qy)), b = double(p.depth.at(x, y));
    if (!(a == b) && !(std::abs(a - b) <= r.depth_tolerance * std::min(a, b))) return false;
  }
  if (r.reject.id != IdTest::off && !q.id.empty() && !p.id.empty() && q.id.at(qx, qy) != p.id.at(x, y)) return false;
  if (r.reject.normal_angle > 0 && !q.normal.empty() && !p.normal.empty()) {
    const glm::dvec3 a(q.normal.at(qx, qy)), b(p.normal.at(x, y));
    const bool known = a != glm::dvec3(0.0) && b != glm::dvec3(0.0);
    const double cosine = a.x * b.x + a.y * b.y + a.z * b.z;
    if (known && cosine < std::cos(r.reject.normal_angle * 3.14159265358979323846 / 180) - 1e-6) return false;
  }
  return true;
}

/// Solves m c = (1, 0, 0, ...) by Gauss and Jordan; false where it is singular.
using Matrix = std::array<std::array<double, 3>, 3>;
bool first_unit_solution(Matrix m, std::array<double, 3>& c) {
  constexpr std::size_t n = 3;
  c = {1, 0, 0};
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k; r < n; ++r)
      if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
    if (std::abs(m[pivot][k]) < 1e-300) return false;
    std::swap(m[k], m[pivot]);
    std::swap(c[k], c[pivot]);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == k) continue;
      const double f = m[r][k] / m[k][k];
      for (std::size_t i = 0; i < n; ++i) m[r][i] -= f * m[k][i];
      c[r] -= f * c[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) c[k] /= m[k][k];
  return true;
}

/// First-order weights by the normal equations of a weighted fit of a plane.
bool fit_plane(std::vector<Sample>& samples) {
  double xx = 0, xy = 0, yy = 0, w = 0;
  Matrix m{};
  for (const Sample& s : samples) {
    const double b[3] = {1, s.center.x, s.center.y};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t k = 0; k < 3; ++k) m[r][k] += s.tent * b[r] * b[k];
    xx += s.tent * b[1] * b[1], xy += s.tent * b[1] * b[2], yy += s.tent * b[2] * b[2], w += s.tent;
  }
  if (!((xx * yy - xy * xy) * 1e6 > (xx + yy) * (xx + yy))) return false;
  std::array<double, 3> c{};
  if (!first_unit_solution(m, c) || !(c[0] > 0 && c[0] * w < 1e6)) return false;
  double gain = 0;
  for (Sample& s : samples) {
    s.weight = s.tent * (c[0] + c[1] * s.center.x + c[2] * s.center.y);
    gain += std::abs(s.weight);
  }
  return gain <= 1.5;
}

/// Tents of growing width until the weights are well determined.
bool weigh(std::vector<Sample>& samples, const SubpixelParameters& p) {
  const bool corrects = p.weights == SubpixelWeights::first_order;
  double radius = p.weights == SubpixelWeights::bilinear ? 1 : p.radius;
  while (true) {
    double sum = 0;
    glm::dvec2 center(0.0);
    for (Sample& s : samples) {
      s.tent = std::max(0.0, 1 - std::abs(s.place.x) / radius) * std::max(0.0, 1 - std::abs(s.place.y) / radius);
      sum += s.tent;
      center += s.center * s.tent;
    }
    const bool centered = std::abs(center.x) <= 0.05 * sum && std::abs(center.y) <= 0.05 * sum;
    if (sum > 0 && corrects && !centered && fit_plane(samples)) return true;
    if (sum > 0 && (!corrects || centered || radius >= 1)) {
      for (Sample& s : samples) s.weight = s.tent / sum;
      return true;
    }
    if (radius >= 1) return false;
    radius = std::min(1.0, radius + 0.125);
  }
}

}  // namespace

QuarterPixel reconstructed_quarter(const SubpixelHistory& history, const Present& present,
                                   const SubpixelParameters& subpixel, const RecursiveParameters& recursive,
                                   std::size_t target, int x, int y) {
  std::vector<Sample> samples;
  double share = 0;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const SubpixelBuffer& q = history.quadrants[k];
    if (q.empty()) continue;
    const glm::dvec2 way = q.way.empty() ? glm::dvec2(0.0) : glm::dvec2(q.way.at(x, y));
    if (!(way.x * way.x + way.y * way.y <= 1e18)) continue;
    const glm::dvec2 at = glm::dvec2(x, y) + kQuadrantMiddle[target] + way - kQuadrantMiddle[k];
    const Window& w = q.color.window();
    for (int qy = w.y0; qy < w.y1; ++qy)
      for (int qx = w.x0; qx < w.x1; ++qx) {
        const glm::dvec2 d = glm::dvec2(qx, qy) - at;
        const double near = (1 - std::abs(d.x)) * (1 - std::abs(d.y));
        if (!(std::abs(d.x) < 1 && std::abs(d.y) < 1)) continue;
        if (!(q.total.at(qx, qy) > 0) || !is_same_surface(q, present, recursive, qx, qy, x, y)) continue;
        share += near;
        Sample s;
        s.place = s.center = d;
        if (subpixel.weights == SubpixelWeights::first_order) s.center += glm::dvec2(q.moments.at(qx, qy));
        s.buffer = &q, s.x = qx, s.y = qy;
        samples.push_back(s);
      }
  }
  QuarterPixel out;
  if (share < 0.25 || !weigh(samples, subpixel)) return out;
  out.known = true;
  double tents = 0;
  for (const Sample& s : samples) {
    const glm::dvec3 m(s.buffer->moments.at(s.x, s.y));
    out.color += glm::dvec4(s.buffer->color.at(s.x, s.y)) * s.weight;
    out.total += s.tent * double(s.buffer->total.at(s.x, s.y));
    out.spread += s.tent * double(s.buffer->spread.at(s.x, s.y));
    tents += s.tent;
    const glm::dvec2 d = s.place;
    out.moments +=
        glm::dvec3(m.x + d.x, m.y + d.y, m.z + d.x * m.x + d.y * m.y + (d.x * d.x + d.y * d.y) / 2) * s.weight;
  }
  for (const Sample& s : samples) {
    const double part = s.tent / tents;
    const std::size_t from = std::size_t(s.buffer - history.quadrants.data());
    out.by_history[from] +=
        part * glm::dvec3(1, double(s.buffer->total.at(s.x, s.y)), double(s.buffer->spread.at(s.x, s.y)));
  }
  out.total /= tents;
  out.spread /= tents;
  out.moments.z = std::max(0.0, out.moments.z);
  return out;
}

QuarterPixel blended_quarter(const QuarterPixel& before, const Present& present, const RecursiveParameters& recursive,
                             std::size_t target, int x, int y) {
  const bool valid = present.valid.at(x, y) > 0;
  if (before.known && !valid) return before;
  const glm::dvec2 e = *present.jitter - kQuadrantMiddle[target];
  const glm::dvec3 own(e.x, e.y, (e.x * e.x + e.y * e.y) / 2);
  const glm::dvec4 sample(present.color.at(x, y));
  if (!before.known) return {valid, sample, valid ? 1.0 : 0.0, valid ? 1.0 : 0.0, own};
  const double a =
      recursive.alpha_rule == AlphaRule::fixed ? recursive.alpha : std::max(recursive.alpha, 1 / (before.total + 1));
  return {true, sample * a + before.color * (1 - a), before.total + 1, before.spread * (1 - a) * (1 - a) + a * a,
          own * a + before.moments * (1 - a)};
}

QuarterPixel picture_pixel(const SubpixelHistory& history, const Present& present, const SubpixelParameters& subpixel,
                           const RecursiveParameters& recursive, int x, int y) {
  QuarterPixel out;
  double n = 0;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    const SubpixelBuffer& q = history.quadrants[k];
    QuarterPixel quarter;
    if (!q.empty() && q.way.empty() && q.total.at(x, y) > 0)
      quarter = {true, glm::dvec4(q.color.at(x, y)), double(q.total.at(x, y)), double(q.spread.at(x, y)),
                 glm::dvec3(q.moments.at(x, y))},
      quarter.by_history[k] = glm::dvec3(1, quarter.total, quarter.spread);
    else
      quarter = reconstructed_quarter(history, present, subpixel, recursive, k, x, y);
    if (!quarter.known) continue;
    const glm::dvec2 m = kQuadrantMiddle[k];
    out.known = true;
    out.color += quarter.color;
    for (std::size_t j = 0; j < kQuadrants; ++j) out.by_history[j] += quarter.by_history[j];
    out.moments.z +=
        quarter.moments.z + m.x * quarter.moments.x + m.y * quarter.moments.y + (m.x * m.x + m.y * m.y) / 2;
    n += 1;
  }
  if (!out.known) return {false, glm::dvec4(present.color.at(x, y)), 0, 0, glm::dvec3(0.0)};
  out.color /= n;
  // A history that stands in for several quarters is one set of samples, however often it is shown.
  for (const glm::dvec3& h : out.by_history) {
    out.total += h.x > 1 ? h.y / h.x : h.y;
    out.spread += h.x / n * h.z / n;
  }
  out.moments.z /= n;
  return out;
}

}  // namespace varve::reference
