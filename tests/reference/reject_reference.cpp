#include "reference/reject_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/reject.h"

namespace varve::reference {
namespace {

double luma_of(const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }
Color color_of(const glm::vec4& c) { return {c.r, c.g, c.b, c.a}; }

/// Lumas of the valid pixels of the 3x3.
std::vector<double> lumas(const Present& present, int x, int y) {
  std::vector<double> all;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i)
      if (present.color.window().contains(i, j) && present.valid.at(i, j) > 0)
        all.push_back(luma_of(color_of(present.color.at(i, j))));
  return all;
}

double slope_along(const Plane<float>& depth, int x, int y, int dx, int dy) {
  std::vector<double> steps;
  const double z = double(depth.at(x, y));
  if (depth.window().contains(x - dx, y - dy)) steps.push_back(z - double(depth.at(x - dx, y - dy)));
  if (depth.window().contains(x + dx, y + dy)) steps.push_back(double(depth.at(x + dx, y + dy)) - z);
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const double s : steps) {
    if (std::isnan(s)) return 0;
    least = std::min(least, std::abs(s));
    most = std::max(most, std::abs(s));
  }
  if (steps.size() == 2 && steps[0] * steps[1] < 0 && least / most > 0.5) return 0;
  return std::isfinite(least) ? least : 0;
}

double degrees_between(double dot, double lengths) {
  return std::acos(std::clamp(dot / lengths, -1.0, 1.0)) * 180 / 3.14159265358979323846;
}

}  // namespace

Judged judge(const Present& present, const History& h, const RecursiveParameters& p, int x, int y) {
  Judged out;
  const Window& w = h.color.window();
  const glm::vec2 motion = present.motion.empty() ? glm::vec2(0.0f) : present.motion.at(x, y);
  const double px = x + double(motion.x), py = y + double(motion.y);
  const int bx = int(std::floor(px)), by = int(std::floor(py));

  // Surfaces.
  const bool depth = p.disocclusion == Disocclusion::depth &&
                     (p.reject.depth_slope > 0 || p.reject.on_reject == OnReject::weight) && !h.depth.empty();
  double all = 0, good = 0, same_id = 0, heaviest = 0;
  unsigned failed_bits = 0;
  out.total = std::numeric_limits<double>::infinity();
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? px - bx : 1 - (px - bx)) * (j ? py - by : 1 - (py - by));
      const int hx = bx + i, hy = by + j;
      if (weight <= 0 || !w.contains(hx, hy) || h.total.at(hx, hy) <= 0) continue;
      unsigned failed = 0;
      if (depth) {
        const double a = double(present.depth.at(x, y)), b = double(h.depth.at(hx, hy));
        const double slope = slope_along(present.depth, x, y, 1, 0) + slope_along(present.depth, x, y, 0, 1);
        if (a != b && !(std::abs(a - b) <= p.depth_tolerance * std::min(a, b) + p.reject.depth_slope * slope))
          failed |= kRejectDepth;
      }
      if (p.reject.normal_angle > 0 && !h.normal.empty()) {
        const glm::dvec3 m(present.normal.at(x, y)), n(h.normal.at(hx, hy));
        const double lengths = std::sqrt((m.x * m.x + m.y * m.y + m.z * m.z) * (n.x * n.x + n.y * n.y + n.z * n.z));
        if (lengths > 0 && degrees_between(m.x * n.x + m.y * n.y + m.z * n.z, lengths) > p.reject.normal_angle)
          failed |= kRejectNormal;
      }
      const bool same = p.reject.id == IdTest::off || h.id.empty() || h.id.at(hx, hy) == present.id.at(x, y);
      all += weight;
      if (same) same_id += weight;
      if (!same && p.reject.id == IdTest::hard) failed |= kRejectId;
      failed_bits |= failed;
      if (failed) continue;
      good += weight;
      out.total = std::min(out.total, double(h.total.at(hx, hy)));
      if (weight > heaviest) heaviest = weight, out.spread = h.spread.at(hx, hy);
      for (std::size_t k = 0; k < 4; ++k) out.color[k] += weight * double(h.color.at(hx, hy)[int(k)]);
    }
  for (double& c : out.color) c /= good > 0 ? good : 1;
  out.replaced = failed_bits != 0 && good >= 0.25;
  if (failed_bits != 0 && good < 0.25) out.trust = 0, out.bits |= failed_bits;
  if (p.reject.id == IdTest::soft && all > 0) {
    out.trust *= same_id / all;
    if (same_id / all <= 0.5) out.bits |= kRejectId;
  }

  // Vectors.
  if (h.motion.empty()) return out;
  const int nx = std::clamp(int(std::floor(px + 0.5)), w.x0, w.x1 - 1);
  const int ny = std::clamp(int(std::floor(py + 0.5)), w.y0, w.y1 - 1);
  const glm::dvec2 u(h.motion.at(nx, ny)), v(motion);
  if (!std::isfinite(u.x) || !std::isfinite(u.y)) return out;
  const double lu = std::hypot(u.x, u.y), lv = std::hypot(v.x, v.y);
  if (p.reject.speed > 0 && std::abs(lu - lv) > p.reject.speed) out.trust = 0, out.bits |= kRejectSpeed;
  if (p.reject.direction > 0 && lu >= 0.5 && lv >= 0.5 &&
      degrees_between(u.x * v.x + u.y * v.y, lu * lv) > p.reject.direction)
    out.trust = 0, out.bits |= kRejectDirection;
  if (p.reject.acceleration > 0) {
    const double low = std::min(p.reject.acceleration_low, p.reject.acceleration), d = std::hypot(u.x - v.x, u.y - v.y);
    const double t = d >= p.reject.acceleration ? 0
                     : d <= low                 ? 1
                                                : (p.reject.acceleration - d) / (p.reject.acceleration - low);
    out.trust *= t;
    if (t <= 0.5) out.bits |= kRejectAcceleration;
  }
  return out;
}

