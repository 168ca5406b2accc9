// Sixteen floats at once, where one CPU thread does the work of many lanes: AVX-512, two AVX registers, or plain
// floats. The same operations in the same order give the same bits as on one float. On a GPU a lane has one float
// instead.
#pragma once

#include <cstddef>

#include "builder/math/box.h"
#include "builder/math/simd4.h"

namespace copse {

#if COPSE_SSE && defined(__AVX512F__)

// Masks of all lanes where plain intrinsics would do: g++ 12 sees uninitialised registers in those (its bug 105593).
struct alignas(64) Float16 {
  __m512 v;
  static Float16 all(float x) { return {_mm512_set1_ps(x)}; }
  void store(float* to) const { _mm512_storeu_ps(to, v); }
};
/// The first three floats of sixteen rows of four: row i is at from + at[i], an address divisible by 16.
inline void loadColumns(const float* from, const std::size_t* at, Float16* columns) {
  __m512 rows[4];  // Lane L of rows[i] is row 4 L + i.
  for (int i = 0; i < 4; ++i) {
    const __m512 first = _mm512_zextps128_ps512(_mm_load_ps(from + at[i]));
    const __m512 two = _mm512_maskz_insertf32x4(0xffff, first, _mm_load_ps(from + at[4 + i]), 1);
    const __m512 three = _mm512_maskz_insertf32x4(0xffff, two, _mm_load_ps(from + at[8 + i]), 2);
    rows[i] = _mm512_maskz_insertf32x4(0xffff, three, _mm_load_ps(from + at[12 + i]), 3);
  }
  const auto low = [](__m512 a, __m512 b) { return _mm512_castps_pd(_mm512_maskz_unpacklo_ps(0xffff, a, b)); };
  const __m512d xy01 = low(rows[0], rows[1]), xy23 = low(rows[2], rows[3]);
  const __m512d z01 = _mm512_castps_pd(_mm512_maskz_unpackhi_ps(0xffff, rows[0], rows[1]));
  const __m512d z23 = _mm512_castps_pd(_mm512_maskz_unpackhi_ps(0xffff, rows[2], rows[3]));
  columns[0].v = _mm512_castpd_ps(_mm512_maskz_unpacklo_pd(0xff, xy01, xy23));
  columns[1].v = _mm512_castpd_ps(_mm512_maskz_unpackhi_pd(0xff, xy01, xy23));
  columns[2].v = _mm512_castpd_ps(_mm512_maskz_unpacklo_pd(0xff, z01, z23));
}
/// Sixteen whole numbers of 0 … 127 as bytes.
inline void storeBytes(Float16 a, uint8_t* to) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to),
                   _mm512_maskz_cvtepi32_epi8(0xffff, _mm512_maskz_cvttps_epi32(0xffff, a.v)));
}
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
  void store(float* to) const {
    _mm256_storeu_ps(to, low);
    _mm256_storeu_ps(to + 8, high);
  }
};
inline void loadColumns(const float* from, const std::size_t* at, Float16* columns) {
  __m256 x[2], y[2], z[2];
  for (int half = 0; half < 2; ++half, at += 8) {
    __m256 rows[4];  // Lane L of rows[i] is row 4 L + i of this half.
    for (int i = 0; i < 4; ++i)
      rows[i] =
          _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(from + at[i])), _mm_load_ps(from + at[4 + i]), 1);
    const __m256d xy01 = _mm256_castps_pd(_mm256_unpacklo_ps(rows[0], rows[1]));
    const __m256d xy23 = _mm256_castps_pd(_mm256_unpacklo_ps(rows[2], rows[3]));
    const __m256d z01 = _mm256_castps_pd(_mm256_unpackhi_ps(rows[0], rows[1]));
    const __m256d z23 = _mm256_castps_pd(_mm256_unpackhi_ps(rows[2], rows[3]));
    x[half] = _mm256_castpd_ps(_mm256_unpacklo_pd(xy01, xy23));
    y[half] = _mm256_castpd_ps(_mm256_unpackhi_pd(xy01, xy23));
    z[half] = _mm256_castpd_ps(_mm256_unpacklo_pd(z01, z23));
  }
  columns[0] = {x[0], x[1]};
  columns[1] = {y[0], y[1]};
  columns[2] = {z[0], z[1]};
}
inline void storeBytes(Float16 a, uint8_t* to) {
  float values[16];
  a.store(values);
  for (int i = 0; i < 16; ++i) to[i] = static_cast<uint8_t>(static_cast<int32_t>(values[i]));
}
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
  HD void store(float* to) const {
    for (int i = 0; i < 16; ++i) to[i] = v[i];
  }
};

HD inline void loadColumns(const float* from, const std::size_t* at, Float16* columns) {
  for (int d = 0; d < 3; ++d)
    for (int i = 0; i < 16; ++i) columns[d].v[i] = from[at[i] + d];
}
HD inline void storeBytes(const Float16& a, uint8_t* to) {
  for (int i = 0; i < 16; ++i) to[i] = static_cast<uint8_t>(static_cast<int32_t>(a.v[i]));
}

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
