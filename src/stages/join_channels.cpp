#include "stages/join_channels.h"

#include <cmath>
#include <cstddef>

#include "motion/joined_pairs.h"

namespace varve {
namespace {

StoredValues side_by_side(const StoredValues& a, const ChannelRanking& of_a, const StoredValues& b,
                          const ChannelRanking& of_b) {
  return {a[std::size_t(of_a.x)], a[std::size_t(of_a.y)], b[std::size_t(of_b.x)], b[std::size_t(of_b.y)]};
}

void join(const JudgedChannels& first, const JudgedChannels& second) {
  ChannelRanking &a = first.report->ranking, &b = second.report->ranking;
  if (a.ranking.empty() || b.ranking.empty() || first.places->size() != second.places->size()) return;
  std::vector<FollowedPlace> places = *first.places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const FollowedPlace& other = (*second.places)[i];
    if (other.pair != places[i].pair || other.at != places[i].at) return;
    places[i].here = side_by_side(places[i].here, a, other.here, b);
    places[i].there = side_by_side(places[i].there, a, other.there, b);
  }
  settle_joined(a, b, join_pairs(places, {0, 1}, {2, 3}, a.ranking.front().hypothesis.encoding.bias));
}

}  // namespace

void join_channels(const std::vector<JudgedChannels>& judged) {
  for (std::size_t i = 0; i < judged.size(); ++i)
    for (std::size_t k = i + 1; k < judged.size(); ++k) join(judged[i], judged[k]);
}

}  // namespace varve
