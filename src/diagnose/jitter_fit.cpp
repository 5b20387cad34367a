#include "diagnose/jitter_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace varve {
namespace {

constexpr double kSurest = 0.02;  // px: no measured shift is trusted further than that
constexpr double kFair = 0.2;     // px rms: up to here it may, where it is clearly the best
constexpr double kGood = 0.1;     // px rms: up to here an explanation explains
constexpr double kSame = 0.03;    // px rms: explanations that differ by less say the same of these frames
constexpr double kAtRest = 0.04;  // px rms
constexpr double kClearly = 2;    // times better than the next
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

glm::dvec2 weight_of(const ShiftBetween& s) {
  return {1 / (s.sigma.x * s.sigma.x + kSurest * kSurest), 1 / (s.sigma.y * s.sigma.y + kSurest * kSurest)};
}

/// The largest set of frames that shifts connect.
std::vector<bool> connected(std::size_t frames, std::span<const ShiftBetween> shifts) {
  std::vector<std::size_t> root(frames);
  std::iota(root.begin(), root.end(), std::size_t(0));
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const ShiftBetween& s : shifts) root[find(s.now)] = find(s.before);
  std::vector<std::size_t> size(frames);
  for (std::size_t i = 0; i < frames; ++i) ++size[find(i)];
  const std::size_t largest = std::size_t(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<bool> in(frames);
  for (std::size_t i = 0; i < frames; ++i) in[i] = size[largest] > 1 && find(i) == largest;
  return in;
}

/// Least squares of x[now] - x[before] = value by conjugate gradients; the mean of x stays 0.
std::vector<double> solve(std::size_t frames, std::span<const ShiftBetween> shifts, const std::vector<bool>& use,
                          std::span<const double> values, std::span<const double> weights) {
  const auto apply = [&](const std::vector<double>& x) {
    std::vector<double> y(frames);
    for (std::size_t i = 0; i < shifts.size(); ++i) {
      if (!use[shifts[i].now]) continue;
      const double d = weights[i] * (x[shifts[i].now] - x[shifts[i].before]);
      y[shifts[i].now] += d, y[shifts[i].before] -= d;
    }
    return y;
  };
  std::vector<double> x(frames), r(frames);
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    if (!use[shifts[i].now]) continue;
    r[shifts[i].now] += weights[i] * values[i], r[shifts[i].before] -= weights[i] * values[i];
  }
  std::vector<double> p = r;
  double rr = std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  const double enough = rr * 1e-24;
  for (std::size_t step = 0; step < 4 * frames && rr > enough; ++step) {
    const std::vector<double> ap = apply(p);
    const double pap = std::inner_product(p.begin(), p.end(), ap.begin(), 0.0);
    if (!(pap > 0)) break;
    for (std::size_t i = 0; i < frames; ++i) x[i] += rr / pap * p[i], r[i] -= rr / pap * ap[i];
    const double next = std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
    for (std::size_t i = 0; i < frames; ++i) p[i] = r[i] + next / rr * p[i];
    rr = next;
  }
  return x;
}

/// Offsets along one axis; weights of shifts beyond 2.5 deviations are lowered (Huber).
std::vector<double> fit_axis(std::size_t frames, std::span<const ShiftBetween> shifts, const std::vector<bool>& use,
                             int axis) {
  std::vector<double> values, weights, x;
  for (const ShiftBetween& s : shifts) values.push_back(s.shift[axis]), weights.push_back(weight_of(s)[axis]);
  const std::vector<double> first = weights;
  for (int round = 0; round < 4; ++round) {
    x = solve(frames, shifts, use, values, weights);
    for (std::size_t i = 0; i < shifts.size(); ++i) {
      const double off = std::abs(values[i] - (x[shifts[i].now] - x[shifts[i].before])) * std::sqrt(first[i]);
      weights[i] = first[i] * (off > 2.5 ? 2.5 / off : 1);
    }
  }
  return x;
}

/// Root of the weighted mean square over the shifts, both axes. `predicted(now, before)` may be NaN: no say.
template <class Predict>
double misfit_of(std::span<const ShiftBetween> shifts, Predict predicted) {
  double sum = 0, weights = 0;
  for (const ShiftBetween& s : shifts) {
    const glm::dvec2 d = s.shift - predicted(s), w = weight_of(s);
    if (!(std::isfinite(d.x) && std::isfinite(d.y))) continue;
    sum += w.x * d.x * d.x + w.y * d.y * d.y;
    weights += w.x + w.y;
  }
  return weights > 0 ? std::sqrt(sum / weights) : kNaN;
}

