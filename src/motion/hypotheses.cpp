#include "motion/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "base/median.h"

namespace varve {
namespace {

using enum MotionUnit;

/// Unit, bias and scale as renderers combine them.
struct Form {
  MotionUnit unit;
  double bias, scale;
  bool free;
};

// The first rows are what is meant when nothing else is said; 512 is Maya's maximum displacement of 256 px to each
// side. A fraction of the picture is half of what counts -1 to 1 across it.
constexpr Form kForms[] = {
    {pixel, 0, 1, false},  {unit, 0, 1, false},   {ndc, 0, 1, false},    {pixel, 0.5, 2, false},
    {unit, 0.5, 1, false}, {unit, 0.5, 2, false}, {ndc, 0.5, 1, false},  {pixel, 0.5, 512, false},
    {pixel, 0, 1, true},   {unit, 0, 1, true},    {pixel, 0.5, 1, true}, {unit, 0.5, 1, true},
};

double length(const glm::dvec2& v) { return std::sqrt(v.x * v.x + v.y * v.y); }
bool moves(const FollowedPlace& place) { return length(place.moved) > 1; }

const StoredValues& stored(const VectorHypothesis& h, const FollowedPlace& place) {
  return h.encoding.direction == MotionDirection::previous ? place.here : place.there;
}

// `jitter`: how much of the predictions is no motion but the change of jitter.
template <class Predict>
Fit fit(const std::vector<FollowedPlace>& places, int jitter, Predict predict) {
  Fit fit;
  double close_moving = 0, close_resting = 0;
  std::size_t any_moving = 0, resting = 0, agree = 0, roughly = 0, recalled = 0;
  std::vector<double> distances;
  for (const FollowedPlace& place : places) {
    const std::optional<glm::dvec2> by = predict(place);
    if (!by) continue;
    const double distance = length(*by - place.moved), far = length(place.moved);
    const double reach = 2 * place.pixel + 0.1 * far;
    const double closeness = distance < reach ? 1 - distance / reach : 0.0;  // NaN is not close
    const bool agrees = distance <= tolerance_of(place);
    const bool led = length(*by + double(jitter) * place.jitter) > 1;
    if (!led && !moves(place)) {
      close_resting += closeness, ++resting;
      continue;
    }
    close_moving += closeness, ++any_moving;
    if (moves(place)) ++fit.moving, recalled += agrees;
    if (!led) continue;
    ++fit.predicted;
    agree += agrees;
    roughly += distance <= 0.5 * place.pixel + 0.25 * far;
    distances.push_back(std::isfinite(distance) ? distance : std::numeric_limits<double>::max());
  }
  if (any_moving > 0) fit.score = close_moving / double(any_moving);
  if (any_moving > 0 && resting > 0) fit.score = 0.75 * fit.score + 0.25 * close_resting / double(resting);
  if (fit.moving > 0) fit.recall = double(recalled) / double(fit.moving);
  if (fit.predicted > 0) {
    fit.agreement = double(agree) / double(fit.predicted);
    fit.rough_agreement = double(roughly) / double(fit.predicted);
    fit.off = upper_median(std::move(distances));
  }
  return fit;
}

}  // namespace

std::vector<VectorHypothesis> vector_hypotheses(int first, int second, bool square) {
  std::vector<VectorHypothesis> all;
  for (const Form& form : kForms) {
    if (square && form.free && form.unit == unit) continue;
    for (const MotionDirection direction : {MotionDirection::previous, MotionDirection::next})
      for (const bool swapped : {false, true})
        for (const double sign_x : {1.0, -1.0})
          for (const double sign_y : {1.0, -1.0}) {
            VectorHypothesis h;
            h.x = swapped ? second : first;
            h.y = swapped ? first : second;
            h.encoding = {form.bias, form.scale, 1, sign_x, sign_y, form.unit, direction};
            h.scale_free = form.free;
            all.push_back(h);
          }
  }
  return all;
}

glm::dvec2 predicted(const VectorHypothesis& h, const FollowedPlace& place, const Window& display) {
  const MotionEncoding& e = h.encoding;
  const StoredValues& values = stored(h, place);
  const double share = e.unit == ndc ? 0.5 : 1.0;
  const double unit_x = e.unit == pixel ? 1 : share * display.width();
  const double unit_y = e.unit == pixel ? 1 : share * display.height();
  const double turn = e.direction == MotionDirection::previous ? 1 : -1;
  const glm::dvec2 decoded(e.sign_x * (double(values[std::size_t(h.x)]) - e.bias) * e.scale / e.shutter * unit_x,
                           e.sign_y * (double(values[std::size_t(h.y)]) - e.bias) * e.scale / e.shutter * unit_y);
  return turn * decoded - double(h.jitter) * place.jitter;
}

double tolerance_of(const FollowedPlace& place) { return 0.5 * place.pixel + 0.02 * length(place.moved); }

bool is_at_rest(const VectorHypothesis& h, const FollowedPlace& place) {
  const StoredValues& values = stored(h, place);
  return double(values[std::size_t(h.x)]) == h.encoding.bias && double(values[std::size_t(h.y)]) == h.encoding.bias;
}

Fit fit_of(const VectorHypothesis& h, const std::vector<FollowedPlace>& places, const Window& display) {
  return fit(places, h.jitter, [&](const FollowedPlace& place) -> std::optional<glm::dvec2> {
    // Things without vectors are told of elsewhere; they do not speak against a reading of the others.
    if (moves(place) && is_at_rest(h, place)) return std::nullopt;
    const glm::dvec2 by = predicted(h, place, display);
    if (std::isnan(by.x + by.y)) return std::nullopt;
    return by;
  });
}

Fit fit_of_rest(const std::vector<FollowedPlace>& places) {
  return fit(places, 0, [](const FollowedPlace&) { return std::optional<glm::dvec2>(glm::dvec2(0)); });
}

FoundScale find_scale(VectorHypothesis& h, const std::vector<FollowedPlace>& places, const Window& display) {
  h.encoding.scale = 1;
  struct Pair {
    glm::dvec2 stored, moved;
    double tolerance;
  };
  std::vector<Pair> pairs;
  for (const FollowedPlace& place : places) {
    if (!moves(place)) continue;
    const glm::dvec2 moved = place.moved + double(h.jitter) * place.jitter;
    const glm::dvec2 by = predicted(h, place, display) + double(h.jitter) * place.jitter;
    if (length(by) > 0) pairs.push_back({by, moved, tolerance_of(place)});
  }
  FoundScale found;
  if (pairs.size() < 8) return found;

  // Every so many places propose a factor; the one that most others agree with is taken. Robust against any minority.
  const std::size_t step = std::max<std::size_t>(1, pairs.size() / 64),
                    thin = std::max<std::size_t>(1, pairs.size() / 400);
  double best = 0, most = 0;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    const double along = pairs[i].stored.x * pairs[i].moved.x + pairs[i].stored.y * pairs[i].moved.y;
    const double factor = along / (pairs[i].stored.x * pairs[i].stored.x + pairs[i].stored.y * pairs[i].stored.y);
    if (!(factor > 0) || !std::isfinite(factor)) continue;
    double votes = 0;
    for (std::size_t k = 0; k < pairs.size(); k += thin) {
      const double off = length(factor * pairs[k].stored - pairs[k].moved) / (2 * pairs[k].tolerance);
      if (off < 1) votes += 1 - off;
    }
    if (votes > most) most = votes, best = factor;
  }
  if (!(best > 0)) return found;

