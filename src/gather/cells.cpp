// Compiled once per processor (VARVE_ISA). Sums run in eight lanes whatever the processor has, so the bits agree.
#include "gather/cells.h"

namespace varve::VARVE_ISA {
namespace {

typedef float Float8 __attribute__((vector_size(32)));
typedef int Int8 __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Float8 load8(const float* p) {
  Float8 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
[[gnu::always_inline]] inline void store8(float* p, Float8 v) { __builtin_memcpy(p, &v, sizeof v); }

/// e^x for -40 <= x <= 0, relative difference below 4e-7 - 6e-8 x, for x / ln 2 is rounded: 2^n by the exponent bits,
/// the rest by a polynomial (Taylor of 2^f around the middle of [-1/2, 1/2], six terms).
[[gnu::always_inline]] inline Float8 exponential(Float8 x) {
  const Float8 t = x * 1.44269504f;
  // Rounds to nearest: t is negative, so truncating t - 1/2 does it.
  const Int8 n = __builtin_convertvector(t - 0.5f, Int8);
  const Float8 f = t - __builtin_convertvector(n, Float8);
  Float8 p = f * 1.54035304e-4f + 1.33335581e-3f;
  p = p * f + 9.61812911e-3f;
  p = p * f + 5.55041087e-2f;
  p = p * f + 2.40226507e-1f;
  p = p * f + 6.93147181e-1f;
  p = p * f + 1.0f;
  const Int8 bits = (n + 127) << 23;
  Float8 power;
  __builtin_memcpy(&power, &bits, sizeof power);
  return p * power;
}

void axis_weights(const float* position, int count, const float* centers, int cells, float scale, float* weights,
                  std::ptrdiff_t stride) {
  for (int i = 0; i < count; i += kCellLanes) {
    const Float8 x = load8(position + i);
    for (int c = 0; c < cells; ++c) {
      const Float8 d = x - centers[c];
      Float8 e = d * d * -scale;
      e = e > -40.0f ? e : Float8{} - 40.0f;
      store8(weights + c * stride + i, exponential(e));
    }
  }
}

void cell_sums(const float* wx, const float* wy, std::ptrdiff_t stride, int count, int cells, float* sums) {
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      Float8 sum{};
      const float *x = wx + i * stride, *y = wy + j * stride;
      for (int k = 0; k < count; k += kCellLanes) sum += load8(x + k) * load8(y + k);
      sums[j * cells + i] = ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
    }
}

void sample_weights(const float* wx, const float* wy, std::ptrdiff_t stride, int count, int cells, const float* share,
                    float* weight) {
  for (int k = 0; k < count; k += kCellLanes) {
    Float8 sum{};
    for (int j = 0; j < cells; ++j) {
      Float8 row{};
      for (int i = 0; i < cells; ++i) row += load8(wx + i * stride + k) * share[j * cells + i];
      sum += row * load8(wy + j * stride + k);
    }
    store8(weight + k, sum);
  }
}

}  // namespace

const CellKernel cell_kernel{axis_weights, cell_sums, sample_weights};

}  // namespace varve::VARVE_ISA
