// The CPU's memory for buffers. Large blocks are kept for the next buffer, as CUDA's pool keeps them: the system clears
// every page that it gives, which took half the time of building a tree over 12 million triangles.
// Private to builder/parallel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace copse::detail {

/// At least `bytes` > 0, aligned to 256 bytes and large blocks to large pages; null where there is no memory.
void* takeHostMemory(std::size_t bytes) noexcept;
/// Keeps the block if all that the program holds then is not much more than it once used at a time. Otherwise the
/// system gets it, or another that is kept.
void giveHostMemory(void* memory) noexcept;

/// Bytes of the blocks that are taken and not given back, and their maximum since startHostPeak().
uint64_t hostBytesInUse() noexcept;
uint64_t hostPeakBytes() noexcept;
void startHostPeak() noexcept;

}  // namespace copse::detail
