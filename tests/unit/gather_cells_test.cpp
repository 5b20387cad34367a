// The kernel of the gather's cells: its exponential, and that processors agree.
#include "gather/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace varve {
namespace {

TEST(GatherCells, TheExponentialIsOne) {
  const int count = 40000;
  std::vector<float> position(count), weight(count);
  for (int i = 0; i < count; ++i) position[std::size_t(i)] = float(std::sqrt(40.0 * i / (count - 1)));
  const float center = 0;
  baseline::cell_kernel.axis_weights(position.data(), count, &center, 1, 1, weight.data(), count);
  double worst = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double x = std::max(double(-position[i] * position[i]), -40.0), truth = std::exp(x);
    // The product of x and 1/ln 2 is rounded to float before its integer part is taken off.
    worst = std::max(worst, std::fabs(double(weight[i]) / truth - 1) / (4e-7 + 6e-8 * -x));
  }
  EXPECT_LT(worst, 1);
  RecordProperty("worst", std::to_string(worst));
  EXPECT_EQ(weight[0], 1.0f);
}

TEST(GatherCells, FarSamplesKeepAFloor) {
  const float position[kCellLanes] = {7, 100, 1e6f, 1e18f, -7, -1e6f, 1e30f, -3e38f}, center = 0;
  float weight[kCellLanes];
  baseline::cell_kernel.axis_weights(position, kCellLanes, &center, 1, 60, weight, kCellLanes);
  for (const float w : weight) {
    EXPECT_GE(w, 4e-18f);
    EXPECT_LT(w, 5e-18f);
    EXPECT_GT(w * w, 1e-37f);
  }
}

#ifdef VARVE_HAVE_AVX2
TEST(GatherCells, ProcessorsAgreeBitForBit) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(5);
  std::uniform_real_distribution<float> near(-1.5f, 1.5f);
  const int count = 72;
  const auto size = std::size_t(count);
  for (const int cells : {1, 3, 4, 8}) {
    std::vector<float> position(size), centers(std::size_t(cells)), share(std::size_t(cells * cells));
    for (float& x : position) x = near(random);
    for (float& x : centers) x = near(random);
    for (float& x : share) x = near(random);
    const auto run = [&](const CellKernel& kernel) {
      std::vector<float> all(size * std::size_t(cells)), sums(share.size()), weight(size);
      kernel.axis_weights(position.data(), count, centers.data(), cells, 31.7f, all.data(), count);
      kernel.cell_sums(all.data(), all.data(), count, count, cells, sums.data());
      kernel.sample_weights(all.data(), all.data(), count, count, cells, share.data(), weight.data());
      all.insert(all.end(), sums.begin(), sums.end());
      all.insert(all.end(), weight.begin(), weight.end());
      return all;
    };
    const std::vector<float> one = run(baseline::cell_kernel), other = run(avx2::cell_kernel);
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(float)), 0) << cells;
  }
}
#endif

}  // namespace
}  // namespace varve
