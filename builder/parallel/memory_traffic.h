// How often the host waited for the device and asked it for memory: what a GPU makes dear and a CPU does not show. The
// counts are the same on both devices, so what a builder costs there can be seen where there is none.
#pragma once

#include <cstdint>

namespace copse {

struct MemoryTraffic {
  uint64_t waits = 0;        ///< Copies from and to the host, and synchronisations: each empties the queue of launches.
  uint64_t allocations = 0;  ///< On CUDA from a pool that keeps its memory, so a first build is dearer than the next.
  uint64_t transfers = 0;    ///< Copies and fills: what is put on the stream beside launches.
};

/// The counts of this process so far, by all threads. Take the difference around what is to be counted.
MemoryTraffic memoryTraffic();

namespace detail {
void countWait();
void countTransfer();
}  // namespace detail

}  // namespace copse
