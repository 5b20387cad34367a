// How much the present counts, pixel by pixel, and what is averaged.
#include <algorithm>
#include <cmath>

#include "resolve/blur_variance.h"
#include "resolve/remainder.h"
#include "resolve/residual.h"
#include "resolve/row_passes.h"

namespace varve {
namespace {

/// Rec. 709.
double luma(const float* c) { return 0.2126 * double(c[0]) + 0.7152 * double(c[1]) + 0.0722 * double(c[2]); }
double luma(const glm::vec4& c) { return luma(&c[0]); }

/// Calls `take(color, valid, weight 1 2 1)` for the 3x3 around (x, y), relative to the window. The border of a present
/// is not valid.
template <class Take>
void for_3x3(const Present& p, int x, int y, Take take) {
  for (int j = -1; j <= 1; ++j) {
    const glm::vec4* color = p.color.row(y + j + p.color.window().y0) + x;
    const float* valid = p.valid.row(y + j + p.color.window().y0) + x;
    for (int i = -1; i <= 1; ++i) take(color[i], valid[i] > 0, (i ? 1.0 : 2.0) * (j ? 1.0 : 2.0));
  }
}

/// Weight of history by agreement of luma (Pedersen 2016): u = |Lh - Lc| / max(Lh, Lc, floor), w = (1 - u)^2. The
/// source's floor is 0.2 of a display's white; here it is 0.2 of the mean |luma| of the 3x3, so that exposure does not
/// matter.
double luma_feedback(const RowPassView& pass, int x, int y, const float* history) {
  const float* present = pass.frame.color.origin + y * pass.frame.color.stride + 4 * x;
  double sum = 0;
  int n = 0;
  for_3x3(pass.present, x, y, [&](const glm::vec4& c, bool valid, double) {
    if (valid) sum += std::abs(luma(c)), ++n;
  });
  const double lh = luma(history), lc = luma(present), scale = n > 0 ? sum / n : 0.0;
  const double most = std::max({std::abs(lh), std::abs(lc), 0.2 * scale});
  const double u = most > 0 ? std::min(std::abs(lh - lc) / most, 1.0) : 0.0;
  const WeightParameters& p = pass.parameters.weight;
  return p.feedback_low + (p.feedback_high - p.feedback_low) * (1 - u) * (1 - u);
}

/// alpha of one pixel before its history's age and trust are looked at.
double alpha_at(const RowPassView& pass, int x, int y, const RowScratch& s, const RowPassScratch& extra) {
  const WeightParameters& p = pass.parameters.weight;
  double alpha = pass.parameters.alpha;
  if (p.feedback == Feedback::luma) alpha = 1 - luma_feedback(pass, x, y, s.history + 4 * x);
  if (p.speed_alpha > alpha) {
    const float* v = pass.frame.motion.origin + y * pass.frame.motion.stride + 2 * x;
    const double speed = std::sqrt(double(v[0]) * double(v[0]) + double(v[1]) * double(v[1]));
    alpha += (p.speed_alpha - alpha) * std::min(1.0, speed / p.full_speed);
  }
  if (p.anti_flicker > 0) alpha *= double(extra.steadiness[x]);
  const Window& w = pass.present.color.window();
  if (!pass.present.responsive.empty())
    alpha = std::min(1.0, alpha * double(pass.present.responsive.at(x + w.x0, y + w.y0)));
  return alpha;
}

/// As the kernel does it: alpha is meant for a sample of weight 1, and the first frames are a plain mean.
double aged(double alpha, AlphaRule rule, double total, double w) {
  const double steady = w == 1 ? alpha : alpha * w / (1 - alpha + alpha * w);
  return rule == AlphaRule::fixed ? steady : std::max(steady, w / (total + w));
}

/// Raises the weight of the present until blur and lag stay within their limits; where they spoke, the history is as
/// old as would give that weight. Notes what becomes of the blur.
void bound_weight(const RowPassView& pass, int x, int y, double& a, double& total) {
  const RecursiveParameters& p = pass.parameters;
  const Window& w = pass.present.color.window();
  const double moment = history_variance(pass, x, y);
  double least = alpha_of_blur(moment, kPixelVariance, p.blur_limit);
  if (!pass.bounds->residual.empty())
    least = std::max(least, alpha_of_residual(double(pass.bounds->residual.at(x + w.x0, y + w.y0)), p.residual_limit));
  if (least > a) {
    a = std::min(1.0, least);
    total = std::max(std::min(total, (1 - a) / a), 1e-6);
  }
  const bool counts = pass.frame.weight.origin[y * pass.frame.weight.stride + x] > 0;
  const double now = counts ? a : 0;  // a pixel that is not valid keeps its history
  pass.bounds->blur->at(x + w.x0, y + w.y0) = float(now * kPixelVariance + (1 - now) * moment);
}

/// Light over 1 + its luma (Karis, the weight of his temporal resolve); negative luma weighs as black.
double karis_weight(double light, double exposure) { return 1 / (1 + std::max(0.0, light * exposure)); }

double signed_log(double v) { return std::copysign(std::log1p(std::abs(v)), v); }
double signed_exp(double v) { return std::copysign(std::expm1(std::abs(v)), v); }

/// Mean of logarithms, zero and negative values included; equal ends stay what they are.
float log_mix(float from, float to, double share, double exposure) {
  if (from == to) return from;
  const double a = signed_log(double(from) * exposure), b = signed_log(double(to) * exposure);
  const double mixed = signed_exp(a + (b - a) * share) / exposure;
  return float(std::clamp(mixed, double(std::min(from, to)), double(std::max(from, to))));
}

}  // namespace

RowPassView row_passes_for(const AccumulateView& frame, const Present& present, const History& previous,
                           const RecursiveParameters& p) {
  RowPassView v{frame, present, previous, p, false, false, false, false};
  if (frame.history_width == 0) return v;
  v.tests_surfaces = (tests_depth_apart(p) && !present.depth.empty() && !previous.depth.empty()) ||
                     (p.reject.normal_angle > 0 && !present.normal.empty() && !previous.normal.empty()) ||
                     (p.reject.id != IdTest::off && !present.id.empty() && !previous.id.empty());
  v.tests_vectors = p.reject.tests_vectors() && !previous.motion.empty();
  const bool tests = v.tests_surfaces || v.tests_vectors;
  v.weighs = tests || p.weight.feedback != Feedback::fixed || p.weight.speed_alpha > 0 || p.weight.anti_flicker > 0 ||
             (p.weight.reactive > 0 && !present.reactive.empty()) || !present.responsive.empty() ||
             p.weight.weighing != Weighing::none || keeps_remainder(p);
  v.finishes = p.weight.weighing == Weighing::logarithm || p.reject.on_reject == OnReject::blur;
  return v;
}

void find_clip_events(const RowPassView& pass, int y, const RowScratch& s, const RowPassScratch& extra) {
  const double strength = pass.parameters.weight.anti_flicker;
  for (int x = 0; x < pass.frame.width; ++x) {
    extra.steadiness[x] = 1;
    if (!(s.total[x] > 0)) continue;
    double sum = 0, m2 = 0;
    int n = 0;
    for_3x3(pass.present, x, y, [&](const glm::vec4& c, bool valid, double) {
      if (valid) sum += luma(c), ++n;
    });
    const double mean = n > 0 ? sum / n : 0.0;
    for_3x3(pass.present, x, y, [&](const glm::vec4& c, bool valid, double) {
      if (valid) m2 += (luma(c) - mean) * (luma(c) - mean);
    });
    const double half = n > 0 ? pass.frame.gamma * std::sqrt(m2 / n) : 0.0, history = luma(s.history + 4 * x);
    const double distance = std::min(std::abs(mean - half - history), std::abs(mean + half - history));
    const double whole = distance + 2 * half;
    // A flat neighborhood with history in it has no wall to be near to: 0/0 in the source.
    if (whole > 0) extra.steadiness[x] = float(1 - strength * (1 - distance / whole));
  }
}

void weigh_present(const RowPassView& pass, int y, const RowScratch& s, const RowPassScratch& extra) {
  const AccumulateView& v = pass.frame;
  const RejectParameters& reject = pass.parameters.reject;
  const WeightParameters& weight = pass.parameters.weight;
  const Window& window = pass.present.color.window();
  const bool tests = pass.tests_surfaces || pass.tests_vectors;
  const double exposure = std::exp2(weight.exposure);
  for (int x = 0; x < v.width; ++x) {
    extra.present_weight[x] = 1;
    if (!(s.total[x] > 0)) {
      if (pass.bounds) pass.bounds->blur->row(y + window.y0)[x] = float(kPixelVariance);
      continue;
    }
    const double w = v.sample_weight.origin ? double(v.sample_weight.origin[y * v.sample_weight.stride + x]) : 1.0;
    double total = double(s.total[x]);
    double a = aged(alpha_at(pass, x, y, s, extra), pass.parameters.alpha_rule, total, w);
    const double trust = tests ? double(extra.trust[x]) : 1.0;
    if (trust < 1) {
      if (reject.on_reject == OnReject::restart) {
        a = 1 - (1 - a) * trust;
        total *= trust;
      } else if (reject.on_reject == OnReject::weight) {
        // As old as would give that weight, so that the frames after go on from there.
        a += (std::max(a, reject.alpha) - a) * (1 - trust);
        total += (std::min(total, (1 - reject.alpha) / reject.alpha) - total) * (1 - trust);
        total = std::max(total, 1e-6);
      }
    }
    if (weight.reactive > 0 && !pass.present.reactive.empty()) {
      const double kept = 1 - weight.reactive * double(pass.present.reactive.at(x + window.x0, y + window.y0));
      a = 1 - (1 - a) * kept;
      if (kept <= 0.5) s.reject[x] |= kRejectReactive;
    }
    if (weight.weighing == Weighing::luminance) {
      const double now = a * karis_weight(luma(v.color.origin + y * v.color.stride + 4 * x), exposure);
      const double then = (1 - a) * karis_weight(luma(s.history + 4 * x), exposure);
      if (now + then > 0) a = now / (now + then);
    }
    if (pass.bounds) bound_weight(pass, x, y, a, total);
    extra.present_weight[x] = a;
    s.total[x] = float(total);
  }
}

glm::dvec4 soft_present(const Present& present, int x, int y) {
  const Window& w = present.color.window();
  const glm::dvec4 own(present.color.at(x + w.x0, y + w.y0));
  glm::dvec4 sum(0.0);
  double weights = 0;
  // Differences are summed, not values: a constant stays that constant.
  for_3x3(present, x, y, [&](const glm::vec4& c, bool valid, double weight) {
    if (valid) sum += (glm::dvec4(c) - own) * weight, weights += weight;
  });
  return weights > 0 ? own + sum / weights : own;
}

void finish_row(const RowPassView& pass, int y, const RowScratch& s, const RowPassScratch& extra) {
  const AccumulateView& v = pass.frame;
  const bool tests = pass.tests_surfaces || pass.tests_vectors;
  const bool logs = pass.parameters.weight.weighing == Weighing::logarithm;
  const bool blurs = pass.parameters.reject.on_reject == OnReject::blur;
  const double exposure = std::exp2(pass.parameters.weight.exposure);
  for (int x = 0; x < v.width; ++x) {
    float* out = v.out_color.origin + y * v.out_color.stride + 4 * x;
    float& spread = v.out_spread.origin[y * v.out_spread.stride + x];
    const bool has_present = v.weight.origin[y * v.weight.stride + x] > 0, has_history = s.total[x] > 0;
    if (logs && has_present && has_history) {
      const float* present = v.color.origin + y * v.color.stride + 4 * x;
      for (int k = 0; k < 3; ++k) out[k] = log_mix(s.history[4 * x + k], present[k], extra.present_weight[x], exposure);
    }
    if (!blurs) continue;
    const double doubt = !has_history ? 1.0 : tests ? 1 - double(extra.trust[x]) : 0.0;
    if (!(doubt > 0)) continue;
    const glm::dvec4 soft = soft_present(pass.present, x, y);
    for (int k = 0; k < 4; ++k) out[k] = float(double(out[k]) + (soft[k] - double(out[k])) * doubt);
    // The weights 1 2 1 over nine samples have squares that sum to (6/16)^2.
    if (has_present) spread = float(double(spread) * (1 - doubt) * (1 - doubt) + 0.140625 * doubt * doubt);
  }
}

}  // namespace varve
