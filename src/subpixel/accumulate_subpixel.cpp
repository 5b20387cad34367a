#include "subpixel/accumulate_subpixel.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/held_float.h"
#include "base/reject.h"
#include "resolve/accumulate_row.h"
#include "resolve/residual.h"
#include "subpixel/blur_table.h"
#include "subpixel/carry_way.h"
#include "subpixel/reconstruct.h"
#include "subpixel/show_subpixel.h"

namespace varve {
namespace {

/// What is the same for all pixels of a sample.
struct Update {
  const SubpixelHistory& history;
  const Present& present;
  const SubpixelParameters& subpixel;
  const RecursiveParameters& recursive;
  std::size_t quadrant;
  std::uint32_t restart_bit;
  const BlurTable* table;  ///< null: blur is bounded as it is tracked, or not at all
};

/// What a sample meets.
struct Prediction {
  SubpixelBuffer quarter;        ///< becomes the new history
  Plane<float> carried;          ///< px^2 that carrying it here has added; empty where blur is not bounded
  Plane<glm::vec4> differences;  ///< see difference_to(); empty where the residual is not asked for
};

SubpixelBuffer make_buffer(const Present& present) {
  const Window& w = present.color.window();
  SubpixelBuffer q;
  q.color = Plane<glm::vec4>(w);
  for (std::size_t i = 0; i < present.companions.size(); ++i) q.companions.emplace_back(w);
  q.total = Plane<float>(w);
  q.spread = Plane<float>(w);
  q.moments = Plane<glm::vec3>(w);
  return q;
}

/// What the histories say of a pixel's quarter, into `to`; total 0 where nothing. Gives back the reject bits.
unsigned predict_quarter(const Update& u, int x, int y, Prediction& prediction) {
  SubpixelBuffer& to = prediction.quarter;
  to.total.at(x, y) = 0;
  if (u.history.empty()) return u.restart_bit;
  const SubpixelBuffer& own = u.history.quadrants[u.quadrant];
  if (!own.empty() && own.way.empty()) {  // it has a sample of this frame already: nothing moves
    to.color.at(x, y) = own.color.at(x, y);
    for (std::size_t i = 0; i < to.companions.size(); ++i) to.companions[i].at(x, y) = own.companions[i].at(x, y);
    to.total.at(x, y) = own.total.at(x, y);
    to.spread.at(x, y) = own.spread.at(x, y);
    to.moments.at(x, y) = own.moments.at(x, y);
    return own.total.at(x, y) > 0 ? 0u : unsigned(kRejectEmptyHistory);
  }
  const Reconstruction r = reconstruct(u.history, u.present, u.subpixel, u.recursive, u.quadrant, x, y);
  if (!r.found) return r.reject;
  to.color.at(x, y) = held_color(
      weighed_color(u.history, r, [](const SubpixelBuffer& q) -> const Plane<glm::vec4>& { return q.color; }));
  for (std::size_t i = 0; i < to.companions.size(); ++i)
    to.companions[i].at(x, y) = held_color(weighed_color(
        u.history, r, [i](const SubpixelBuffer& q) -> const Plane<glm::vec4>& { return q.companions[i]; }));
  const ReconstructedWeights w = weighed_history(u.history, r);
  to.total.at(x, y) = float(w.total);
  to.spread.at(x, y) = float(w.spread);
  to.moments.at(x, y) = glm::vec3(w.moments);
  if (!prediction.carried.empty()) prediction.carried.at(x, y) = float(w.carried);
  return 0;
}

/// Fills `prediction` with what the histories say, rectified.
AccumulateCounts predict_all(const Update& u, const RectifyParameters& rectify, const DiagnosticsWanted& wanted,
                             Prediction& prediction, AccumulateDiagnostics& diagnostics, Workers& workers) {
  SubpixelBuffer& to = prediction.quarter;
  Plane<glm::vec4>& differences = prediction.differences;
  const Window& w = u.present.color.window();
  RecursiveParameters plain = u.recursive;  // samples are tested here, one by one
  plain.disocclusion = Disocclusion::window;
  plain.reject = {};
  plain.sample_filter = SampleFilter::none;
  plain.unjitter = Unjitter::none;
  std::vector<std::size_t> restarted(std::size_t(workers.count())), bad(restarted);
  const auto fetch = [&](const AccumulateView& v, int row, const RowScratch& s, int worker) {
    const int y = w.y0 + row;
    for (int x = 0; x < v.width; ++x) {
      unsigned reject = predict_quarter(u, w.x0 + x, y, prediction);
      s.total[x] = to.total.row(y)[x];
      if (!(s.total[x] > 0)) {
        ++restarted[std::size_t(worker)];
        if (reject & kRejectVector) ++bad[std::size_t(worker)];
      }
      if (!(u.present.valid.row(y)[x] > 0)) reject |= kRejectPresent;
      s.reject[x] = reject;
      for (int k = 0; k < 4; ++k) s.history[4 * x + k] = s.total[x] > 0 ? to.color.row(y)[x][k] : 0.0f;
    }
  };
  const auto keep = [&](const AccumulateView& v, int row, const RowScratch& s, int) {
    const int y = w.y0 + row;
    for (int x = 0; x < v.width; ++x) {
      const bool known = s.total[x] > 0;
      glm::vec4& color = to.color.row(y)[x];
      for (int k = 0; k < 4; ++k) color[k] = s.history[4 * x + k];
      if (!diagnostics.reject.empty()) diagnostics.reject.row(y)[x] = s.reject[x];
      if (differences.empty()) continue;
      const bool both = known && u.present.valid.row(y)[x] > 0;
      differences.row(y)[x] = both ? difference_to(u.present.color.row(y)[x], color) : glm::vec4(0.0f);
    }
  };
  AccumulateCounts counts = visit_history(u.present, {}, plain, rectify, {}, u.restart_bit,
                                          {wanted.clip, false, wanted.reject}, diagnostics, fetch, keep, workers);
  for (const std::size_t n : restarted) counts.restarted += n;
  for (const std::size_t n : bad) counts.vectors_bad += n;
  return counts;
}

/// The least weight of the present that keeps blur and residual.
double bound_at(const Update& u, const Prediction& prediction, const Plane<float>& residual, double own, int x, int y) {
  const RecursiveParameters& p = u.recursive;
  double least = residual.empty() ? 0 : alpha_of_residual(double(residual.at(x, y)), p.residual_limit);
  if (u.table) {
    const glm::vec2 v = u.present.motion.empty() ? glm::vec2(0.0f) : u.present.motion.at(x, y);
    least = std::max(least, u.table->at(glm::dvec2(v)));
  } else if (p.blur_limit > 0) {
    // The picture is the mean of four quarters, which lie 1/16 px^2 around it, and which are carried once more.
    const double left = p.blur_limit - 1.0 / 16 - double(prediction.carried.at(x, y));
    least = std::max(least, alpha_of_blur(double(prediction.quarter.moments.at(x, y).z), own, std::max(left, 1e-9)));
  }
  return least;
}

/// The present into what was predicted.
void blend(const Update& u, const Plane<float>& residual, Prediction& prediction, Plane<float>& weight,
           Workers& workers) {
  const RecursiveParameters& p = u.recursive;
  SubpixelBuffer& to = prediction.quarter;
  const Window& w = u.present.color.window();
  const glm::dvec2 e = u.present.jitter.value_or(glm::dvec2(0.0)) - kQuadrantMiddle[u.quadrant];
  const glm::dvec3 own(e.x, e.y, (e.x * e.x + e.y * e.y) / 2);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const double before = double(to.total.at(x, y));
      const bool known = before > 0, valid = u.present.valid.at(x, y) > 0;
      double a = known ? 0 : 1, total = valid ? 1 : 0;
      if (known && valid) {
        const double aged = p.alpha_rule == AlphaRule::fixed ? p.alpha : std::max(p.alpha, 1 / (before + 1));
        const double least = bound_at(u, prediction, residual, own.z, x, y);
        a = std::min(1.0, std::max(aged, least));
        // Where a bound spoke, the history is as old as would give that weight.
        total = least > aged ? std::min(before + 1, 1 / a) : before + 1;
      }
      if (!weight.empty()) weight.at(x, y) = float(1 - a);
      if (known && !valid) continue;
      const auto mix = [&](glm::vec4& history, const glm::vec4& sample) {
        history = known ? held_color(glm::dvec4(history) + (glm::dvec4(sample) - glm::dvec4(history)) * a) : sample;
      };
      mix(to.color.at(x, y), u.present.color.at(x, y));
      for (std::size_t i = 0; i < to.companions.size(); ++i)
        mix(to.companions[i].at(x, y), u.present.companions[i].at(x, y));
      const double spread = known ? double(to.spread.at(x, y)) * (1 - a) * (1 - a) + a * a : 1;
      const glm::dvec3 moments = known ? glm::dvec3(to.moments.at(x, y)) : own;
      to.total.at(x, y) = float(std::min(total, 1e6));  // a count beyond this changes nothing that a float can hold
      to.spread.at(x, y) = valid ? float(spread) : 0.0f;
      to.moments.at(x, y) = glm::vec3(moments + (own - moments) * a);
    }
  });
}

