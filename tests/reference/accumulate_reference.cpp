#include "reference/accumulate_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/reject.h"
#include "reference/reject_reference.h"
#include "resolve/sample_weights.h"

namespace varve::reference {
namespace {

Color color_of(const glm::vec4& c) { return {c.r, c.g, c.b, c.a}; }

/// Keys' cubic with a = -1/2, as a function of the distance.
double keys(double t) {
  t = std::abs(t);
  if (t < 1) return 1.5 * t * t * t - 2.5 * t * t + 1;
  if (t < 2) return -0.5 * t * t * t + 2.5 * t * t - 4 * t + 2;
  return 0;
}

struct Fetched {
  Color color{};
  double total = 0, spread = 0;
  unsigned reject = 0;
};

/// The history as it is stored, or as nothing has rounded it.
struct Past {
  const History& stored;
  const ExactHistory* exact;
  double color(int x, int y, std::size_t k) const {
    return exact ? exact->color.at(x, y)[int(k)] : double(stored.color.at(x, y)[int(k)]);
  }
  double total(int x, int y) const { return exact ? exact->total.at(x, y) : double(stored.total.at(x, y)); }
  double spread(int x, int y) const { return exact ? exact->spread.at(x, y) : double(stored.spread.at(x, y)); }
  bool valid(int x, int y) const { return stored.color.window().contains(x, y) && total(x, y) > 0; }
};

bool same_surface(float a, float b, double tolerance) {
  return a == b || std::abs(double(a) - double(b)) <= tolerance * std::min(double(a), double(b));
}

/// History at a position given in pixel centres (integer at a centre).
Fetched fetch(const Past& past, const Present& present, const RecursiveParameters& p, int x, int y) {
  Fetched f;
  const History& h = past.stored;
  const glm::vec2 motion = present.motion.empty() ? glm::vec2(0.0f) : present.motion.at(x, y);
  if (!std::isfinite(motion.x) || !std::isfinite(motion.y)) {
    f.reject = kRejectVector;
    return f;
  }
  const double px = x + double(motion.x), py = y + double(motion.y);
  const Window& w = h.color.window();
  if (px < w.x0 - 0.5 || py < w.y0 - 0.5 || px > w.x1 - 0.5 || py > w.y1 - 0.5) {
    f.reject = kRejectWindow;
    return f;
  }
  const int bx = int(std::floor(px)), by = int(std::floor(py));
  const double fx = px - bx, fy = py - by;

  // The four around the position, each on its own merits.
  const bool judged_later = p.reject.depth_slope > 0 || p.reject.on_reject == OnReject::weight;
  const bool test_depth =
      p.disocclusion == Disocclusion::depth && !judged_later && !present.depth.empty() && !h.depth.empty();
  double share = 0, youngest = std::numeric_limits<double>::infinity(), heaviest = 0;
  Color mean{};
  bool all = true, depth_failed = false;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
      if (weight <= 0) continue;
      bool good = past.valid(bx + i, by + j);
      if (good && test_depth && !same_surface(h.depth.at(bx + i, by + j), present.depth.at(x, y), p.depth_tolerance)) {
        good = false;
        depth_failed = true;
      }
      if (!good) {
        all = false;
        continue;
      }
      share += weight;
      youngest = std::min(youngest, past.total(bx + i, by + j));
      if (weight > heaviest) heaviest = weight, f.spread = past.spread(bx + i, by + j);
      for (std::size_t k = 0; k < 4; ++k) mean[k] += weight * past.color(bx + i, by + j, k);
    }
  if (share < 0.25) {
    f.reject = depth_failed ? kRejectDepth : kRejectEmptyHistory;
    f.spread = 0;
    return f;
  }
  f.total = youngest;
  for (std::size_t k = 0; k < 4; ++k) f.color[k] = mean[k] / share;

  // Wider filters need all sixteen.
  bool sixteen = all && bx - 1 >= w.x0 && bx + 2 < w.x1 && by - 1 >= w.y0 && by + 2 < w.y1;
  for (int j = -1; sixteen && j <= 2; ++j)
    for (int i = -1; i <= 2; ++i) sixteen = sixteen && past.valid(bx + i, by + j);
  if (!sixteen || p.history_filter == HistoryFilter::bilinear) return f;

