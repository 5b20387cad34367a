#include "exr/convert.h"

#include <Imath/half.h>

#include <cmath>
#include <cstring>

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace varve {
namespace {

constexpr float kLargestHalf = 65504.0f;

void halves_to_float_plain(const std::byte* from, float* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t bits;
    std::memcpy(&bits, from + 2 * i, 2);
    to[i] = imath_half_to_float(bits);
  }
}

std::size_t floats_to_half_plain(const float* from, std::uint16_t* to, std::size_t count) {
  std::size_t clamped = 0;
  for (std::size_t i = 0; i < count; ++i) {
    float value = from[i];
    const bool beyond = std::abs(value) > kLargestHalf && std::abs(value) < INFINITY;
    if (beyond) value = std::copysign(kLargestHalf, value);
    clamped += beyond;
    to[i] = imath_float_to_half(value);
  }
  return clamped;
}

#if defined(__x86_64__)

bool has_f16c() {
  // Not every compiler's __builtin_cpu_supports knows f16c.
  static const bool has = [] {
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __builtin_cpu_supports("avx") && __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
  }();
  return has;
}

[[gnu::target("avx,f16c")]] void halves_to_float_f16c(const std::byte* from, float* to, std::size_t count) {
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8)
    _mm256_storeu_ps(to + i, _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from + 2 * i))));
  halves_to_float_plain(from + 2 * i, to + i, count - i);
}

[[gnu::target("avx,f16c")]] std::size_t floats_to_half_f16c(const float* from, std::uint16_t* to, std::size_t count) {
  const __m256 sign = _mm256_set1_ps(-0.0f), largest = _mm256_set1_ps(kLargestHalf);
  const __m256 infinity = _mm256_set1_ps(INFINITY);
  std::size_t clamped = 0, i = 0;
  for (; i + 8 <= count; i += 8) {
    __m256 value = _mm256_loadu_ps(from + i);
    const __m256 magnitude = _mm256_andnot_ps(sign, value);
    const __m256 beyond =
        _mm256_and_ps(_mm256_cmp_ps(magnitude, largest, _CMP_GT_OQ), _mm256_cmp_ps(magnitude, infinity, _CMP_LT_OQ));
    const __m256 nearest = _mm256_or_ps(_mm256_and_ps(sign, value), largest);
    value = _mm256_blendv_ps(value, nearest, beyond);
    clamped += std::size_t(__builtin_popcount(unsigned(_mm256_movemask_ps(beyond))));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to + i), _mm256_cvtps_ph(value, _MM_FROUND_TO_NEAREST_INT));
  }
  return clamped + floats_to_half_plain(from + i, to + i, count - i);
}

#endif

}  // namespace

void to_float(PixelType type, const std::byte* from, float* to, std::size_t count) {
  switch (type) {
    case PixelType::float32:
      std::memcpy(to, from, count * sizeof(float));
      return;
    case PixelType::uint32:
      for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t value;
        std::memcpy(&value, from + 4 * i, 4);
        to[i] = float(value);
      }
      return;
    case PixelType::float16:
#if defined(__x86_64__)
      if (has_f16c()) return halves_to_float_f16c(from, to, count);
#endif
      return halves_to_float_plain(from, to, count);
  }
}

std::size_t to_half_clamped(const float* from, std::uint16_t* to, std::size_t count) {
#if defined(__x86_64__)
  if (has_f16c()) return floats_to_half_f16c(from, to, count);
#endif
  return floats_to_half_plain(from, to, count);
}

}  // namespace varve