void remember_surfaces(SubpixelBuffer& q, const Present& present, const RecursiveParameters& p) {
  if (p.disocclusion == Disocclusion::depth && !present.depth.empty()) q.depth = present.depth.clone();
  if (p.reject.id != IdTest::off && !present.id.empty()) q.id = present.id.clone();
  if (p.reject.normal_angle > 0 && !present.normal.empty()) q.normal = present.normal.clone();
}

}  // namespace

std::optional<BlurTable> blur_table_for(const SubpixelParameters& subpixel, const RecursiveParameters& recursive) {
  if (!(recursive.blur_limit > 0) || subpixel.bound != BlurBound::tabulated) return {};
  return tabulate_blur(recursive.blur_limit, [&](TentSamples& samples) {
    return weigh_samples_around(samples, subpixel.radius, subpixel.weights);
  });
}

SubpixelStep accumulate_subpixel(std::span<const Present* const> samples, SubpixelHistory history,
                                 const SubpixelParameters& subpixel, const RecursiveParameters& recursive,
                                 const RectifyParameters& rectify, const BlurTable* table, std::uint32_t restart_bit,
                                 const DiagnosticsWanted& wanted, Workers& workers) {
  const Present& first = *samples.front();
  const Window& window = first.color.window();
  SubpixelStep step;
  AccumulateDiagnostics& diagnostics = step.resolved.diagnostics;
  for (SubpixelBuffer& q : history.quadrants)
    if (!q.empty()) q.way = carry_way(q.way, first.motion, window, workers), ++q.lag;
  const bool compares = recursive.residual_limit > 0 || wanted.residual;
  for (const Present* sample : samples) {
    const glm::dvec2 jitter = sample->jitter.value_or(glm::dvec2(0.0));
    const Update update{history, *sample, subpixel, recursive, quadrant_of(jitter), restart_bit, table};
    Prediction prediction{make_buffer(*sample), {}, {}};
    if (recursive.blur_limit > 0 && !table) prediction.carried = Plane<float>(window, 0, 0.0f);
    if (compares) prediction.differences = Plane<glm::vec4>(window);
    step.resolved.counts = predict_all(update, rectify, wanted, prediction, diagnostics, workers);
    Plane<float> residual;
    if (compares) residual = residual_of(prediction.differences, recursive.residual_window, workers);
    if (wanted.weight) diagnostics.weight = Plane<float>(window);
    blend(update, residual, prediction, diagnostics.weight, workers);
    if (wanted.residual) diagnostics.residual = std::move(residual);
    remember_surfaces(prediction.quarter, first, recursive);
    history.quadrants[update.quadrant] = std::move(prediction.quarter);
  }
  step.history = std::move(history);
  show_subpixel(first, subpixel, recursive, wanted, step, workers);
  return step;
}

}  // namespace varve
