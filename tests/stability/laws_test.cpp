// Every law asked of every pass.
#include <gtest/gtest.h>

#include "stability/laws.h"

namespace varve::stability {
namespace {

TEST(Laws, EveryPassIsFiniteWhateverItIsGiven) {
  Workers workers(1);
  LawCounts counts;
  const Window odd{-5, -9, 14, 4};
  const std::vector<Extreme> all = extremes();
  for (const Pass& pass : all_passes())
    for (const Extreme& extreme : all)
      EXPECT_EQ(broken_finite(pass, extreme.make(odd), workers, counts), "") << pass.name << ", " << extreme.name;
  RecordProperty("runs", std::to_string(counts.runs));
  EXPECT_GT(counts.runs, 3000);
}

TEST(Laws, EveryPassTakesEverySize) {
  Workers workers(2);
  LawCounts counts;
  for (const Window& window : awkward_windows(false))
    for (const Pass& pass : all_passes())
      EXPECT_EQ(broken_finite(pass, base_shot(window, Moves::any, 3, 30, true), workers, counts), "")
          << pass.name << ", " << window.width() << "x" << window.height();
}

TEST(Laws, WidePicturesAreFinite) {
  Workers workers(2);
  LawCounts counts;
  for (const int rows : {1, 3}) {
    const RawShot shot = base_shot({0, 0, 16384, rows}, Moves::any, 2, 31);
    for (const Pass& pass : few_passes())
      EXPECT_EQ(broken_finite(pass, shot, workers, counts), "") << pass.name << ", " << rows;
  }
}

TEST(Laws, AllHalfValuesAreFinite) {
  Workers workers(2);
  LawCounts counts;
  RawShot shot = all_halves();
  shot.resize(2);
  for (const Pass& pass : few_passes()) EXPECT_EQ(broken_finite(pass, shot, workers, counts), "") << pass.name;
}

TEST(Laws, ABadPixelReachesNoFartherThanThePassReads) {
  Workers workers(1);
  LawCounts counts;
  for (const Pass& pass : all_passes())
    for (const bool moves : {false, true})
      EXPECT_EQ(broken_footprint(pass, moves, workers, counts), "") << pass.name << (moves ? ", moving" : ", at rest");
}

TEST(Laws, LightTimesAPowerOfTwoIsTheResultTimesIt) {
  Workers workers(1);
  LawCounts counts;
  for (const Pass& pass : all_passes()) {
    if (!pass.scales) continue;
    for (const int exponent : {20, -20, 1})
      EXPECT_EQ(broken_scale(pass, exponent, workers, counts), "") << pass.name << ", 2^" << exponent;
  }
}

TEST(Laws, AMirrorChangesNothingButTheSides) {
  Workers workers(1);
  LawCounts counts;
  for (const Pass& pass : all_passes()) {
    if (pass.mirror < 0) continue;
    for (const bool vertical : {false, true})
      EXPECT_EQ(broken_mirror(pass, vertical, workers, counts), "") << pass.name << (vertical ? ", rows" : ", columns");
  }
}

TEST(Laws, OneColorStaysThatColor) {
  Workers workers(1);
  LawCounts counts;
  for (const Pass& pass : all_passes()) {
    if (!pass.constant) continue;
    for (const float value : {1.0f, 0.1f, 65504.0f, 1000.1f, 1e-30f, 3e-39f, -0.7f, 1e30f, 0.0f})
      EXPECT_EQ(broken_constancy(pass, {value, value * 0.3f, value * 0.77f, 1}, workers, counts), "")
          << pass.name << ", " << value;
  }
}

TEST(Laws, ThreadsChangeNoByte) {
  LawCounts counts;
  for (const Pass& pass : all_passes()) EXPECT_EQ(broken_threads(pass, counts), "") << pass.name;
}

}  // namespace
}  // namespace varve::stability
