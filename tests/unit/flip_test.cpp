// FLIP and HDR-FLIP against figures of the published reference implementation.
#include "diagnose/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/hdr_flip.h"

namespace varve {
namespace {

double wave(double x, double y, int c) {
  return 0.5 + 0.4 * std::sin(0.21 * x + 0.11 * y + c) * std::cos(0.07 * x - 0.19 * y + 0.5 * c);
}
double reference_value(int x, int y, int c) { return wave(x, y, c); }
double test_value(int x, int y, int c) { return wave(x + 0.5, y + 0.25, c) + 0.02 * ((x / 8 + y / 8) % 2); }

template <class Value>
Plane<glm::vec4> picture(const Value& value) {
  Plane<glm::vec4> out(Window{0, 0, 96, 64});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      glm::vec4 pixel(1);
      for (int c = 0; c < 3; ++c) pixel[c] = float(value(x, y, c));
      out.at(x, y) = pixel;
    }
  return out;
}

float greatest(const Plane<float>& map) {
  float most = 0;
  for (int y = 0; y < 64; ++y) most = std::max(most, *std::max_element(map.row(y), map.row(y) + 96));
  return most;
}

class Flip : public testing::Test {
 protected:
  Workers workers{2};
};

TEST_F(Flip, MatchesTheReferenceImplementation) {
  const auto a = picture(reference_value), b = picture(test_value);
  const Plane<float> map = flip_map(a, b, {}, workers);
  EXPECT_NEAR(mean_of(map, workers), 0.156802, 1e-6);
  EXPECT_NEAR(double(greatest(map)), 0.289350, 2e-6);
  EXPECT_NEAR(double(map.at(10, 10)), 0.173811, 2e-6);
}

TEST_F(Flip, MatchesTheReferenceImplementationInHighRange) {
  const auto hdr = [](auto value) {
    return [value](int x, int y, int c) { return std::exp2(8 * value(x, y, c) - 4); };
  };
  const auto a = picture(hdr(reference_value)), b = picture(hdr(test_value));
  const ExposureRange range = exposure_range(a);
  EXPECT_NEAR(range.first, -1.8054, 1e-4);
  EXPECT_NEAR(range.last, 0.8790, 1e-4);
  EXPECT_EQ(range.count, 3);
  const Plane<float> map = hdr_flip_map(a, b, {}, range, workers);
  EXPECT_NEAR(mean_of(map, workers), 0.237012, 1e-6);
  EXPECT_NEAR(double(greatest(map)), 0.447970, 2e-6);
  EXPECT_NEAR(double(map.at(10, 10)), 0.241820, 2e-6);
}

TEST_F(Flip, IsZeroForEqualPicturesAndOneWhereBad) {
  const auto a = picture(reference_value);
  Plane<std::uint8_t> bad(a.window(), 0, 0);
  bad.at(3, 4) = 1;
  const Plane<float> map = flip_map(a, a, bad, workers);
  EXPECT_EQ(map.at(3, 4), 1);
  EXPECT_DOUBLE_EQ(mean_of(map, workers), 1.0 / (96 * 64));
}

TEST_F(Flip, BlackAndBlindingReferencesHaveAFiniteRange) {
  const auto black = picture([](int, int, int) { return 0.0; });
  const auto blinding =
      picture([](int x, int, int) { return x == 0 ? double(std::numeric_limits<float>::max()) : 0.0; });
  for (const auto* reference : {&black, &blinding}) {
    const ExposureRange range = exposure_range(*reference);
    EXPECT_TRUE(std::isfinite(range.first) && std::isfinite(range.last));
    EXPECT_GE(range.count, 2);
    EXPECT_LE(range.count, 40);
    const double mean = mean_of(hdr_flip_map(*reference, black, {}, range, workers), workers);
    EXPECT_GE(mean, 0);
    EXPECT_LE(mean, 1);
    EXPECT_EQ(mean == 0, reference == &black);
  }
}

TEST_F(Flip, ThreadsDoNotChangeABit) {
  const auto a = picture(reference_value), b = picture(test_value);
  Workers one(1);
  EXPECT_EQ(mean_of(flip_map(a, b, {}, one), one), mean_of(flip_map(a, b, {}, workers), workers));
}

}  // namespace
}  // namespace varve
