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

/// HalfSwap in each half.
struct PairSwap {
  __m256i lanes;
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

struct PairSwap {
  HalfSwap half;
  HD explicit PairSwap(bool swap) : half(swap) {}
  HD Float8 operator()(Float8 a) const { return {half(a.lower), half(a.upper)}; }
  HD Float4 operator()(Float4 a) const { return half(a); }
};

#endif

}  // namespace copse
