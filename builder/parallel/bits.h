// Counting bits, the same on both devices.
#pragma once

#include <cstdint>

#include "builder/parallel/platform.h"

namespace copse {

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

}  // namespace copse