  double weights = 0;
  Color sum{};
  for (int j = -1; j <= 2; ++j)
    for (int i = -1; i <= 2; ++i) {
      const bool corner = (i == -1 || i == 2) && (j == -1 || j == 2);
      if (corner && p.history_filter == HistoryFilter::catmull_rom5) continue;
      const double weight = keys(i - fx) * keys(j - fy);
      weights += weight;
      for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * past.color(bx + i, by + j, k);
    }
  for (std::size_t k = 0; k < 4; ++k) {
    f.color[k] = sum[k] / weights;
    if (!p.dering && k < 3) continue;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const double tap = past.color(bx + i, by + j, k);
        low = std::min(low, tap);
        high = std::max(high, tap);
      }
    f.color[k] = std::clamp(f.color[k], low, high);
  }
  return f;
}

/// What the tests leave of a fetched history; returns its trust.
double judge_history(Fetched& past, const Present& present, const History& previous, const RecursiveParameters& p,
                     int x, int y) {
  if (past.total <= 0) return 0;
  const Judged judged = judge(present, previous, p, x, y);
  if (judged.replaced) past.color = judged.color, past.total = judged.total, past.spread = judged.spread;
  past.reject |= judged.bits;
  if (judged.trust <= 1e-6 && p.reject.on_reject != OnReject::weight) past.total = 0;
  return judged.trust;
}

/// The present at a pixel centre: its own sample, or the weighted samples around (math, section 5).
Color present_at(const Present& present, SampleFilter filter, std::optional<glm::dvec2> jitter, int x, int y,
                 double& weight) {
  weight = present.valid.at(x, y) > 0 ? 1 : 0;
  const Color own = color_of(present.color.at(x, y));
  if (filter == SampleFilter::none || !jitter) return own;
  for (const bool positive : {false, true}) {
    double total = 0;
    Color sum{};
    for (int j = y - 3; j <= y + 3; ++j)
      for (int i = x - 3; i <= x + 3; ++i) {
        if (!present.color.window().contains(i, j) || !(present.valid.at(i, j) > 0)) continue;
        const double w =
            reconstruction_kernel(filter, i + jitter->x - x) * reconstruction_kernel(filter, j + jitter->y - y);
        if (positive && w < 0) continue;
        total += w;
        for (std::size_t k = 0; k < 4; ++k) sum[k] += w * double(present.color.at(i, j)[int(k)]);
      }
    if (total < 0.1 && !positive) continue;
    if (total <= 0) {
      weight = 0;
      return own;
    }
    weight = weight > 0 ? total : 0;
    for (double& s : sum) s /= total;
    return sum;
  }
  return own;
}

}  // namespace

Color weighed_present(const Present& present, SampleFilter filter, std::optional<glm::dvec2> jitter, int x, int y,
                      double& weight) {
  return present_at(present, filter, jitter, x, y, weight);
}

Pixel rectified_history(const Present& present, const History& previous, const RecursiveParameters& p,
                        const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, unsigned restart_bit, int x,
                        int y, Color& fetched, double& trust, const ExactHistory* exact) {
  Pixel out;
  double w = 1;
  const Color now = present_at(present, p.sample_filter, jitter, x, y, w);
  Fetched past;
  if (previous.empty())
    past.reject = restart_bit;
  else
    past = fetch({previous, exact}, present, p, x, y);
  trust = previous.empty() ? 0 : judge_history(past, present, previous, p, x, y);
  out.reject = past.reject | (present.valid.at(x, y) > 0 ? 0u : unsigned(kRejectPresent));
  fetched = past.color;
  if (past.total <= 0) return out;
  if (const auto held = reference::rectify(present, rectify, past.color, now, x, y, true)) {
    past.color = held->color;
    out.clip = held->clip;
    if (rectify.clip_discount && held->distance > 0) {
      const double count = std::min(past.total, (1 - p.alpha) / p.alpha);
      past.total = std::max(1e-30, count / (1 + count * held->distance * held->distance / held->noise));
    }
  }
  out.color = past.color;
  out.total = past.total;
  out.spread = past.spread;
  return out;
}

