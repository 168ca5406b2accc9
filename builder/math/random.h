// Random numbers as a function of where they are used, not of when: pixel, sample, bounce and dimension are hashed
// with the seed. So an image does not depend on threads, queues or batches, and nothing is stored but a key per path.
// The mixing is the finaliser of SplitMix64 (Steele, Lea, Flood 2014) with Stafford's constants; two multiplications.
#pragma once

#include <cstdint>

#include "builder/parallel/platform.h"

namespace copse {

/// A bijection of 64-bit words in which every input bit flips every output bit with probability near a half.
HD inline uint64_t mixBits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// 2^64 over the golden ratio, odd: consecutive multiples differ in high bits.
inline constexpr uint64_t goldenStep = 0x9e3779b97f4a7c15ull;

/// The key of one path. Each word is mixed before the next is added, so that no two of them can trade places.
HD inline uint64_t randomKey(uint64_t seed, uint64_t pixel, uint64_t sample) {
  const uint64_t seeded = mixBits(seed + goldenStep);
  const uint64_t atPixel = mixBits(seeded + goldenStep * (pixel + 1));
  return mixBits(atPixel + goldenStep * (sample + 1));
}

/// 64 random bits for one use on a path. `bounce` and `dimension` below 2^32.
HD inline uint64_t randomBits(uint64_t key, uint32_t bounce, uint32_t dimension) {
  const uint64_t use = (static_cast<uint64_t>(bounce) << 32) | dimension;
  return mixBits(key ^ mixBits(use * goldenStep + 1));
}

HD inline uint32_t highWord(uint64_t bits) { return static_cast<uint32_t>(bits >> 32); }
HD inline uint32_t lowWord(uint64_t bits) { return static_cast<uint32_t>(bits); }

/// 0 <= u < 1, in steps of 2^-24, exactly representable.
HD inline float unitFloat(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// 0 … n-1, each with probability 1/n to within n/2^32. n > 0.
HD inline uint32_t uniformIndex(uint32_t bits, uint32_t n) {
  return static_cast<uint32_t>((static_cast<uint64_t>(bits) * n) >> 32);
}

}  // namespace copse
