// Counting bits, and bits as a float, the same on both devices.
#pragma once

#include <bit>
#include <cstdint>

#include "builder/parallel/platform.h"

namespace copse {

/// The float of these bits.
HD inline float floatOfBits(uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __uint_as_float(bits);
#else
  return std::bit_cast<float>(bits);
#endif
}

HD inline uint32_t popCount(uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __popc(bits);
#else
  return static_cast<uint32_t>(__builtin_popcount(bits));
#endif
}

/// The index of the lowest set bit, 0 where none is.
HD inline uint32_t lowestBit(uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return bits ? __ffs(static_cast<int>(bits)) - 1 : 0;
#else
  return bits ? static_cast<uint32_t>(__builtin_ctz(bits)) : 0;
#endif
}

HD inline uint32_t lowestBit(uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return bits ? __ffsll(static_cast<long long>(bits)) - 1 : 0;
#else
  return bits ? static_cast<uint32_t>(__builtin_ctzll(bits)) : 0;
#endif
}

/// Zero bits above the highest set bit; 32 or 64 where none is.
HD inline uint32_t leadingZeros(uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __clz(static_cast<int>(bits));
#else
  return bits ? static_cast<uint32_t>(__builtin_clz(bits)) : 32;
#endif
}
HD inline uint32_t leadingZeros(uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __clzll(static_cast<long long>(bits));
#else
  return bits ? static_cast<uint32_t>(__builtin_clzll(bits)) : 64;
#endif
}

/// Spreads the lowest 21 bits of `bits` so that two zeros follow each.
HD inline uint64_t spreadThirds(uint32_t bits) {
#if defined(__BMI2__) && !COPSE_DEVICE_CODE
  return __builtin_ia32_pdep_di(bits, 0x1249249249249249ull);
#else
  uint64_t v = bits & 0x1fffffu;
  v = (v | v << 32) & 0x001f00000000ffffull;
  v = (v | v << 16) & 0x001f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
#endif
}

}  // namespace copse
