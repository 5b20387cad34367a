#include "motion/rank_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace varve {
namespace {

constexpr double kBeaten = 0.6;     // of the votes, at least
constexpr double kAgreement = 0.5;  // of what moves
constexpr double kRecall = 0.2;     // of what is measured to move, with aliased detail among it
constexpr double kRough = 0.6;      // of what moves
constexpr std::size_t kShown = 12;  // of the ranking, besides rivals
constexpr std::size_t kJittered = 16;

double length(const glm::dvec2& v) { return std::sqrt(v.x * v.x + v.y * v.y); }

using Predict = std::function<glm::dvec2(const FollowedPlace&)>;

// An edge at rest that is sampled once falls on the same pixels wherever the sample was, as if it moved with the
// jitter: what rests does not decide between readings that differ by less than the jitter does.
bool is_locked(const FollowedPlace& place, const glm::dvec2& a, const glm::dvec2& b) {
  return length(place.moved) <= 1.5 && length(a) <= 1.5 && length(b) <= 1.5;
}

VectorVotes vote(const Predict& first, const Predict& second, const std::vector<FollowedPlace>& places,
                 bool only_moving = false) {
  VectorVotes c;
  for (const FollowedPlace& place : places) {
    const glm::dvec2 a = first(place), b = second(place);
    if (only_moving ? !(length(place.moved) > 1) : is_locked(place, a, b)) continue;
    const double off_a = length(a - place.moved), off_b = length(b - place.moved);
    if (!std::isfinite(off_a) || !std::isfinite(off_b)) continue;  // nothing is stored there
    if (length(a - b) < 0.3 * place.pixel + 0.01 * length(place.moved)) continue;
    ++c.decided;
    c.won += off_a < off_b;
  }
  c.at_least = lower_bound(double(c.won) / 3, double(c.decided) / 3);
  return c;
}

Predict predict_by(const VectorHypothesis& h, const Window& display) {
  return [&h, &display](const FollowedPlace& place) { return predicted(h, place, display); };
}

VectorVotes turned_round(VectorVotes c) {
  c.won = c.decided - c.won;
  c.at_least = lower_bound(double(c.won) / 3, double(c.decided) / 3);
  return c;
}

// Things that move and have no vector say nothing about the reading of the others.
std::vector<FollowedPlace> with_vector(const VectorHypothesis& h, const std::vector<FollowedPlace>& places) {
  std::vector<FollowedPlace> kept;
  for (const FollowedPlace& place : places)
    if (!(is_at_rest(h, place) && length(place.moved) > 1)) kept.push_back(place);
  return kept;
}

std::vector<RankedHypothesis> fitted(const std::vector<FollowedPlace>& places, int x, int y, const Window& display) {
  std::vector<RankedHypothesis> all;
  const auto add = [&](VectorHypothesis h) {
    RankedHypothesis ranked;
    ranked.hypothesis = h;
    if (h.scale_free) {
      ranked.scale = find_scale(ranked.hypothesis, places, display);
      if (!(ranked.scale.scale > 0)) return;
    }
    ranked.fit = fit_of(ranked.hypothesis, places, display);
    all.push_back(ranked);
  };
  const auto sort = [&] {
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.fit.score > b.fit.score; });
  };
  for (const VectorHypothesis& h : vector_hypotheses(x, y, display.width() == display.height())) add(h);
  sort();
  const bool jittered =
      std::any_of(places.begin(), places.end(), [](const FollowedPlace& place) { return length(place.jitter) > 0.05; });
  for (std::size_t i = 0, best = std::min(all.size(), kJittered); jittered && i < best; ++i)
    for (const int jitter : {1, -1}) {
      VectorHypothesis h = all[i].hypothesis;
      h.jitter = jitter;
      add(h);
    }
  sort();
  return all;
}

// A scale as the units say goes before one that was fitted, as long as the pixels do not speak against it.
std::size_t choose(const std::vector<RankedHypothesis>& all, const std::vector<FollowedPlace>& places,
                   const Window& display) {
  if (!all.front().hypothesis.scale_free) return 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const RankedHypothesis& named = all[i];
    if (named.hypothesis.scale_free) continue;
    const bool fits = named.fit.agreement >= 0.9 * all.front().fit.agreement;
    const VectorVotes c = votes_between(all.front().hypothesis, named.hypothesis, places, display);
    return fits && c.at_least <= kBeaten ? i : 0;
  }
  return 0;
}

