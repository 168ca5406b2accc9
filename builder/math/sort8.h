// Eight numbers in order, with a word each, without a branch: a network of six steps.
#pragma once

#include "builder/math/simd.h"

namespace copse::detail::inline COPSE_ISA {

/// Lane by lane the greater of `a` and `others`, but the smaller in the lanes that are 4 … 7 among L0 … L3.
template <int L0, int L1, int L2, int L3>
HD inline U32x8 exchange(const U32x8& a, const U32x8& others) {
  return maxOf(a, others).shuffle<L0, L1, L2, L3>(minOf(a, others));
}

/// Keys in descending order.
HD inline U32x8 sortDescending(const U32x8& keys) {
  U32x8 a = exchange<0, 5, 2, 7>(keys, keys.shuffle<1, 0, 3, 2>());
  a = exchange<0, 1, 6, 7>(a, a.shuffle<3, 2, 1, 0>());
  a = exchange<0, 5, 2, 7>(a, a.shuffle<1, 0, 3, 2>());
  const U32x8 reversed = a.shuffle<3, 2, 1, 0>().halves<1, 0>();
  a = maxOf(a, reversed).halves<0, 3>(minOf(a, reversed));
  a = exchange<0, 1, 6, 7>(a, a.shuffle<2, 3, 0, 1>());
  return exchange<0, 5, 2, 7>(a, a.shuffle<1, 0, 3, 2>());
}

}  // namespace copse::detail::inline COPSE_ISA

namespace copse::inline COPSE_ISA {

/// The `chosen` of eight pairs (one bit each) as numbers, key << 32 | word, greatest key first. Keys are floats of 0 or
/// more, as bits; each loses its three lowest ones, so it may be a little smaller, and the lower index goes last where
/// keys then are equal. All eight places of `to` are written; those behind the chosen are unspecified.
HD inline void storeDescending(const F32x8& keys, uint32_t chosen, const uint32_t words[8], uint64_t to[8]) {
  const U32x8 index(U32x4(0, 1, 2, 3), U32x4(4, 5, 6, 7)), bit(U32x4(1, 2, 4, 8), U32x4(16, 32, 64, 128));
  const U32x8 high(~7u);
  const U32x8 candidates = (bitsOf(keys) & high) | index;
  const U32x8 sorted = detail::sortDescending(select((U32x8(chosen) & bit) == bit, candidates, U32x8(0)));
#if defined(__AVX2__) && !COPSE_DEVICE_CODE
  // By the three lowest bits of each lane.
  using Vector = detail::Register<int32_t, 8>::Type;
  const U32x8 word =
      U32x8::of(U32x8::Vector(__builtin_ia32_permvarsi256(Vector(U32x8::load(words).v), Vector(sorted.v))));
  const U32x8 key = sorted & high;
  const U32x8 even = word.shuffle<0, 4, 1, 5>(key), odd = word.shuffle<2, 6, 3, 7>(key);
  const U32x8 first = even.halves<0, 2>(odd), last = even.halves<1, 3>(odd);
  std::memcpy(to, &first.v, sizeof first);
  std::memcpy(to + 4, &last.v, sizeof last);
#else
  uint32_t key[8];
  sorted.store(key);
  for (uint32_t k = 0; k < 8; ++k) to[k] = static_cast<uint64_t>(key[k] & ~7u) << 32 | words[key[k] & 7];
#endif
}

}  // namespace copse::inline COPSE_ISA
