// Sort, scan and compaction over buffers: OpenMP on the CPU, cub on CUDA. The results do not depend on the number of
// threads or on the device. Sums of boxes and the like are in reduce.h.
#pragma once

#include <cstdint>

#include "builder/parallel/buffer.h"
#include "builder/parallel/timeline.h"

namespace copse {

/// Sorts `keys` ascending by their lowest `bits` bits (1 to 64; any above are carried along) with `values`; stable.
/// O(n bits) at most; bits in which all keys agree cost nothing.
/// All four buffers hold at least `n`. The sorted data ends in `keys` and `values`, which may have changed places with
/// the scratch buffers: take data() after the call. The scratch buffers are overwritten.
void radixSort(const Device& device, PhaseName name, uint32_t n, int bits, Buffer<uint64_t>& keys,
               Buffer<uint32_t>& values, Buffer<uint64_t>& keyScratch, Buffer<uint32_t>& valueScratch);

/// out[i] = in[0] + … + in[i-1] modulo 2^32, or 2^64, for i in 0 … n-1; returns nothing to the host. `in` and `out` may
/// be one array. `total` (device memory, may be null) receives the sum of all, 0 for n = 0.
void exclusiveScan(const Device& device, PhaseName name, uint32_t n, const uint32_t* in, uint32_t* out,
                   uint32_t* total);
void exclusiveScan(const Device& device, PhaseName name, uint32_t n, const uint64_t* in, uint64_t* out,
                   uint64_t* total);

/// Writes the indices i < n with flags[i] != 0, ascending, to `out`; their number to `count` (device memory).
void compact(const Device& device, PhaseName name, uint32_t n, const uint32_t* flags, uint32_t* out, uint32_t* count);

#if COPSE_CUDA
namespace detail {
// The same by cub, for a CUDA device; temporary memory comes from the stream's pool.
void radixSortCub(const Device& device, uint32_t n, int bits, Buffer<uint64_t>& keys, Buffer<uint32_t>& values,
                  Buffer<uint64_t>& keyScratch, Buffer<uint32_t>& valueScratch);
void exclusiveScanCub(const Device& device, uint32_t n, const uint32_t* in, uint32_t* out, uint32_t* total);
void exclusiveScanCub(const Device& device, uint32_t n, const uint64_t* in, uint64_t* out, uint64_t* total);
void compactCub(const Device& device, uint32_t n, const uint32_t* flags, uint32_t* out, uint32_t* count);
}  // namespace detail
#endif

}  // namespace copse
