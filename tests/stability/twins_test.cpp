// Measured differences from the slow twins, and drift over thousands of frames; the long form is
// scripts/measure_stability.
#include <gtest/gtest.h>

#include "stability/soak.h"
#include "stability/twins.h"

namespace varve::stability {
namespace {

TEST(Twins, EveryPassIsWithinItsBound) {
  Workers workers(2);
  const std::vector<Measured> rows = measure_twins(false, workers);
  EXPECT_GT(rows.size(), 30u);
  for (const Measured& row : rows) {
    EXPECT_LE(row.worst, row.bound) << row.pass << ": " << row.where;
    EXPECT_GT(row.values, 0) << row.pass;
  }
}

TEST(Soak, DriftOfEveryRecursivePresetIsBounded) {
  Workers workers(1);
  const std::vector<SoakCase> cases = soak_cases();
  EXPECT_GE(cases.size(), 5u);
  for (const SoakCase& c : cases)
    for (const Sway sway : {Sway::rest, Sway::sway, Sway::pan}) {
      const Soaked soaked = soak(c.name, c.settings, sway, 400, workers);
      EXPECT_LE(soaked.worst, soaked.bound) << soaked.name;
    }
}

TEST(Soak, AHundredThousandFramesKeepTheirMean) {
  Workers workers(1);
  const Soaked mean = soak_mean(100000, workers), small = soak_small_alpha(20000, workers);
  EXPECT_LE(mean.worst, mean.bound);
  EXPECT_LE(small.worst, small.bound);
}

}  // namespace
}  // namespace varve::stability
