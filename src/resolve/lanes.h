// Four channels at a time: RGBA as one value. Everything here is inlined into the kernel of one processor.
#pragma once

#ifndef VARVE_ISA
#error "lanes.h belongs into files that are compiled once per processor"
#endif

// Internal linkage and forced inlining: code compiled for a newer processor must never be shared with other files.
#define VARVE_INLINE [[gnu::always_inline]] static inline

namespace varve::VARVE_ISA {

typedef float Float4 __attribute__((vector_size(16)));
typedef double Double4 __attribute__((vector_size(32)));
typedef long long Mask4 __attribute__((vector_size(32)));

VARVE_INLINE Float4 load(const float* p) {
  Float4 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
VARVE_INLINE void store(float* p, Float4 v) { __builtin_memcpy(p, &v, sizeof v); }
VARVE_INLINE Float4 splat(float v) { return Float4{v, v, v, v}; }
VARVE_INLINE Double4 splat(double v) { return Double4{v, v, v, v}; }
VARVE_INLINE Double4 widen(Float4 v) { return __builtin_convertvector(v, Double4); }
VARVE_INLINE Float4 narrow(Double4 v) { return __builtin_convertvector(v, Float4); }
// GCC makes a comparison and a blend of a vector `a < b ? a : b`; the instruction does just that.
#if defined(__SSE2__)
VARVE_INLINE Float4 least(Float4 a, Float4 b) { return __builtin_ia32_minps(a, b); }
VARVE_INLINE Float4 greatest(Float4 a, Float4 b) { return __builtin_ia32_maxps(a, b); }
#else
VARVE_INLINE Float4 least(Float4 a, Float4 b) { return a < b ? a : b; }
VARVE_INLINE Float4 greatest(Float4 a, Float4 b) { return a > b ? a : b; }
#endif
#if defined(__AVX__)
VARVE_INLINE Double4 least(Double4 a, Double4 b) { return __builtin_ia32_minpd256(a, b); }
VARVE_INLINE Double4 greatest(Double4 a, Double4 b) { return __builtin_ia32_maxpd256(a, b); }
#else
VARVE_INLINE Double4 least(Double4 a, Double4 b) { return a < b ? a : b; }
VARVE_INLINE Double4 greatest(Double4 a, Double4 b) { return a > b ? a : b; }
#endif
VARVE_INLINE Double4 magnitude(Double4 v) { return v < 0.0 ? -v : v; }
VARVE_INLINE Double4 square_root(Double4 v) {
#ifdef __AVX__
  return __builtin_ia32_sqrtpd256(v);
#else
  return Double4{__builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]), __builtin_sqrt(v[3])};
#endif
}
VARVE_INLINE double biggest(double a, double b) { return a > b ? a : b; }
VARVE_INLINE double smallest(double a, double b) { return a < b ? a : b; }

/// True when no lane is NaN or infinite: the difference to itself is then 0, else NaN.
VARVE_INLINE bool finite(Float4 v) {
  const Float4 zero = v - v;
  return (zero[0] + zero[1]) + (zero[2] + zero[3]) == 0;
}
VARVE_INLINE bool all_true(Mask4 m) {
#if defined(__AVX__)
  return __builtin_ia32_movmskpd256(Double4(m)) == 15;
#else
  return (m[0] & m[1] & m[2] & m[3]) != 0;
#endif
}
VARVE_INLINE double least_lane(Double4 v) {
  const double a = v[0] < v[1] ? v[0] : v[1], b = v[2] < v[3] ? v[2] : v[3];
  return a < b ? a : b;
}

/// R G B A to Y Co Cg A: an orthogonal-ish rotation with powers of two, so scaling the light scales it exactly.
VARVE_INLINE Float4 ycocg_from_rgb(Float4 c) {
  return Float4{c[0] * 0.25f + c[2] * 0.25f + c[1] * 0.5f, c[0] * 0.5f - c[2] * 0.5f,
                c[1] * 0.5f - (c[0] * 0.25f + c[2] * 0.25f), c[3]};
}
VARVE_INLINE Double4 rgb_from_ycocg(Double4 c) {
  const double t = c[0] - c[2];
  return Double4{t + c[1], c[0] + c[2], t - c[1], c[3]};
}

}  // namespace varve::VARVE_ISA
