// Blocks in use and idle ones by size; the smallest idle block that is large enough is taken, if little of it is
// wasted.
#include "builder/parallel/host_memory.h"

#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <unordered_map>

#include "builder/parallel/sanitizers.h"

namespace copse::detail {

namespace {

constexpr std::size_t largePage = std::size_t{2} << 20;

#if defined(COPSE_ASAN) || defined(COPSE_TSAN)
constexpr bool keepsBlocks = false;  // A sanitizer must see each block freed.
#else
constexpr bool keepsBlocks = true;
#endif

std::atomic<uint64_t> inUse{0}, peak{0};

void countTaken(std::size_t bytes) {
  const uint64_t now = inUse.fetch_add(bytes) + bytes;
  for (uint64_t max = peak; max < now && !peak.compare_exchange_weak(max, now);) {
  }
}

class LargeBlocks {
 public:
  void* take(std::size_t bytes) {
    bytes = (bytes + largePage - 1) / largePage * largePage;
    const std::lock_guard lock(mutex_);
    void* memory = nullptr;
    const auto found = idle_.lower_bound(bytes);
    if (found != idle_.end() && found->first <= bytes + bytes / 2) {
      bytes = found->first;
      memory = found->second;
      idle_.erase(found);
      idleBytes_ -= bytes;
    } else {
      keepWithin(usedBytes_ + bytes);
      if (posix_memalign(&memory, largePage, bytes) != 0) {
        trimIdle(0);
        if (posix_memalign(&memory, largePage, bytes) != 0) return nullptr;
      }
      // Kernels jump about in large arrays: a page of 2 MiB spares the processor a table walk.
      madvise(memory, bytes, MADV_HUGEPAGE);
    }
    used_.emplace(memory, bytes);
    usedBytes_ += bytes;
    maxUsed_ = std::max(maxUsed_, usedBytes_);
    countTaken(bytes);
    return memory;
  }

  /// False where the block is none of these.
  bool give(void* memory) {
    const std::lock_guard lock(mutex_);
    const auto found = used_.find(memory);
    if (found == used_.end()) return false;
    const std::size_t bytes = found->second;
    used_.erase(found);
    usedBytes_ -= bytes;
    inUse -= bytes;
    idle_.emplace(bytes, memory);
    idleBytes_ += bytes;
    keepWithin(usedBytes_);
    return true;
  }

 private:
  void trimIdle(std::size_t bytes) {
    while (idleBytes_ > bytes) {
      const auto largest = std::prev(idle_.end());
      idleBytes_ -= largest->first;
      std::free(largest->second);
      idle_.erase(largest);
    }
  }

  /// With `used` bytes in use: in all no more than a half above what was once used, for blocks that do not fit. With a
  /// quarter, each build of 262,144 triangles by `lbvh` gave blocks back and took pages anew: 44 ms and not 37.
  void keepWithin(std::size_t used) {
    const std::size_t max = std::max(maxUsed_, used);
    trimIdle(max + max / 2 - used);
  }

  std::mutex mutex_;
  std::unordered_map<void*, std::size_t> used_;
  std::multimap<std::size_t, void*> idle_;
  std::size_t usedBytes_ = 0, idleBytes_ = 0, maxUsed_ = 0;
};

/// Never destroyed, as buffers of static storage may outlive any other static object.
LargeBlocks& largeBlocks() {
  static auto* const blocks = new LargeBlocks;
  return *blocks;
}

}  // namespace

void* takeHostMemory(std::size_t bytes) noexcept {
  if (keepsBlocks && bytes >= largePage) return largeBlocks().take(bytes);
  void* memory = nullptr;
  const std::size_t alignment = bytes >= largePage ? largePage : 256;
  if (posix_memalign(&memory, alignment, bytes) != 0) return nullptr;
  countTaken(malloc_usable_size(memory));
  return memory;
}

void giveHostMemory(void* memory) noexcept {
  // Only large blocks are aligned to large pages, but for a small one by chance.
  const bool mayBeLarge = reinterpret_cast<std::uintptr_t>(memory) % largePage == 0;
  if (keepsBlocks && mayBeLarge && largeBlocks().give(memory)) return;
  inUse -= malloc_usable_size(memory);
  std::free(memory);
}

uint64_t hostBytesInUse() noexcept { return inUse; }
uint64_t hostPeakBytes() noexcept { return peak; }
void startHostPeak() noexcept { peak = inUse.load(); }

}  // namespace copse::detail
