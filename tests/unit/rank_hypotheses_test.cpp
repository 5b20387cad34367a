// Which reading of vectors measured motion speaks for: injected into places with known motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "motion/rank_hypotheses.h"

namespace varve {
namespace {

constexpr Window kDisplay{0, 0, 320, 180};

/// Motion of a shot whose speed changes with time, so that both directions differ.
glm::dvec2 velocity(const glm::dvec2& at, int frame, double change) {
  return {(3 + change * frame) * (1 + 0.002 * at.x), -2 + 0.01 * at.y - change * frame};
}

struct Shot {
  double change = 1;    ///< px a frame and frame
  bool along_y = true;  ///< else nothing moves along y
  double lost = 0.2;    ///< share of places found somewhere else
};

std::vector<FollowedPlace> inject(const VectorHypothesis& truth, const Shot& shot) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> noise(0, 0.2);
  std::vector<FollowedPlace> places;
  const MotionEncoding& e = truth.encoding;
  const double share = e.unit == MotionUnit::ndc ? 0.5 : 1;
  const double wide = e.unit == MotionUnit::pixel ? 1 : share * kDisplay.width();
  const double high = e.unit == MotionUnit::pixel ? 1 : share * kDisplay.height();
  for (int pair = 0; pair < 4; ++pair)
    for (int i = 0; i < 150; ++i) {
      FollowedPlace p;
      p.pair = pair;
      p.at = {320 * unit(random), 180 * unit(random)};
      p.jitter = {unit(random) > 2 ? 0 : 0.3 - 0.2 * pair, 0.25 * pair - 0.4};
      const auto move = [&](int frame) {
        glm::dvec2 v = velocity(p.at, frame, shot.change);
        return shot.along_y ? v : glm::dvec2(v.x, 0);
      };
      const glm::dvec2 back = -move(2 * pair);        // over the pair
      const glm::dvec2 before = -move(2 * pair - 1);  // from the earlier frame on back
      const glm::dvec2 after = -move(2 * pair + 1);   // from here on, turned round
      p.moved = back + glm::dvec2(noise(random), noise(random));
      if (unit(random) < shot.lost) p.moved = {20 * unit(random) - 10, 20 * unit(random) - 10};
      const bool previous = e.direction == MotionDirection::previous;
      const auto store = [&](glm::dvec2 motion) {
        StoredValues values{};
        values[std::size_t(truth.x)] = float(e.bias + e.sign_x * motion.x / (e.scale * wide));
        values[std::size_t(truth.y)] = float(e.bias + e.sign_y * motion.y / (e.scale * high));
        return values;
      };
      const glm::dvec2 with = double(truth.jitter) * p.jitter;
      p.here = store(previous ? back + with : -after - with);
      p.there = store(previous ? before + with : -back - with);
      places.push_back(p);
    }
  return places;
}

bool same(const VectorHypothesis& a, const VectorHypothesis& b) {
  return a.x == b.x && a.jitter == b.jitter && a.encoding.direction == b.encoding.direction &&
         a.encoding.sign_x == b.encoding.sign_x && a.encoding.sign_y == b.encoding.sign_y &&
         a.encoding.bias == b.encoding.bias && a.encoding.unit == b.encoding.unit &&
         std::abs(a.encoding.scale / b.encoding.scale - 1) < 0.03;
}

TEST(RankHypotheses, FindsEachReadingWhereSpeedChanges) {
  int tried = 0;
  const std::vector<VectorHypothesis> all = vector_hypotheses(0, 1, false);
  for (std::size_t i = 0; i < all.size(); i += 5) {  // a subset that meets every form, direction, order and sign
    VectorHypothesis truth = all[i];
    if (truth.scale_free) truth.encoding.scale = truth.encoding.bias != 0 ? 37 : 3.1;
    if (truth.scale_free && truth.encoding.unit != MotionUnit::pixel) truth.encoding.scale *= 0.01;
    const ChannelRanking ranking = rank_hypotheses(inject(truth, {}), 0, 1, kDisplay);
    // An open scale leaves room for another one along the other axis; a scale as the unit says does not.
    if (truth.scale_free) {
      const bool among = std::any_of(ranking.ranking.begin(), ranking.ranking.end(), [&](const RankedHypothesis& r) {
        return (r.rival || &r == &ranking.ranking.front()) && same(r.hypothesis, truth);
      });
      EXPECT_TRUE(among) << words_of(truth) << " taken for " << words_of(ranking.ranking.front().hypothesis);
    } else {
      ASSERT_EQ(ranking.finding, VectorFinding::found) << words_of(truth);
      EXPECT_TRUE(same(ranking.ranking.front().hypothesis, truth))
          << words_of(truth) << " taken for " << words_of(ranking.ranking.front().hypothesis);
      EXPECT_GT(ranking.confidence, 0.6) << words_of(truth);
    }
    ++tried;
  }
  EXPECT_GT(tried, 30);
}

TEST(RankHypotheses, TellsJitterInTheVectors) {
  VectorHypothesis truth;
  truth.jitter = 1;
  const ChannelRanking ranking = rank_hypotheses(inject(truth, {}), 0, 1, kDisplay);
  ASSERT_FALSE(ranking.ranking.empty());
  EXPECT_EQ(ranking.ranking.front().hypothesis.jitter, 1);
}

TEST(RankHypotheses, SteadyMotionLeavesTheDirectionOpen) {
  const VectorHypothesis truth;
  const ChannelRanking ranking = rank_hypotheses(inject(truth, {.change = 0}), 0, 1, kDisplay);
  EXPECT_EQ(ranking.finding, VectorFinding::ambiguous);
  EXPECT_EQ(ranking.confidence, 0);
  ASSERT_EQ(left_open(ranking).size(), 1u);
  EXPECT_TRUE(left_open(ranking)[0].starts_with("direction"));
}

TEST(RankHypotheses, AnAxisAlongWhichNothingMovesIsNamed) {
  const ChannelRanking ranking = rank_hypotheses(inject({}, {.along_y = false}), 0, 1, kDisplay);
  EXPECT_EQ(ranking.finding, VectorFinding::ambiguous);
  const std::vector<std::string> open = left_open(ranking);
  EXPECT_TRUE(std::any_of(open.begin(), open.end(), [](const std::string& s) { return s.starts_with("sign of y"); }));
  EXPECT_TRUE(std::none_of(open.begin(), open.end(), [](const std::string& s) { return s.starts_with("sign of x"); }));
}

TEST(RankHypotheses, ContradictoryPairsChooseNothing) {
  std::vector<FollowedPlace> places = inject({}, {});
  VectorHypothesis turned;
  turned.encoding.sign_x = turned.encoding.sign_y = -1;
  const std::vector<FollowedPlace> others = inject(turned, {});
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].pair == 3) places[i].here = others[i].here, places[i].there = others[i].there;
  const ChannelRanking ranking = rank_hypotheses(places, 0, 1, kDisplay);
  EXPECT_EQ(ranking.finding, VectorFinding::contradictory);
  EXPECT_EQ(ranking.contradicting, std::vector<int>{3});
}

