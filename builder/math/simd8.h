// Eight floats at once, as two Float4 side by side: AVX on a host that has it.
#pragma once

#include "builder/math/simd4.h"

namespace copse {

#if COPSE_SSE && defined(__AVX2__)

struct alignas(32) Float8 {
  __m256 v;
  /// `low` and `high`: addresses divisible by 16.
  static Float8 load(const float* low, const float* high) {
    return {_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(low)), _mm_load_ps(high), 1)};
  }
  static Float8 both(Float4 a) { return {_mm256_insertf128_ps(_mm256_castps128_ps256(a.v), a.v, 1)}; }
  Float4 low() const { return {_mm256_castps256_ps128(v)}; }
  void store(float* to) const { _mm256_storeu_ps(to, v); }
};

inline Float8 operator+(Float8 a, Float8 b) { return {_mm256_add_ps(a.v, b.v)}; }
inline Float8 operator-(Float8 a, Float8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline Float8 operator*(Float8 a, Float8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
/// As for Float4: b where either is NaN.
inline Float8 maxOf(Float8 a, Float8 b) { return {_mm256_max_ps(a.v, b.v)}; }
/// a2 a3 a0 a1, in each half.
inline Float8 exchangePairs(Float8 a) { return {_mm256_permute_ps(a.v, _MM_SHUFFLE(1, 0, 3, 2))}; }
/// One bit a lane: a <= 0.
inline uint32_t notAboveZero(Float8 a) {
  return uint32_t(_mm256_movemask_ps(_mm256_cmp_ps(a.v, _mm256_setzero_ps(), _CMP_LE_OQ)));
}

inline Float8 allOf(float x) { return {_mm256_set1_ps(x)}; }
/// At any address.
inline Float8 load8(const float* from) { return {_mm256_loadu_ps(from)}; }
inline Float8 minOf(Float8 a, Float8 b) { return {_mm256_min_ps(a.v, b.v)}; }
/// The lowest of eight numbers.
inline float lowestOf(Float8 a) {
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_movehdup_ps(m)));
}
/// One bit a lane: a == b.
inline uint32_t equal(Float8 a, Float8 b) { return uint32_t(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_EQ_OQ))); }
/// `yes` where a <= b, otherwise `no`.
inline Float8 whereLessEqual(Float8 a, Float8 b, Float8 yes, Float8 no) {
  return {_mm256_blendv_ps(no.v, yes.v, _mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ))};
}
/// `yes` where a == b, otherwise `no`.
inline Float8 whereEqual(Float8 a, Float8 b, Float8 yes, Float8 no) {
  return {_mm256_blendv_ps(no.v, yes.v, _mm256_cmp_ps(a.v, b.v, _CMP_EQ_OQ))};
}
/// Lane l has lane l & k of `a`.
template <int k>
inline Float8 lanesAnd(Float8 a) {
  a.v = _mm256_permutevar8x32_ps(a.v, _mm256_setr_epi32(0, 1 & k, 2 & k, 3 & k, 4 & k, 5 & k, 6 & k, 7 & k));
  return a;
}

/// HalfSwap in each half.
struct PairSwap {
  __m256i lanes;
  PairSwap() = default;
  explicit PairSwap(bool swap) : lanes(_mm256_broadcastsi128_si256(HalfSwap(swap).lanes)) {}
  Float8 operator()(Float8 a) const { return {_mm256_permutevar_ps(a.v, lanes)}; }
  Float4 operator()(Float4 a) const { return {_mm_permutevar_ps(a.v, _mm256_castsi256_si128(lanes))}; }
};

#else

struct Float8 {
  Float4 lower, upper;
  HD static Float8 load(const float* low, const float* high) { return {Float4::load(low), Float4::load(high)}; }
  HD static Float8 both(Float4 a) { return {a, a}; }
  HD Float4 low() const { return lower; }
  HD void store(float* to) const {
    lower.store(to);
    upper.store(to + 4);
  }
};

HD inline Float8 operator+(Float8 a, Float8 b) { return {a.lower + b.lower, a.upper + b.upper}; }
HD inline Float8 operator-(Float8 a, Float8 b) { return {a.lower - b.lower, a.upper - b.upper}; }
HD inline Float8 operator*(Float8 a, Float8 b) { return {a.lower * b.lower, a.upper * b.upper}; }
HD inline Float8 maxOf(Float8 a, Float8 b) { return {maxOf(a.lower, b.lower), maxOf(a.upper, b.upper)}; }
HD inline Float8 exchangePairs(Float8 a) { return {shuffle<2, 3, 0, 1>(a.lower), shuffle<2, 3, 0, 1>(a.upper)}; }
HD inline uint32_t notAboveZero(Float8 a) {
  const Float4 zero = Float4::all(0);
  return lessEqual(a.lower, zero) | lessEqual(a.upper, zero) << 4;
}

struct Lanes8 {
  float v[8];
  HD explicit Lanes8(Float8 a) { a.store(v); }
  template <class Make>
  HD static Float8 of(Make make) {
    alignas(16) float r[8];
    for (int i = 0; i < 8; ++i) r[i] = make(i);
    return Float8::load(r, r + 4);
  }
};
HD inline Float8 allOf(float x) { return Float8::both(Float4::all(x)); }
HD inline Float8 load8(const float* from) {
  return Lanes8::of([&](int i) { return from[i]; });
}
HD inline Float8 minOf(Float8 a, Float8 b) {
  const Lanes8 x(a), y(b);
  return Lanes8::of([&](int i) { return x.v[i] < y.v[i] ? x.v[i] : y.v[i]; });
}
HD inline float lowestOf(Float8 a) {
  const Lanes8 x(a);
  float lowest = x.v[0];
  for (int i = 1; i < 8; ++i) lowest = x.v[i] < lowest ? x.v[i] : lowest;
  return lowest;
}
HD inline uint32_t equal(Float8 a, Float8 b) {
  const Lanes8 x(a), y(b);
  uint32_t bits = 0;
  for (int i = 0; i < 8; ++i) bits |= uint32_t(x.v[i] == y.v[i]) << i;
  return bits;
}
HD inline Float8 whereLessEqual(Float8 a, Float8 b, Float8 yes, Float8 no) {
  const Lanes8 x(a), y(b), chosen(yes), other(no);
  return Lanes8::of([&](int i) { return x.v[i] <= y.v[i] ? chosen.v[i] : other.v[i]; });
}
HD inline Float8 whereEqual(Float8 a, Float8 b, Float8 yes, Float8 no) {
  const Lanes8 x(a), y(b), chosen(yes), other(no);
  return Lanes8::of([&](int i) { return x.v[i] == y.v[i] ? chosen.v[i] : other.v[i]; });
}
template <int k>
HD inline Float8 lanesAnd(Float8 a) {
  const Lanes8 x(a);
  return Lanes8::of([&](int i) { return x.v[i & k]; });
}

struct PairSwap {
  HalfSwap half;
  PairSwap() = default;
  HD explicit PairSwap(bool swap) : half(swap) {}
  HD Float8 operator()(Float8 a) const { return {half(a.lower), half(a.upper)}; }
  HD Float4 operator()(Float4 a) const { return half(a); }
};

#endif

}  // namespace copse