  // Least squares over those that agree.
  double deviation = 0;
  for (int round = 0; round < 3; ++round) {
    double xx = 0, yy = 0, xm = 0, ym = 0, squares = 0;
    std::size_t n = 0;
    for (const Pair& p : pairs) {
      const glm::dvec2 off = best * p.stored - p.moved;
      if (!(length(off) < 2 * p.tolerance)) continue;
      xx += p.stored.x * p.stored.x, yy += p.stored.y * p.stored.y;
      xm += p.stored.x * p.moved.x, ym += p.stored.y * p.moved.y;
      squares += off.x * off.x + off.y * off.y;
      ++n;
    }
    if (n < 8 || !(xx + yy > 0)) break;
    best = (xm + ym) / (xx + yy);
    deviation = std::sqrt(squares / double(n) / (xx + yy));
    const double least = 0.02 * (xx + yy);
    found.scale_x = xx > least ? xm / xx : 0;
    found.scale_y = yy > least ? ym / yy : 0;
  }
  if (!(best > 0)) return {};
  found.scale = best;
  // Where pixels alias, motion is measured short or long by a percent or two, however many places there are.
  found.deviation = std::hypot(deviation, 0.01 * best);
  h.encoding.scale = best;
  return found;
}

std::string words_of(const VectorHypothesis& h) {
  const MotionEncoding& e = h.encoding;
  std::string text = e.direction == MotionDirection::previous ? "to the previous frame" : "to the next frame";
  const char* name = e.unit == pixel ? "pixels" : e.unit == unit ? "fractions of the picture" : "-1 to 1 across";
  char number[40];
  std::snprintf(number, sizeof number, "%.4g", e.scale);
  text += ", ";
  if (e.bias != 0) text += "0.5 is rest, ";
  text += name;
  if (e.scale != 1) text += std::string(" times ") + number;
  text += e.sign_x > 0 ? ", x right" : ", x left";
  text += e.sign_y > 0 ? ", y down" : ", y up";
  if (h.jitter != 0) text += h.jitter > 0 ? ", with the jitter in them" : ", with the jitter in them turned round";
  return text;
}

}  // namespace varve