TEST(RankHypotheses, NothingWinsWhereVectorsHaveNothingToDoWithIt) {
  std::vector<FollowedPlace> places = inject({}, {});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-5, 5);
  for (FollowedPlace& p : places)
    for (StoredValues* values : {&p.here, &p.there}) *values = {any(random), any(random), 0, 0};
  EXPECT_EQ(rank_hypotheses(places, 0, 1, kDisplay).finding, VectorFinding::nothing);
}

TEST(RankHypotheses, TooFewPlacesAreNoEvidence) {
  std::vector<FollowedPlace> places = inject({}, {});
  places.resize(kFewestPlaces - 1);
  EXPECT_EQ(rank_hypotheses(places, 0, 1, kDisplay).finding, VectorFinding::untestable);
}

TEST(RankHypotheses, AFactorThatChangesIsRough) {
  std::vector<FollowedPlace> places = inject({}, {.lost = 0});
  for (FollowedPlace& p : places)
    for (StoredValues* values : {&p.here, &p.there})
      for (float& v : *values) v /= float(1.7 + 0.6 * p.pair);
  const ChannelRanking ranking = rank_hypotheses(places, 0, 1, kDisplay);
  EXPECT_EQ(ranking.finding, VectorFinding::rough);
  EXPECT_EQ(ranking.ranking.front().scales.size(), 4u);
}

}  // namespace
}  // namespace varve
