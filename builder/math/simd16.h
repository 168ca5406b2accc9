// Sixteen floats at once, where one CPU thread does the work of many lanes: AVX-512, two AVX registers, or plain
// floats. The same operations in the same order give the same bits as on one float. On a GPU a lane has one float
// instead.
#pragma once

#include "builder/math/box.h"
#include "builder/math/simd4.h"

namespace copse {

#if COPSE_SSE && defined(__AVX512F__)

// Masks of all lanes where plain intrinsics would do: g++ 12 sees uninitialised registers in those (its bug 105593).
struct alignas(64) Float16 {
  __m512 v;
  static Float16 all(float x) { return {_mm512_set1_ps(x)}; }
  /// from[at[0]], from[at[1]], …
  static Float16 gather(const float* from, const uint32_t* at) {
    return {_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, _mm512_loadu_si512(at), from, 4)};
  }
  void store(float* to) const { _mm512_storeu_ps(to, v); }
};
inline Float16 operator+(Float16 a, Float16 b) { return {_mm512_add_ps(a.v, b.v)}; }
inline Float16 operator-(Float16 a, Float16 b) { return {_mm512_sub_ps(a.v, b.v)}; }
inline Float16 operator*(Float16 a, Float16 b) { return {_mm512_mul_ps(a.v, b.v)}; }
inline Float16 minOf(Float16 a, Float16 b) { return {_mm512_maskz_min_ps(0xffff, a.v, b.v)}; }
inline Float16 maxOf(Float16 a, Float16 b) { return {_mm512_maskz_max_ps(0xffff, a.v, b.v)}; }
/// `a < b ? x : y`, a lane.
inline Float16 selectLess(Float16 a, Float16 b, Float16 x, Float16 y) {
  return {_mm512_mask_blend_ps(_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ), y.v, x.v)};
}

#elif COPSE_SSE && defined(__AVX2__)

struct alignas(32) Float16 {
  __m256 low, high;
  static Float16 all(float x) { return {_mm256_set1_ps(x), _mm256_set1_ps(x)}; }
  static Float16 gather(const float* from, const uint32_t* at) {
    const auto* index = reinterpret_cast<const __m256i*>(at);
    return {_mm256_i32gather_ps(from, _mm256_loadu_si256(index), 4),
            _mm256_i32gather_ps(from, _mm256_loadu_si256(index + 1), 4)};
  }
  void store(float* to) const {
    _mm256_storeu_ps(to, low);
    _mm256_storeu_ps(to + 8, high);
  }
};
inline Float16 operator+(Float16 a, Float16 b) { return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)}; }
inline Float16 operator-(Float16 a, Float16 b) { return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)}; }
inline Float16 operator*(Float16 a, Float16 b) { return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)}; }
inline Float16 minOf(Float16 a, Float16 b) { return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)}; }
inline Float16 maxOf(Float16 a, Float16 b) { return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)}; }
inline Float16 selectLess(Float16 a, Float16 b, Float16 x, Float16 y) {
  return {_mm256_blendv_ps(y.low, x.low, _mm256_cmp_ps(a.low, b.low, _CMP_LT_OQ)),
          _mm256_blendv_ps(y.high, x.high, _mm256_cmp_ps(a.high, b.high, _CMP_LT_OQ))};
}

#else

struct Float16 {
  float v[16];
  HD static Float16 all(float x) {
    Float16 r;
    for (float& lane : r.v) lane = x;
    return r;
  }
  HD static Float16 gather(const float* from, const uint32_t* at) {
    Float16 r;
    for (int i = 0; i < 16; ++i) r.v[i] = from[at[i]];
    return r;
  }
  HD void store(float* to) const {
    for (int i = 0; i < 16; ++i) to[i] = v[i];
  }
};

namespace detail {
template <class F>
HD inline Float16 lanewise(const Float16& a, const Float16& b, F f) {
  Float16 r;
  for (int i = 0; i < 16; ++i) r.v[i] = f(a.v[i], b.v[i]);
  return r;
}
}  // namespace detail
HD inline Float16 operator+(const Float16& a, const Float16& b) {
  return detail::lanewise(a, b, [](float x, float y) { return x + y; });
}
HD inline Float16 operator-(const Float16& a, const Float16& b) {
  return detail::lanewise(a, b, [](float x, float y) { return x - y; });
}
HD inline Float16 operator*(const Float16& a, const Float16& b) {
  return detail::lanewise(a, b, [](float x, float y) { return x * y; });
}
HD inline Float16 minOf(const Float16& a, const Float16& b) {
  return detail::lanewise(a, b, [](float x, float y) { return minOf(x, y); });
}
HD inline Float16 maxOf(const Float16& a, const Float16& b) {
  return detail::lanewise(a, b, [](float x, float y) { return maxOf(x, y); });
}
HD inline Float16 selectLess(const Float16& a, const Float16& b, const Float16& x, const Float16& y) {
  Float16 r;
  for (int i = 0; i < 16; ++i) r.v[i] = a.v[i] < b.v[i] ? x.v[i] : y.v[i];
  return r;
}

#endif

HD inline float selectLess(float a, float b, float x, float y) { return a < b ? x : y; }

/// `x` in every lane of an F, which is float or Float16.
template <class F>
HD inline F spread(float x) {
  return F::all(x);
}
template <>
HD inline float spread<float>(float x) {
  return x;
}

}  // namespace copse
