// Four floats at once: SSE on an x86 host, plain floats on a GPU and elsewhere. The same operations in the same order
// give the same bits on both. Each operation is one or two instructions on the host.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "builder/parallel/platform.h"

#if !COPSE_DEVICE_CODE && defined(__SSE2__)
#define COPSE_SSE 1
#include <immintrin.h>
#else
#define COPSE_SSE 0
#endif

namespace copse {

struct alignas(16) Float4 {
#if COPSE_SSE
  __m128 v;
  static Float4 all(float x) { return {_mm_set1_ps(x)}; }
  static Float4 of(float a, float b, float c, float d) { return {_mm_setr_ps(a, b, c, d)}; }
  /// Four floats at an address divisible by 16.
  static Float4 load(const float* from) { return {_mm_load_ps(from)}; }
  void store(float* to) const { _mm_storeu_ps(to, v); }
  float first() const { return _mm_cvtss_f32(v); }
#else
  float v[4];
  HD static Float4 all(float x) { return {{x, x, x, x}}; }
  HD static Float4 of(float a, float b, float c, float d) { return {{a, b, c, d}}; }
  HD static Float4 load(const float* from) {
    struct alignas(16) Words {
      float v[4];
    };
    const Words w = *reinterpret_cast<const Words*>(from);
    return {{w.v[0], w.v[1], w.v[2], w.v[3]}};
  }
  HD void store(float* to) const {
    for (int i = 0; i < 4; ++i) to[i] = v[i];
  }
  HD float first() const { return v[0]; }
#endif
};

#if COPSE_SSE

inline Float4 operator+(Float4 a, Float4 b) { return {_mm_add_ps(a.v, b.v)}; }
inline Float4 operator-(Float4 a, Float4 b) { return {_mm_sub_ps(a.v, b.v)}; }
inline Float4 operator*(Float4 a, Float4 b) { return {_mm_mul_ps(a.v, b.v)}; }
/// `a > b ? a : b`, a lane: b where either is NaN.
inline Float4 maxOf(Float4 a, Float4 b) { return {_mm_max_ps(a.v, b.v)}; }
/// maxOf() where b is no NaN; of 0 and -0 it may be either. One instruction a lane on a GPU.
inline Float4 maxOver(Float4 a, Float4 b) { return maxOf(a, b); }
/// Lane i of the result is lane Li of `a`.
template <int L0, int L1, int L2, int L3>
inline Float4 shuffle(Float4 a) {
  a.v = _mm_shuffle_ps(a.v, a.v, _MM_SHUFFLE(L3, L2, L1, L0));  // nvcc loses the braces of {…} in a template.
  return a;
}
/// a0 a1 b0 b1.
inline Float4 lowHalves(Float4 a, Float4 b) { return {_mm_movelh_ps(a.v, b.v)}; }
/// a0 a1 -a2 -a3.
inline Float4 negateHighHalf(Float4 a) { return {_mm_xor_ps(a.v, _mm_setr_ps(0.0f, 0.0f, -0.0f, -0.0f))}; }
/// One bit a lane.
inline uint32_t lessEqual(Float4 a, Float4 b) { return uint32_t(_mm_movemask_ps(_mm_cmple_ps(a.v, b.v))); }
inline uint32_t less(Float4 a, Float4 b) { return uint32_t(_mm_movemask_ps(_mm_cmplt_ps(a.v, b.v))); }

/// Exchanges a vector's halves, or does not, as was chosen once for many vectors.
struct HalfSwap {
#if defined(__AVX__)
  __m128i lanes;
  HalfSwap() = default;
  explicit HalfSwap(bool swap) : lanes(swap ? _mm_setr_epi32(2, 3, 0, 1) : _mm_setr_epi32(0, 1, 2, 3)) {}
  Float4 operator()(Float4 a) const { return {_mm_permutevar_ps(a.v, lanes)}; }
#else
  __m128 mask;
  HalfSwap() = default;
  explicit HalfSwap(bool swap) : mask(_mm_castsi128_ps(_mm_set1_epi32(swap ? -1 : 0))) {}
  Float4 operator()(Float4 a) const {
    const __m128 swapped = _mm_shuffle_ps(a.v, a.v, _MM_SHUFFLE(1, 0, 3, 2));
    return {_mm_or_ps(_mm_and_ps(mask, swapped), _mm_andnot_ps(mask, a.v))};
  }
#endif
};

#else

HD inline Float4 operator+(Float4 a, Float4 b) {
  return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
HD inline Float4 operator-(Float4 a, Float4 b) {
  return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
}
HD inline Float4 operator*(Float4 a, Float4 b) {
  return {{a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]}};
}
HD inline Float4 maxOf(Float4 a, Float4 b) {
  Float4 r;
  for (int i = 0; i < 4; ++i) r.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
  return r;
}
HD inline Float4 maxOver(Float4 a, Float4 b) {
  return {{fmaxf(a.v[0], b.v[0]), fmaxf(a.v[1], b.v[1]), fmaxf(a.v[2], b.v[2]), fmaxf(a.v[3], b.v[3])}};
}
template <int L0, int L1, int L2, int L3>
HD inline Float4 shuffle(Float4 a) {
  return {{a.v[L0], a.v[L1], a.v[L2], a.v[L3]}};
}
HD inline Float4 lowHalves(Float4 a, Float4 b) { return {{a.v[0], a.v[1], b.v[0], b.v[1]}}; }
HD inline Float4 negateHighHalf(Float4 a) { return {{a.v[0], a.v[1], -a.v[2], -a.v[3]}}; }
HD inline uint32_t lessEqual(Float4 a, Float4 b) {
  uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= uint32_t(a.v[i] <= b.v[i]) << i;
  return bits;
}
HD inline uint32_t less(Float4 a, Float4 b) {
  uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= uint32_t(a.v[i] < b.v[i]) << i;
  return bits;
}

struct HalfSwap {
  bool swap;
  HalfSwap() = default;
  HD explicit HalfSwap(bool s) : swap(s) {}
  HD Float4 operator()(Float4 a) const {
    return {{swap ? a.v[2] : a.v[0], swap ? a.v[3] : a.v[1], swap ? a.v[0] : a.v[2], swap ? a.v[1] : a.v[3]}};
  }
};

#endif

}  // namespace copse