std::vector<JitterMistake> mistakes() {
  struct Turn {
    double xx, xy, yx, yy;
    const char* words;
  };
  constexpr Turn kTurns[] = {{1, 0, 0, 1, ""},
                             {-1, 0, 0, 1, "x is turned round"},
                             {1, 0, 0, -1, "y is turned round (up against down)"},
                             {-1, 0, 0, -1, "both axes are turned round"},
                             {0, 1, 1, 0, "x and y are swapped"},
                             {0, -1, 1, 0, "x and y are swapped, and x is turned round"},
                             {0, 1, -1, 0, "x and y are swapped, and y is turned round"},
                             {0, -1, -1, 0, "x and y are swapped, and both are turned round"}};
  std::vector<JitterMistake> all;
  for (const int later : {0, -1, 1})
    for (const double scale : {1.0, 2.0, 0.5})
      for (const Turn& t : kTurns) {
        JitterMistake m{scale * t.xx, scale * t.xy, scale * t.yx, scale * t.yy, later, ""};
        const auto say = [&](const std::string& words) { m.sentence += (m.sentence.empty() ? "" : ", and ") + words; };
        if (scale == 2.0) say("the samples moved twice as far as stated (NDC is 2 pixels wide for each pixel's width)");
        if (scale == 0.5) say("the samples moved half as far as stated (NDC is 2 pixels wide for each pixel's width)");
        if (*t.words) say(t.words);
        if (later > 0) say("frame f was sampled where frame f+1 is stated to be");
        if (later < 0) say("frame f was sampled where frame f-1 is stated to be");
        all.push_back(std::move(m));
      }
  return all;
}

}  // namespace

OffsetFit fit_offsets(std::size_t frames, std::span<const ShiftBetween> shifts) {
  OffsetFit fit;
  fit.offsets.assign(frames, glm::dvec2(kNaN));
  const std::vector<bool> in = connected(frames, shifts);
  fit.known = std::size_t(std::count(in.begin(), in.end(), true));
  if (fit.known == 0) return fit;
  const std::vector<double> x = fit_axis(frames, shifts, in, 0), y = fit_axis(frames, shifts, in, 1);
  glm::dvec2 mean(0);
  for (std::size_t i = 0; i < frames; ++i)
    if (in[i]) mean += glm::dvec2(x[i], y[i]) / double(fit.known);
  for (std::size_t i = 0; i < frames; ++i)
    if (in[i]) fit.offsets[i] = glm::dvec2(x[i], y[i]) - mean;
  fit.misfit = misfit_of(shifts, [&](const ShiftBetween& s) { return fit.offsets[s.now] - fit.offsets[s.before]; });
  return fit;
}

JitterVerdict judge_jitter(std::span<const std::optional<glm::dvec2>> stated, std::span<const ShiftBetween> shifts) {
  const auto offset = [&](const JitterMistake& m, std::size_t frame) {
    const std::ptrdiff_t from = std::ptrdiff_t(frame) + m.later;
    if (from < 0 || from >= std::ptrdiff_t(stated.size()) || !stated[std::size_t(from)]) return glm::dvec2(kNaN);
    const glm::dvec2 j = *stated[std::size_t(from)];
    return glm::dvec2(m.xx * j.x + m.xy * j.y, m.yx * j.x + m.yy * j.y);
  };
  const auto between = [&](const JitterMistake& m, const ShiftBetween& s) {
    return offset(m, s.now) - offset(m, s.before);
  };
  // All are held against the same shifts: those that every one has something to say of.
  std::vector<ShiftBetween> judged;
  for (const ShiftBetween& s : shifts) {
    bool all = true;
    for (const int later : {-1, 0, 1}) {
      const glm::dvec2 d = between({1, 0, 0, 1, later, ""}, s);
      all = all && std::isfinite(d.x) && std::isfinite(d.y);
    }
    if (all) judged.push_back(s);
  }
  JitterVerdict v;
  if (judged.size() < 3) return v;
  const std::vector<JitterMistake> table = mistakes();
  std::vector<double> misfits;
  for (const JitterMistake& m : table)
    misfits.push_back(misfit_of(judged, [&](const ShiftBetween& s) { return between(m, s); }));
  const std::size_t best = std::size_t(std::min_element(misfits.begin(), misfits.end()) - misfits.begin());
  const double rest = misfit_of(judged, [](const ShiftBetween&) { return glm::dvec2(0); });
  v.as_stated = misfits.front();
  v.mistake = table[best];
  v.misfit = misfits[best];
  v.runner_up = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < table.size(); ++i) {
    double apart = 0;  // what the two explanations say of these frames
    for (const ShiftBetween& s : judged) {
      const glm::dvec2 d = between(table[i], s) - between(table[best], s);
      apart += (d.x * d.x + d.y * d.y) / (2 * double(judged.size()));
    }
    if (std::sqrt(apart) > kSame) v.runner_up = std::min(v.runner_up, misfits[i]);
  }
  const double stated_size = [&] {
    double sum = 0;
    for (const ShiftBetween& s : judged) {
      const glm::dvec2 d = between(table.front(), s);
      sum += (d.x * d.x + d.y * d.y) / (2 * double(judged.size()));
    }
    return std::sqrt(sum);
  }();
  const bool best_is_clear = v.misfit <= kFair && v.runner_up >= kClearly * v.misfit;
  const bool stated_fits =
      (v.as_stated <= kGood && v.as_stated <= 1.25 * v.misfit + 0.02) || (v.mistake.none() && best_is_clear);
  if (stated_fits) v.mistake = table.front(), v.misfit = v.as_stated;
  if (rest < kAtRest && stated_size > 2 * kAtRest)
    v.kind = JitterVerdict::Kind::at_rest, v.misfit = rest;
  else if (stated_fits)
    v.kind = JitterVerdict::Kind::fits;
  else if (best_is_clear && v.as_stated >= kClearly * v.misfit)
    v.kind = JitterVerdict::Kind::mistaken;
  else
    v.kind = v.as_stated > kFair ? JitterVerdict::Kind::unexplained : JitterVerdict::Kind::cannot_tell;
  return v;
}

}  // namespace varve
