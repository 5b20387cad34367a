// Half and float, against Imath, for every class of number; both code paths are reached through odd lengths.
#include "exr/convert.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace varve {
namespace {

TEST(Convert, AllHalvesBecomeTheSameFloats) {
  std::vector<std::uint16_t> halves(65536);
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = std::uint16_t(i);
  std::vector<float> whole(halves.size()), single(halves.size());
  to_float(PixelType::float16, reinterpret_cast<const std::byte*>(halves.data()), whole.data(), halves.size());
  for (std::size_t i = 0; i < halves.size(); ++i) {
    to_float(PixelType::float16, reinterpret_cast<const std::byte*>(&halves[i]), &single[i], 1);
    const float truth = imath_half_to_float(halves[i]);
    for (float value : {whole[i], single[i]}) {
      if (std::isnan(truth))
        EXPECT_TRUE(std::isnan(value));
      else
        EXPECT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(truth)) << i;
    }
  }
}

TEST(Convert, FloatsBecomeTheNearestHalfWithinItsRange) {
  std::vector<float> floats;
  // Every half, its neighbors among floats, and the midpoints to the next half.
  for (unsigned i = 0; i < 65536; ++i) {
    const float f = imath_half_to_float(std::uint16_t(i)), g = imath_half_to_float(std::uint16_t(i + 1));
    for (float value : {f, std::nextafter(f, 1e30f), std::nextafter(f, -1e30f), (f + g) / 2}) floats.push_back(value);
  }
  for (float value :
       {65504.0f, 65519.99f, 65520.0f, 65536.0f, 1e30f, 3.4028235e38f, 1e-45f, 1e-38f, INFINITY, NAN, 0.0f})
    for (float sign : {1.0f, -1.0f}) floats.push_back(sign * value);
  std::mt19937 random(3);
  for (int i = 0; i < 1000003; ++i) floats.push_back(std::bit_cast<float>(std::uint32_t(random())));

  std::vector<std::uint16_t> halves(floats.size());
  const std::size_t clamped = to_half_clamped(floats.data(), halves.data(), floats.size());
  std::size_t beyond = 0, wrong = 0, wrong_single = 0;
  for (std::size_t i = 0; i < floats.size(); ++i) {
    const float f = floats[i];
    const bool over = std::isfinite(f) && std::abs(f) > 65504.0f;
    beyond += over;
    const std::uint16_t truth = imath_float_to_half(over ? std::copysign(65504.0f, f) : f);
    std::uint16_t single;
    EXPECT_EQ(to_half_clamped(&f, &single, 1), std::size_t(over));
    const auto is_nan = [](std::uint16_t h) { return (h & 0x7fff) > 0x7c00; };
    wrong += std::isnan(f) ? !is_nan(halves[i]) : halves[i] != truth;
    wrong_single += std::isnan(f) ? !is_nan(single) : single != truth;
  }
  EXPECT_EQ(clamped, beyond);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(wrong_single, 0u);
}

TEST(Convert, UintsAndFloats) {
  const std::uint32_t ids[] = {0, 1, 16777216, 16777217, 16777219, 4294967295u};
  float out[6];
  to_float(PixelType::uint32, reinterpret_cast<const std::byte*>(ids), out, 6);
  EXPECT_EQ(out[2], 16777216.0f);
  EXPECT_EQ(out[3], 16777216.0f);
  EXPECT_EQ(out[4], 16777220.0f);
  EXPECT_EQ(out[5], 4294967296.0f);
  const std::uint32_t bits[] = {0x7fa12345u, 1u, 0x80000000u};
  to_float(PixelType::float32, reinterpret_cast<const std::byte*>(bits), out, 3);
  EXPECT_EQ(std::memcmp(bits, out, 12), 0);
}

}  // namespace
}  // namespace varve