Pixel accumulate_pixel(const Present& present, const History& previous, const RecursiveParameters& p,
                       const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, unsigned restart_bit, int x,
                       int y, const ExactHistory* exact) {
  Color fetched;
  double trust = 0;
  const Pixel past = rectified_history(present, previous, p, rectify, jitter, restart_bit, x, y, fetched, trust, exact);
  double w = 1;
  const Color now = present_at(present, p.sample_filter, jitter, x, y, w);
  Pixel out = past;
  const bool valid = present.valid.at(x, y) > 0, blurs = p.reject.on_reject == OnReject::blur && !previous.empty();
  if (past.total <= 0) {
    out.color = blurs ? softened(present, x, y) : now;
    out.total = w;
    out.spread = !valid ? 0 : blurs ? 36.0 / 256 : 1;
    return out;
  }
  bool reactive = false;
  double total = past.total;
  const double share =
      weight_of_present(present, p, rectify.gamma, now, fetched, past.color, trust, w, total, reactive, x, y);
  const double a = w > 0 ? share : 0;
  if (reactive) out.reject |= kRejectReactive;
  for (std::size_t k = 0; k < 4; ++k) out.color[k] = (1 - a) * past.color[k] + a * now[k];
  if (p.weight.weighing == Weighing::logarithm && valid)
    for (std::size_t k = 0; k < 3; ++k) out.color[k] = log_blend(past.color[k], now[k], a, p.weight.exposure);
  out.total = total + w;
  out.spread = past.spread * (1 - a) * (1 - a) + a * a;
  out.weight = 1 - a;
  if (!blurs) return out;
  const Color soft = softened(present, x, y);
  for (std::size_t k = 0; k < 4; ++k) out.color[k] = trust * out.color[k] + (1 - trust) * soft[k];
  if (valid) out.spread = trust * trust * out.spread + (1 - trust) * (1 - trust) * 36 / 256;
  return out;
}

Pixel predict_pixel(const Present& present, const History& previous, const RecursiveParameters& p,
                    const RectifyParameters& rectify, int x, int y) {
  Pixel out;
  if (previous.empty()) return out;
  Fetched past = fetch({previous, nullptr}, present, p, x, y);
  judge_history(past, present, previous, p, x, y);
  if (past.total <= 0) return out;
  out.color = past.color;
  out.total = past.total;
  RectifyParameters towards_mean = rectify;
  towards_mean.anchor = BoxAnchor::mean;
  if (towards_mean.moments != WindowMoments::direct) towards_mean.moments = WindowMoments::separable;
  if (const auto held = reference::rectify(present, towards_mean, past.color, {}, x, y, false)) out.color = held->color;
  return out;
}

glm::vec2 dilated_motion(const Plane<glm::vec2>& motion, const Plane<float>& depth, Dilation dilation, int x, int y,
                         bool surfaces_apart) {
  bool surface_near = false;
  for (int j = y - 1; surfaces_apart && j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i)
      if (motion.window().contains(i, j) && std::isfinite(motion.at(i, j).x) && std::isfinite(depth.at(i, j)))
        surface_near = true;
  const auto counts = [&](int i, int j) {
    if (!motion.window().contains(i, j) || !std::isfinite(motion.at(i, j).x)) return false;
    if (!surfaces_apart) return true;
    return std::isfinite(depth.at(i, j)) || (!surface_near && !std::isfinite(depth.at(x, y)));
  };
  glm::vec2 best = motion.at(x, y);
  if (dilation == Dilation::none || (dilation == Dilation::nearest && depth.empty())) return best;
  bool found = counts(x, y);
  double best_length = found ? std::hypot(double(best.x), double(best.y)) : 0;
  double best_depth = found && dilation == Dilation::nearest ? double(depth.at(x, y)) : 0;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i) {
      if (!counts(i, j)) continue;
      const glm::vec2 v = motion.at(i, j);
      const double length = std::hypot(double(v.x), double(v.y));
      const double z = dilation == Dilation::nearest ? double(depth.at(i, j)) : 0;
      if (!found || (dilation == Dilation::longest ? length > best_length : z < best_depth)) {
        best = v;
        best_length = length;
        best_depth = z;
        found = true;
      }
    }
  return best;
}

}  // namespace varve::reference
