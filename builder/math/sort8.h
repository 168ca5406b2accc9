// Eight numbers in order, with a word each, without a branch: a network of six steps in one AVX register.
#pragma once

#include <cstring>

#include "builder/math/simd8.h"
#include "builder/parallel/bits.h"

namespace copse {

/// The `chosen` of eight pairs (one bit each) as numbers, key << 32 | word, greatest key first. Keys are floats of 0 or
/// more, as bits; each loses its three lowest ones, so it may be a little smaller, and the lower index goes last where
/// keys then are equal. All eight places of `to` are written; those behind the chosen are of no account.
#if COPSE_SSE && defined(__AVX2__)
namespace detail {
/// Each pair of lanes, `a`'s own and what `others` has there: the greater to the lane that `lower` does not name.
template <int lower>
inline __m256i exchange(__m256i a, __m256i others) {
  return _mm256_blend_epi32(_mm256_max_epu32(a, others), _mm256_min_epu32(a, others), lower);
}
}  // namespace detail
inline void storeDescending(Float8 keys, uint32_t chosen, const uint32_t words[8], uint64_t to[8]) {
  const __m256i index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i isChosen = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(int(chosen)), bit), bit);
  const __m256i high = _mm256_set1_epi32(~7);
  __m256i a = _mm256_or_si256(_mm256_and_si256(_mm256_castps_si256(keys.v), high), index);
  a = _mm256_and_si256(a, isChosen);
  a = detail::exchange<0xaa>(a, _mm256_shuffle_epi32(a, _MM_SHUFFLE(2, 3, 0, 1)));
  a = detail::exchange<0xcc>(a, _mm256_shuffle_epi32(a, _MM_SHUFFLE(0, 1, 2, 3)));
  a = detail::exchange<0xaa>(a, _mm256_shuffle_epi32(a, _MM_SHUFFLE(2, 3, 0, 1)));
  a = detail::exchange<0xf0>(a, _mm256_permutevar8x32_epi32(a, _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0)));
  a = detail::exchange<0xcc>(a, _mm256_shuffle_epi32(a, _MM_SHUFFLE(1, 0, 3, 2)));
  a = detail::exchange<0xaa>(a, _mm256_shuffle_epi32(a, _MM_SHUFFLE(2, 3, 0, 1)));
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words));
  const __m256i word = _mm256_permutevar8x32_epi32(all, a);  // By the three lowest bits of each lane.
  const __m256i key = _mm256_and_si256(a, high);
  const __m256i even = _mm256_unpacklo_epi32(word, key), odd = _mm256_unpackhi_epi32(word, key);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permute2x128_si256(even, odd, 0x20));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + 4), _mm256_permute2x128_si256(even, odd, 0x31));
}
#else
HD inline void storeDescending(Float8 keys, uint32_t chosen, const uint32_t words[8], uint64_t to[8]) {
  float values[8];
  keys.store(values);
  uint32_t sorted[8] = {}, count = 0;
  for (; chosen; chosen &= chosen - 1) {
    const uint32_t index = lowestBit(chosen);
    uint32_t key;
    std::memcpy(&key, &values[index], sizeof key);
    key = (key & ~7u) | index;
    uint32_t at = count++;
    for (; at > 0 && sorted[at - 1] < key; --at) sorted[at] = sorted[at - 1];
    sorted[at] = key;
  }
  for (uint32_t k = 0; k < 8; ++k) to[k] = static_cast<uint64_t>(sorted[k] & ~7u) << 32 | words[sorted[k] & 7];
}
#endif

}  // namespace copse
