// How the CPU's sort, scan and compaction cut their input among threads.
#pragma once

#include <algorithm>
#include <cstdint>

#include "builder/parallel/device.h"

namespace copse::detail {

/// Cuts begin … end-1 into about equal runs: as many as are asked for, or one per thread and none so short that
/// starting a thread costs more.
struct Blocks {
  uint32_t first;
  uint64_t n;
  int count;

  Blocks(const Device& device, uint32_t begin, uint32_t end)
      : first(begin),
        n(end - begin),
        count(static_cast<int>(std::clamp<uint64_t>(n / 8192, 1, static_cast<uint64_t>(std::max(device.threads, 1))))) {
  }
  Blocks(uint32_t begin, uint32_t end, int blocks) : first(begin), n(end - begin), count(blocks) {}

  uint32_t begin(int block) const { return first + static_cast<uint32_t>(n * static_cast<uint64_t>(block) / count); }
  uint32_t end(int block) const { return begin(block + 1); }
};

}  // namespace copse::detail