// Four deviations away from the middle between both, and near the first.
bool beaten_by_pull(const Pull& pull) { return pull.share < 0.3 && pull.share + 4 * pull.deviation < 0.5; }

// 0 in the middle between both, 1 where the second one is out of the question.
double certainty(const Pull& pull) { return std::clamp(1 - 2 * (pull.share + 2 * pull.deviation), 0.0, 0.99); }

// The one among near equals that the measurements are pulled to.
std::size_t settle(const std::vector<RankedHypothesis>& all, std::size_t best, const std::vector<FollowedPlace>& places,
                   const Window& display) {
  const std::vector<FollowedPlace> telling = with_vector(all[best].hypothesis, places);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == best || all[i].hypothesis.scale_free != all[best].hypothesis.scale_free) continue;
    if (votes_between(all[best].hypothesis, all[i].hypothesis, telling, display).at_least > kBeaten) continue;
    if (beaten_by_pull(pull_between(all[i].hypothesis, all[best].hypothesis, telling, display))) best = i;
  }
  return best;
}

// Places that agree with one of the two and not with the other: where both have many, each is right in a part of the
// picture.
void count_apart(const VectorHypothesis& first, RankedHypothesis& other, const std::vector<FollowedPlace>& places,
                 const Window& display) {
  for (const FollowedPlace& place : places) {
    const glm::dvec2 a = predicted(first, place, display), b = predicted(other.hypothesis, place, display);
    if (is_locked(place, a, b)) continue;
    const double off_first = length(a - place.moved), off_other = length(b - place.moved);
    if (!std::isfinite(off_first) || !std::isfinite(off_other)) continue;  // nothing is stored there
    const bool by_first = off_first <= tolerance_of(place), by_other = off_other <= tolerance_of(place);
    other.first_alone += by_first && !by_other;
    other.alone += by_other && !by_first;
  }
}

// Share of what moves, by either of them, where they lead apart measurably.
double share_apart(const VectorHypothesis& first, const VectorHypothesis& other,
                   const std::vector<FollowedPlace>& places, const Window& display) {
  std::size_t moving = 0, apart = 0;
  for (const FollowedPlace& place : places) {
    const glm::dvec2 a = predicted(first, place, display), b = predicted(other, place, display);
    if (!std::isfinite(length(a)) || !std::isfinite(length(b)) || !(length(a) > 1 || length(b) > 1)) continue;
    ++moving;
    apart += !(length(a - b) < 0.3 * place.pixel + 0.01 * length(place.moved));
  }
  return moving > 0 ? double(apart) / double(moving) : 1;
}

// Pairs of frames in which another hypothesis beats the first one.
void judge_pairs(ChannelRanking& ranking, const std::vector<RankedHypothesis>& pool,
                 const std::vector<FollowedPlace>& places, const Window& display) {
  std::set<int> pairs;
  for (const FollowedPlace& place : places) pairs.insert(place.pair);
  for (const int pair : pairs) {
    std::vector<FollowedPlace> here;
    for (const FollowedPlace& place : places)
      if (place.pair == pair) here.push_back(place);
    const VectorHypothesis& first = ranking.ranking.front().hypothesis;
    const Fit own = fit_of(first, here, display);
    if (own.predicted < kFewestPlaces / 2 || own.agreement >= kAgreement) continue;
    const auto better = [&](const RankedHypothesis& other) {
      return !other.hypothesis.scale_free && fit_of(other.hypothesis, here, display).agreement > kAgreement &&
             votes_between(other.hypothesis, first, here, display).at_least > kBeaten;
    };
    if (std::any_of(pool.begin(), pool.end(), better))
      ranking.contradicting.push_back(pair);
    else if (turned_round(votes_against_rest(first, here, display)).at_least > kBeaten)
      ranking.not_following.push_back(pair);
  }
}

VectorFinding judge(const ChannelRanking& ranking) {
  const RankedHypothesis& first = ranking.ranking.front();
  if (first.fit.predicted < kFewestPlaces) return VectorFinding::nothing;
  const bool beats_rest = ranking.against_rest.at_least > kBeaten;
  const bool agrees = first.fit.agreement >= kAgreement && first.fit.recall >= kRecall;
  if (!agrees) return VectorFinding::nothing;
  if (!ranking.contradicting.empty()) return VectorFinding::contradictory;
  if (!beats_rest) return VectorFinding::nothing;
  bool rivals = false;
  for (const RankedHypothesis& other : ranking.ranking) {
    if (!other.rival) continue;
    rivals = true;
    if (agrees && other.alone >= kFewestPlaces && 2 * other.alone > other.first_alone)
      return VectorFinding::contradictory;
  }
  if (rivals) return VectorFinding::ambiguous;
  return VectorFinding::found;
}

