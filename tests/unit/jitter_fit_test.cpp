// Offsets from shifts, and every usual mistake in a stated jitter told from the others.
#include "diagnose/jitter_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exr/jitter_pattern.h"

namespace varve {
namespace {

using Stated = std::vector<std::optional<glm::dvec2>>;

Stated pattern(const char* name, int frames) {
  const NamedPattern named = *parse_pattern(name);
  PatternRequest request;
  if (named.length > 0) request.length = named.length;
  const std::vector<Jitter> points = named.pattern->points(request);
  Stated stated;
  for (int f = 0; f < frames; ++f) {
    const Jitter& p = points[std::size_t(f) % points.size()];
    stated.push_back(glm::dvec2(p.x, p.y));
  }
  return stated;
}

/// Shifts between frames up to three apart, wrong by up to `noise` px in a way that repeats.
std::vector<ShiftBetween> shifts_of(const std::vector<glm::dvec2>& truth, double noise) {
  std::vector<ShiftBetween> shifts;
  unsigned state = 1;
  const auto next = [&] { return noise * (double((state = state * 1664525u + 1013904223u) >> 8) / 8388608.0 - 1); };
  for (std::size_t i = 1; i < truth.size(); ++i)
    for (std::size_t k = 1; k <= 3 && k <= i; ++k)
      shifts.push_back({i, i - k, truth[i] - truth[i - k] + glm::dvec2(next(), next()), glm::dvec2(0.02)});
  return shifts;
}

std::vector<glm::dvec2> values(const Stated& stated) {
  std::vector<glm::dvec2> all;
  for (const auto& j : stated) all.push_back(*j);
  return all;
}

TEST(OffsetFit, FindsOffsetsUpToTheirMeanAndLeavesOutliersOut) {
  const std::vector<glm::dvec2> truth = values(pattern("halton23:16", 16));
  std::vector<ShiftBetween> shifts = shifts_of(truth, 0.01);
  shifts[7].shift += glm::dvec2(0.8, -0.9);
  const OffsetFit fit = fit_offsets(truth.size(), shifts);
  ASSERT_EQ(fit.known, truth.size());
  glm::dvec2 mean(0);
  for (const glm::dvec2& t : truth) mean += t / double(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(fit.offsets[i].x, truth[i].x - mean.x, 0.03) << i;
    EXPECT_NEAR(fit.offsets[i].y, truth[i].y - mean.y, 0.03) << i;
  }
}

TEST(OffsetFit, FramesThatNothingConnectsAreLeftOut) {
  const std::vector<glm::dvec2> truth = values(pattern("halton23:16", 6));
  std::vector<ShiftBetween> shifts = shifts_of(truth, 0);
  std::erase_if(shifts, [](const ShiftBetween& s) { return s.now == 5; });
  const OffsetFit fit = fit_offsets(truth.size(), shifts);
  EXPECT_EQ(fit.known, 5u);
  EXPECT_TRUE(std::isnan(fit.offsets[5].x));
  EXPECT_EQ(fit_offsets(3, {}).known, 0u);
  EXPECT_EQ(fit_offsets(0, {}).known, 0u);
}

TEST(JudgeJitter, EveryUsualMistakeIsFound) {
  struct Case {
    double xx, xy, yx, yy;
    int later;
    const char* says;
  };
  const Case cases[] = {{2, 0, 0, 2, 0, "twice"},       {0.5, 0, 0, 0.5, 0, "half as far"},
                        {-1, 0, 0, 1, 0, "x is"},       {1, 0, 0, -1, 0, "y is"},
                        {-1, 0, 0, -1, 0, "both axes"}, {0, 1, 1, 0, 0, "swapped"},
                        {1, 0, 0, 1, 1, "f+1"},         {1, 0, 0, 1, -1, "f-1"}};
  for (const char* name : {"halton23:16", "halton23:8", "r2:16"}) {
    const Stated stated = pattern(name, 16);
    for (const Case& c : cases) {
      std::vector<glm::dvec2> truth(stated.size(), glm::dvec2(0));
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const std::size_t from = (i + truth.size() + std::size_t(c.later + 16)) % truth.size();
        truth[i] = {c.xx * stated[from]->x + c.xy * stated[from]->y, c.yx * stated[from]->x + c.yy * stated[from]->y};
      }
      const JitterVerdict v = judge_jitter(stated, shifts_of(truth, 0.05));
      EXPECT_EQ(v.kind, JitterVerdict::Kind::mistaken) << name << " " << c.says;
      EXPECT_NE(v.mistake.sentence.find(c.says), std::string::npos) << name << ": " << v.mistake.sentence;
    }
    EXPECT_EQ(judge_jitter(stated, shifts_of(values(stated), 0.05)).kind, JitterVerdict::Kind::fits) << name;
    const std::vector<glm::dvec2> rest(stated.size(), glm::dvec2(0.25));
    EXPECT_EQ(judge_jitter(stated, shifts_of(rest, 0.01)).kind, JitterVerdict::Kind::at_rest) << name;
  }
}

TEST(JudgeJitter, NothingIsChosenWhereNothingExplainsOrTwoThingsDo) {
  const Stated stated = pattern("halton23:16", 16);
  EXPECT_EQ(judge_jitter(stated, shifts_of(values(pattern("random:16", 16)), 0.02)).kind,
            JitterVerdict::Kind::unexplained);
  // Two positions in turns: both axes turned round is the same as one frame late.
  const Stated two = pattern("two-frame", 12);
  std::vector<glm::dvec2> turned;
  for (const auto& j : two) turned.push_back(-*j);
  const JitterVerdict v = judge_jitter(two, shifts_of(turned, 0.01));
  EXPECT_NE(v.kind, JitterVerdict::Kind::fits);
  EXPECT_EQ(judge_jitter(two, shifts_of(values(two), 0.01)).kind, JitterVerdict::Kind::fits);
  EXPECT_EQ(judge_jitter({}, {}).kind, JitterVerdict::Kind::cannot_tell);
  EXPECT_EQ(judge_jitter(Stated(16), shifts_of(turned, 0.01)).kind, JitterVerdict::Kind::cannot_tell);
}

}  // namespace
}  // namespace varve