double weight_of_present(const Present& present, const RecursiveParameters& p, double gamma, const Color& now,
                         const Color& fetched, const Color& history, double trust, double w, double& total,
                         bool& reactive, int x, int y) {
  double alpha = p.alpha;
  const std::vector<double> around = lumas(present, x, y);
  double mean = 0, mean_size = 0, variance = 0;
  for (const double l : around) mean += l / double(around.size()), mean_size += std::abs(l) / double(around.size());
  for (const double l : around) variance += (l - mean) * (l - mean) / double(around.size());
  if (p.weight.feedback == Feedback::luma) {
    const double lh = luma_of(history), lc = luma_of(now);
    const double most = std::max({std::abs(lh), std::abs(lc), 0.2 * mean_size});
    const double u = most > 0 ? std::min(1.0, std::abs(lh - lc) / most) : 0;
    alpha = 1 - (p.weight.feedback_low + (p.weight.feedback_high - p.weight.feedback_low) * (1 - u) * (1 - u));
  }
  if (p.weight.speed_alpha > alpha && !present.motion.empty()) {
    const glm::dvec2 v(present.motion.at(x, y));
    alpha += (p.weight.speed_alpha - alpha) * std::min(1.0, std::hypot(v.x, v.y) / p.weight.full_speed);
  }
  if (p.weight.anti_flicker > 0) {
    const double half = gamma * std::sqrt(variance), l = luma_of(fetched);
    const double d = std::min(std::abs(mean - half - l), std::abs(mean + half - l));
    if (d + 2 * half > 0) alpha *= 1 - p.weight.anti_flicker * (1 - d / (d + 2 * half));
  }
  if (!present.responsive.empty()) alpha = std::min(1.0, alpha * double(present.responsive.at(x, y)));

  double a = alpha * w / (1 - alpha + alpha * w);
  if (p.alpha_rule == AlphaRule::mean) a = std::max(a, w / (total + w));
  if (p.reject.on_reject == OnReject::restart && trust < 1) {
    a = 1 - (1 - a) * trust;
    total *= trust;
  }
  if (p.reject.on_reject == OnReject::weight && trust < 1) {
    a = trust * a + (1 - trust) * std::max(a, p.reject.alpha);
    total = trust * total + (1 - trust) * std::min(total, (1 - p.reject.alpha) / p.reject.alpha);
    total = std::max(total, 1e-6);
  }
  if (!present.reactive.empty() && p.weight.reactive > 0) {
    const double taken = p.weight.reactive * double(present.reactive.at(x, y));
    a = 1 - (1 - a) * (1 - taken);
    reactive = taken >= 0.5;
  }
  if (p.weight.weighing == Weighing::luminance) {
    const double e = std::exp2(p.weight.exposure);
    const double n = a / (1 + std::max(0.0, e * luma_of(now)));
    const double t = (1 - a) / (1 + std::max(0.0, e * luma_of(history)));
    a = n / (n + t);
  }
  return a;
}

double log_blend(double history, double present, double share, double exposure) {
  const double e = std::exp2(exposure);
  const auto to = [&](double v) { return v < 0 ? -std::log1p(-v * e) : std::log1p(v * e); };
  const double mixed = (1 - share) * to(history) + share * to(present);
  return (mixed < 0 ? -std::expm1(-mixed) : std::expm1(mixed)) / e;
}

Color softened(const Present& present, int x, int y) {
  Color sum{};
  double weights = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (!present.color.window().contains(x + i, y + j) || !(present.valid.at(x + i, y + j) > 0)) continue;
      const double weight = (2 - std::abs(i)) * (2 - std::abs(j));
      weights += weight;
      for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * double(present.color.at(x + i, y + j)[int(k)]);
    }
  if (weights == 0) return color_of(present.color.at(x, y));
  for (double& s : sum) s /= weights;
  return sum;
}

}  // namespace varve::reference