// Where no constant scale will do: a factor for each pair of frames.
void take_rough(ChannelRanking& result, const std::vector<FollowedPlace>& places, int x, int y, const Window& display) {
  const std::vector<RoughReading> readings = rough_readings(places, x, y, display);
  const RoughReading& best = readings.front();
  if (best.places < kFewestPlaces || !(best.agreement >= kRough)) return;
  result.finding = VectorFinding::rough;
  result.ranking.clear();
  for (const RoughReading& reading : readings) {
    // Places of a pair stand or fall together, so a few pairs more do not decide between readings.
    if (reading.agreement < kRough) break;
    RankedHypothesis ranked;
    ranked.hypothesis = reading.hypothesis;
    ranked.fit = fit_of(reading.hypothesis, places, display);
    ranked.fit.rough_agreement = reading.agreement;
    ranked.scales = reading.scales;
    ranked.rival = !result.ranking.empty();
    result.ranking.push_back(ranked);
  }
  result.against_rest = votes_against_rest(best.hypothesis, places, display);
}

}  // namespace

double lower_bound(double won, double of) {
  if (!(of > 0)) return 0;
  constexpr double z = 2.326;
  const double share = won / of, zz = z * z;
  return (share + zz / (2 * of) - z * std::sqrt(share * (1 - share) / of + zz / (4 * of * of))) / (1 + zz / of);
}

bool same_here(const ChannelRanking& ranking) {
  return std::all_of(ranking.ranking.begin(), ranking.ranking.end(),
                     [](const RankedHypothesis& other) { return !other.rival || other.apart <= kSameHere; });
}

VectorVotes votes_between(const VectorHypothesis& first, const VectorHypothesis& second,
                          const std::vector<FollowedPlace>& places, const Window& display) {
  return vote(predict_by(first, display), predict_by(second, display), places, first.jitter != second.jitter);
}

Pull pull_between(const VectorHypothesis& first, const VectorHypothesis& second,
                  const std::vector<FollowedPlace>& places, const Window& display) {
  struct Sums {
    double lengths = 0, along = 0;
  };
  std::map<int, Sums> pairs;
  std::vector<std::pair<double, double>> terms;  // |apart|^2, apart . off
  Sums all;
  double pixels = 0, motion = 0;
  for (const FollowedPlace& place : places) {
    const glm::dvec2 a = predicted(first, place, display), apart = predicted(second, place, display) - a;
    if (is_locked(place, a, a + apart)) continue;
    const glm::dvec2 off = place.moved - a, from_middle = off - 0.5 * apart;
    // Lost places are left out by their distance from the middle of both, which favors neither.
    if (!(length(from_middle) < place.pixel + 0.02 * length(place.moved))) continue;
    const double lengths = apart.x * apart.x + apart.y * apart.y, along = apart.x * off.x + apart.y * off.y;
    Sums& pair = pairs[place.pair];
    pair.lengths += lengths, pair.along += along;
    all.lengths += lengths, all.along += along;
    terms.push_back({lengths, along});
    pixels += place.pixel * place.pixel;
    motion += place.moved.x * place.moved.x + place.moved.y * place.moved.y;
  }
  Pull pull;
  // Measurements are short or long by a percent or two where pixels alias: what differs by no more than that, or by
  // less than a tenth of a pixel, is not told apart by any number of places.
  const double least = 0.1 * std::sqrt(pixels / double(std::max<std::size_t>(terms.size(), 1))) +
                       0.04 * std::sqrt(motion / double(std::max<std::size_t>(terms.size(), 1)));
  if (terms.size() < 3 * kFewestPlaces || !(all.lengths > least * least * double(terms.size()))) return pull;
  pull.share = all.along / all.lengths;
  double by_places = 0, by_pairs = 0;
  for (const auto& [lengths, along] : terms) by_places += std::pow(along - pull.share * lengths, 2);
  for (const auto& [pair, sums] : pairs) by_pairs += std::pow(sums.along - pull.share * sums.lengths, 2);
  // Neighboring places are not independent; three of them count as one.
  pull.deviation = std::sqrt(std::max(3 * by_places, by_pairs)) / all.lengths;
  return pull;
}

VectorVotes votes_against_rest(const VectorHypothesis& hypothesis, const std::vector<FollowedPlace>& places,
                               const Window& display) {
  return vote(
      predict_by(hypothesis, display), [](const FollowedPlace&) { return glm::dvec2(0); }, places);
}

