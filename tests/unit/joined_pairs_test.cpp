// Vectors to both sides settle which way they lead where the pixels cannot.
#include <gtest/gtest.h>

#include <random>

#include "motion/joined_pairs.h"

namespace varve {
namespace {

constexpr Window kDisplay{0, 0, 320, 180};

/// Places whose motion changes by `change` px a frame and frame: channels 0, 1 lead to the previous frame, 2, 3 to the
/// next one, with `sign` before them. The pixels are measured to a fifth of a pixel.
std::vector<FollowedPlace> shot(double change, double sign) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.2);
  std::vector<FollowedPlace> places;
  for (int pair = 0; pair < 4; ++pair)
    for (int i = 0; i < 100; ++i) {
      const auto step = [&](int frame) {
        return glm::dvec2(4 + 0.02 * i + change * frame, 0.03 * i - 2.5 - change * frame);
      };
      FollowedPlace p;
      p.pair = pair;
      p.moved = -step(pair) + glm::dvec2(noise(random), noise(random));
      const auto store = [&](int frame) {
        const glm::dvec2 back = -step(frame), on = sign * step(frame + 1);
        return StoredValues{float(back.x), float(back.y), float(on.x), float(on.y)};
      };
      p.here = store(pair);
      p.there = store(pair - 1);
      places.push_back(p);
    }
  return places;
}

TEST(JoinedPairs, ALittleAccelerationTellsTheDirection) {
  for (const double sign : {1.0, -1.0}) {
    const std::vector<FollowedPlace> places = shot(0.03, sign);
    ChannelRanking first = rank_hypotheses(places, 0, 1, kDisplay), second = rank_hypotheses(places, 2, 3, kDisplay);
    ASSERT_EQ(first.finding, VectorFinding::ambiguous);
    EXPECT_TRUE(same_here(first));
    const JoinedPairs joined = join_pairs(places, {0, 1}, {2, 3}, 0);
    ASSERT_TRUE(joined.tells);
    EXPECT_TRUE(joined.first_previous);
    EXPECT_EQ(joined.negated, sign < 0);
    settle_joined(first, second, joined);
    ASSERT_EQ(first.finding, VectorFinding::found);
    ASSERT_EQ(second.finding, VectorFinding::found);
    EXPECT_GT(first.confidence, 0.6);
    EXPECT_EQ(first.ranking.front().hypothesis.encoding.direction, MotionDirection::previous);
    EXPECT_EQ(first.ranking.front().hypothesis.encoding.sign_x, 1);
    EXPECT_EQ(second.ranking.front().hypothesis.encoding.direction, MotionDirection::next);
    EXPECT_EQ(second.ranking.front().hypothesis.encoding.sign_x, sign);

    // The pairs the other way round.
    const JoinedPairs turned = join_pairs(places, {2, 3}, {0, 1}, 0);
    ASSERT_TRUE(turned.tells);
    EXPECT_FALSE(turned.first_previous);
  }
}

TEST(JoinedPairs, SteadyMotionAndOtherChannelsTellNothing) {
  EXPECT_FALSE(join_pairs(shot(0, 1), {0, 1}, {2, 3}, 0).tells);
  std::vector<FollowedPlace> places = shot(0.03, 1);
  EXPECT_FALSE(join_pairs(places, {0, 1}, {0, 1}, 0).tells);  // the same channels twice
  for (std::size_t i = 0; i < places.size(); ++i)             // no way to anywhere
    places[i].there[2] = float(i % 17), places[i].here[3] = float(i % 5);
  EXPECT_FALSE(join_pairs(places, {0, 1}, {2, 3}, 0).tells);
  // One pair of frames that says otherwise is enough for silence.
  places = shot(0.03, 1);
  for (FollowedPlace& p : places)
    if (p.pair == 2) p.here = {-p.there[2] + 0.1f, -p.there[3], -p.there[0], -p.there[1]};
  EXPECT_FALSE(join_pairs(places, {0, 1}, {2, 3}, 0).tells);
}

}  // namespace
}  // namespace varve
