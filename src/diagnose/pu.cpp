#include "diagnose/pu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace varve {
namespace {

constexpr double kLowest = 0.005, kHighest = 10000;
constexpr std::uint32_t kShift = 15;
constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(float(kLowest)) >> kShift;
constexpr std::uint32_t kLast = (std::bit_cast<std::uint32_t>(float(kHighest)) >> kShift) + 1;

/// The fit itself, which the table follows to the knots just beyond its ends.
double curve(double luminance) {
  constexpr double p1 = 0.353487901, p2 = 0.3734658629, p3 = 8.277049286e-5, p4 = 0.9062562627, p5 = 0.09150303166,
                   p6 = 0.9099517204, p7 = 596.3148142;
  const double y = std::pow(luminance, p4);
  return p7 * (std::pow((p1 + p2 * y) / (1 + p3 * y), p5) - p6);
}

}  // namespace

double pu_encode(double luminance) { return curve(luminance > kLowest ? std::min(luminance, kHighest) : kLowest); }

PuTable::PuTable() {
  codes_.reserve(kLast - kFirst + 1);
  for (std::uint32_t i = kFirst; i <= kLast; ++i)
    codes_.push_back(float(curve(double(std::bit_cast<float>(i << kShift)))));
}

float PuTable::encode(float luminance) const {
  const float y = luminance > float(kLowest) ? std::min(luminance, float(kHighest)) : float(kLowest);
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(y);
  const float part = float(bits & ((1u << kShift) - 1)) / float(1u << kShift);
  const float* code = codes_.data() + ((bits >> kShift) - kFirst);
  return code[0] + part * (code[1] - code[0]);
}

}  // namespace varve