ChannelRanking rank_hypotheses(const std::vector<FollowedPlace>& places, int x, int y, const Window& display) {
  ChannelRanking result;
  result.x = x;
  result.y = y;
  result.rest = fit_of_rest(places);
  if (result.rest.moving < kFewestPlaces) return result;
  const std::vector<RankedHypothesis> all = fitted(places, x, y, display);
  result.finding = VectorFinding::nothing;
  if (all.empty()) return result;

  const std::size_t best = settle(all, choose(all, places, display), places, display);
  const VectorHypothesis first = all[best].hypothesis;
  const std::vector<FollowedPlace> telling = with_vector(first, places);
  result.without_vector = places.size() - telling.size();
  result.ranking.push_back(all[best]);
  std::vector<RankedHypothesis> beaten;
  result.confidence = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == best) continue;
    RankedHypothesis other = all[i];
    // With a scale as the unit says, others are only in the running where theirs is, too.
    const bool runs = first.scale_free || !other.hypothesis.scale_free;
    if (!runs) continue;
    other.first_against = votes_between(first, other.hypothesis, telling, display);
    other.rival = other.first_against.at_least <= kBeaten;
    if (other.rival) {
      other.pull = pull_between(first, other.hypothesis, telling, display);
      other.rival = !beaten_by_pull(other.pull);
    }
    if (other.rival) {
      count_apart(first, other, telling, display);
      other.apart = share_apart(first, other.hypothesis, telling, display);
      result.ranking.push_back(other);
    } else {
      result.confidence = std::min(result.confidence, std::max(other.first_against.at_least, certainty(other.pull)));
      beaten.push_back(other);
    }
  }
  for (std::size_t i = 0; i < std::min(beaten.size(), kShown); ++i) result.ranking.push_back(beaten[i]);
  result.against_rest = votes_against_rest(first, telling, display);
  result.confidence = std::min(result.confidence, result.against_rest.at_least);
  result.lead = result.confidence;
  judge_pairs(result, all, telling, display);
  result.finding = judge(result);
  if (result.finding == VectorFinding::nothing) take_rough(result, places, x, y, display);
  if (result.finding != VectorFinding::found) result.confidence = 0;
  return result;
}

std::vector<std::string_view> conventions_like(const MotionEncoding& encoding) {
  const auto same = [&](const MotionEncoding& row) {
    return row.bias == encoding.bias && row.scale / row.shutter == encoding.scale / encoding.shutter &&
           row.sign_x == encoding.sign_x && row.sign_y == encoding.sign_y && row.unit == encoding.unit;
  };
  std::vector<std::string_view> names;
  for (const MotionConvention& row : motion_conventions()) {
    const bool previous = encoding.direction == MotionDirection::previous;
    if ((previous ? row.backward_x : row.forward_x).empty()) continue;
    if (same(previous ? row.backward : row.forward)) names.push_back(row.name);
  }
  return names;
}

std::vector<std::string> left_open(const ChannelRanking& ranking) {
  bool direction = false, sign_x = false, sign_y = false, unit = false, order = false, jitter = false;
  if (ranking.ranking.empty()) return {};
  const VectorHypothesis& first = ranking.ranking.front().hypothesis;
  for (const RankedHypothesis& other : ranking.ranking) {
    if (!other.rival) continue;
    const VectorHypothesis& h = other.hypothesis;
    // Turned round in time and in both axes is one thing left open, not three.
    const bool turned = h.encoding.direction != first.encoding.direction;
    direction = direction || turned;
    sign_x = sign_x || (h.encoding.sign_x != first.encoding.sign_x) != turned;
    sign_y = sign_y || (h.encoding.sign_y != first.encoding.sign_y) != turned;
    unit = unit || h.encoding.unit != first.encoding.unit || h.encoding.bias != first.encoding.bias ||
           (h.encoding.scale != first.encoding.scale && ranking.finding != VectorFinding::rough);
    order = order || h.x != first.x;
    jitter = jitter || h.jitter != first.jitter;
  }
  std::vector<std::string> open;
  if (direction) open.push_back("direction in time (the motion is steady: both ways lead to the same places)");
  if (order) open.push_back("which channel is x");
  if (sign_x) open.push_back("sign of x (too little moves along x)");
  if (sign_y) open.push_back("sign of y (too little moves along y)");
  if (unit) open.push_back("unit or scale");
  if (jitter) open.push_back("whether the jitter is in the vectors");
  return open;
}

}  // namespace varve
