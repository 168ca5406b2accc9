// Sort, scan and reduce over buffers. Results do not depend on the number of threads or on the device.
#pragma once

#include <cstdint>

#include "builder/parallel/buffer.h"

namespace copse {

/// Sorts `keys` ascending by their lowest `bits` bits and carries `values` along; stable. O(n bits/8).
/// All four buffers hold at least `n`; the sorted data ends in `keys` and `values`, the scratch buffers are overwritten.
void radixSort(const Device& device, const char* name, uint32_t n, int bits, Buffer<uint64_t>& keys,
               Buffer<uint32_t>& values, Buffer<uint64_t>& keyScratch, Buffer<uint32_t>& valueScratch);

/// out[i] = in[0] + … + in[i-1], for i in 0 … n-1; returns nothing to the host. `in` and `out` may be one array.
/// `total` (device memory, may be null) receives the sum of all.
void exclusiveScan(const Device& device, const char* name, uint32_t n, const uint32_t* in, uint32_t* out,
                   uint32_t* total);

/// Writes the indices i < n with flags[i] != 0, ascending, to `out`; their number to `count` (device memory).
void compact(const Device& device, const char* name, uint32_t n, const uint32_t* flags, uint32_t* out, uint32_t* count);

}  // namespace copse
