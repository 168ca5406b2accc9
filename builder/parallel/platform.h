// What a compiler calls device code. Only builder/parallel asks which compiler this is.
#pragma once

#if defined(__CUDACC__)
#define HD __host__ __device__
#else
#define HD
#endif

/// 1 while a function is compiled for the device, for the few that use the host's vector instructions otherwise.
/// Both must give the same bits.
#if defined(__CUDA_ARCH__)
#define COPSE_DEVICE_CODE 1
#else
#define COPSE_DEVICE_CODE 0
#endif

/// Marks a function on a rare path: on a GPU it is a call, so that what it needs takes no registers of the loop around
/// it.
#if defined(__CUDACC__)
#define COPSE_RARE __noinline__
#else
#define COPSE_RARE
#endif

/// Asks for the cache line at `address`, which need not be valid, ahead of its use. A GPU hides the wait by itself. It
/// pays for arrays that are read in order too: a kernel of some twenty instructions per element keeps a processor from
/// looking far enough ahead, and encoding 12 million Morton codes took 25 ms with it and 82 without.
HD inline void prefetch([[maybe_unused]] const void* address) {
#if !COPSE_DEVICE_CODE
  __builtin_prefetch(address);
#endif
}
/// The same ahead of a store.
HD inline void prefetchForStore([[maybe_unused]] const void* address) {
#if !COPSE_DEVICE_CODE
  __builtin_prefetch(address, 1);
#endif
}
