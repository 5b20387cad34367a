#include "motion/rough_reading.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/median.h"

namespace varve {
namespace {

double length(const glm::dvec2& v) { return std::sqrt(v.x * v.x + v.y * v.y); }

using Motions = std::vector<std::pair<double, double>>;  // stored and measured along one axis

// The middle of the factors, of those that are not drowned by the measurement.
double factor_of(const Motions& motions) {
  std::vector<double> longs, factors;
  for (const auto& [stored, moved] : motions) longs.push_back(std::abs(stored));
  const double least = 0.5 * upper_median(longs);
  for (const auto& [stored, moved] : motions)
    if (std::abs(stored) >= least && stored != 0) factors.push_back(moved / stored);
  return upper_median(factors);
}

void add_pair(RoughReading& reading, int pair, const std::vector<const FollowedPlace*>& places, const Window& display,
              std::size_t& agree) {
  Motions along_x, along_y;
  for (const FollowedPlace* place : places) {
    const glm::dvec2 stored = predicted(reading.hypothesis, *place, display);
    along_x.push_back({stored.x, place->moved.x});
    along_y.push_back({stored.y, place->moved.y});
  }
  const PairScale scale{pair, factor_of(along_x), factor_of(along_y)};
  reading.places += places.size();
  if (!(scale.along_x >= 0) || !(scale.along_y >= 0) || !(scale.along_x + scale.along_y > 0)) return;
  reading.scales.push_back(scale);
  for (const FollowedPlace* place : places) {
    const glm::dvec2 stored = predicted(reading.hypothesis, *place, display);
    const glm::dvec2 off(scale.along_x * stored.x - place->moved.x, scale.along_y * stored.y - place->moved.y);
    agree += length(off) <= 0.5 * place->pixel + 0.15 * length(place->moved);
  }
}

}  // namespace

std::vector<RoughReading> rough_readings(const std::vector<FollowedPlace>& places, int x, int y,
                                         const Window& display) {
  std::vector<RoughReading> readings;
  for (const MotionDirection direction : {MotionDirection::previous, MotionDirection::next})
    for (const double sign_x : {1.0, -1.0})
      for (const double sign_y : {1.0, -1.0}) {
        RoughReading reading;
        reading.hypothesis.x = x;
        reading.hypothesis.y = y;
        reading.hypothesis.encoding = {0, 1, 1, sign_x, sign_y, MotionUnit::pixel, direction};
        std::map<int, std::vector<const FollowedPlace*>> pairs;
        for (const FollowedPlace& place : places)
          if (length(place.moved) > 1 && length(predicted(reading.hypothesis, place, display)) > 0)
            pairs[place.pair].push_back(&place);
        std::size_t agree = 0;
        for (const auto& [pair, moving] : pairs)
          if (moving.size() >= 4) add_pair(reading, pair, moving, display, agree);
        if (reading.places > 0) reading.agreement = double(agree) / double(reading.places);
        std::vector<double> factors;
        for (const PairScale& scale : reading.scales) {
          if (scale.along_x > 0) factors.push_back(scale.along_x);
          if (scale.along_y > 0) factors.push_back(scale.along_y);
        }
        if (const double middle = upper_median(factors); middle > 0) reading.hypothesis.encoding.scale = middle;
        readings.push_back(std::move(reading));
      }
  std::stable_sort(readings.begin(), readings.end(),
                   [](const RoughReading& a, const RoughReading& b) { return a.agreement > b.agreement; });
  return readings;
}

}  // namespace varve
