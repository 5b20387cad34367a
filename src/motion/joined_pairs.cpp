#include "motion/joined_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/median.h"

namespace varve {
namespace {

constexpr double kTelling = 0.002;  // of the vectors' length: what halves and the way between pixels change
constexpr double kMostOff = 0.02;   // of the vectors' length, in the middle: farther apart, they are no such pairs
constexpr double kSure = 0.6;       // of the votes, at least

double length(const glm::dvec2& v) { return std::sqrt(v.x * v.x + v.y * v.y); }

glm::dvec2 stored(const StoredValues& values, const std::pair<int, int>& channels, double bias) {
  return {double(values[std::size_t(channels.first)]) - bias, double(values[std::size_t(channels.second)]) - bias};
}

/// One way of telling the pairs apart: how far what leads back here is from what leads on there, without and with the
/// sign turned.
struct Way {
  std::vector<double> opposite, alike;
  bool negated() const { return upper_median(alike) < upper_median(opposite); }
  const std::vector<double>& off() const { return negated() ? alike : opposite; }
};

void add(Way& way, const glm::dvec2& back, const glm::dvec2& on) {
  way.opposite.push_back(length(back + on));
  way.alike.push_back(length(back - on));
}

struct Votes {
  std::size_t first = 0, second = 0;
};

bool goes_with(const VectorHypothesis& h, const VectorHypothesis& other, bool negated) {
  const MotionEncoding &a = h.encoding, &b = other.encoding;
  const double sign = negated ? -1 : 1;
  // Order of the channels by their places in their own pairs; both lie in reading order.
  return (h.x < h.y) == (other.x < other.y) && h.jitter == other.jitter && a.direction != b.direction &&
         a.unit == b.unit && a.bias == b.bias && a.sign_x == sign * b.sign_x && a.sign_y == sign * b.sign_y &&
         std::abs(a.scale / a.shutter - b.scale / b.shutter) <= 0.01 * std::abs(b.scale / b.shutter);
}

bool is_left(const ChannelRanking& ranking, std::size_t i) { return i == 0 || ranking.ranking[i].rival; }

std::vector<bool> kept_of(const ChannelRanking& own, const ChannelRanking& other, const JoinedPairs& joined,
                          bool first_previous) {
  std::vector<bool> kept(own.ranking.size(), false);
  for (std::size_t i = 0; i < own.ranking.size(); ++i) {
    const VectorHypothesis& h = own.ranking[i].hypothesis;
    if (!is_left(own, i) || (h.encoding.direction == MotionDirection::previous) != first_previous) continue;
    for (std::size_t k = 0; k < other.ranking.size(); ++k)
      kept[i] = kept[i] || (is_left(other, k) && goes_with(h, other.ranking[k].hypothesis, joined.negated));
  }
  return kept;
}

void keep(ChannelRanking& ranking, const std::vector<bool>& kept, const JoinedPairs& joined) {
  const std::size_t best = std::size_t(std::find(kept.begin(), kept.end(), true) - kept.begin());
  std::size_t left = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    left += kept[i];
    ranking.ranking[i].rival = kept[i] && i != best;
  }
  std::rotate(ranking.ranking.begin(), ranking.ranking.begin() + std::ptrdiff_t(best),
              ranking.ranking.begin() + std::ptrdiff_t(best) + 1);
  std::stable_partition(ranking.ranking.begin() + 1, ranking.ranking.end(),
                        [](const RankedHypothesis& ranked) { return ranked.rival; });
  ranking.joined = true;
  if (left == 1 && ranking.finding == VectorFinding::ambiguous) {
    ranking.finding = VectorFinding::found;
    ranking.confidence = std::min(ranking.lead, joined.at_least);
  }
}

}  // namespace

JoinedPairs join_pairs(const std::vector<FollowedPlace>& places, std::pair<int, int> first, std::pair<int, int> second,
                       double bias) {
  Way by_first, by_second;
  std::vector<double> longs;
  std::vector<int> pairs;
  for (const FollowedPlace& place : places) {
    if (!(length(place.moved) > 1)) continue;
    const glm::dvec2 a = stored(place.here, first, bias), b = stored(place.here, second, bias);
    const glm::dvec2 a_there = stored(place.there, first, bias), b_there = stored(place.there, second, bias);
    const double far = length(a) + length(b) + length(a_there) + length(b_there);
    if (!(far > 0) || !std::isfinite(far)) continue;
    add(by_first, a, b_there);
    add(by_second, b, a_there);
    longs.push_back(far / 4);
    pairs.push_back(place.pair);
  }
  JoinedPairs joined;
  if (longs.size() < kFewestPlaces) return joined;
  const std::vector<double>&off_first = by_first.off(), &off_second = by_second.off();
  Votes all;
  std::map<int, Votes> by_pair;
  std::vector<double> kept_first, kept_second;
  for (std::size_t i = 0; i < longs.size(); ++i) {
    kept_first.push_back(off_first[i] / longs[i]);
    kept_second.push_back(off_second[i] / longs[i]);
    if (!(std::abs(off_first[i] - off_second[i]) > kTelling * longs[i])) continue;
    Votes& votes = by_pair[pairs[i]];
    ++(off_first[i] < off_second[i] ? votes.first : votes.second);
    ++(off_first[i] < off_second[i] ? all.first : all.second);
  }
  joined.first_previous = all.first > all.second;
  joined.negated = joined.first_previous ? by_first.negated() : by_second.negated();
  joined.decided = all.first + all.second;
  joined.won = std::max(all.first, all.second);
  joined.at_least = lower_bound(double(joined.won) / 3, double(joined.decided) / 3);
  const auto against = [&](const std::pair<const int, Votes>& pair) {
    const std::size_t yes = joined.first_previous ? pair.second.first : pair.second.second;
    return 2 * yes < pair.second.first + pair.second.second;
  };
  joined.tells = joined.decided >= kFewestPlaces && joined.at_least > kSure &&
                 upper_median(joined.first_previous ? kept_first : kept_second) < kMostOff &&
                 by_first.negated() == by_second.negated() && std::none_of(by_pair.begin(), by_pair.end(), against);
  return joined;
}

void settle_joined(ChannelRanking& first, ChannelRanking& second, const JoinedPairs& joined) {
  const auto speaks = [](const ChannelRanking& ranking) {
    return ranking.finding == VectorFinding::found || ranking.finding == VectorFinding::ambiguous;
  };
  if (!joined.tells || !speaks(first) || !speaks(second)) return;
  const std::vector<bool> of_first = kept_of(first, second, joined, joined.first_previous);
  const std::vector<bool> of_second = kept_of(second, first, joined, !joined.first_previous);
  const auto any = [](const std::vector<bool>& kept) {
    return std::find(kept.begin(), kept.end(), true) != kept.end();
  };
  if (!any(of_first) || !any(of_second)) return;
  keep(first, of_first, joined);
  keep(second, of_second, joined);
}

}  // namespace varve
