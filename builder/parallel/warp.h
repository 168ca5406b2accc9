// 32 lanes that work together. On CUDA the _sync intrinsics with a full mask; on the CPU 32 fibers of one thread that
// switch at each collective, so the very index arithmetic of the lanes runs and is tested.
// Every collective is convergent: all 32 lanes call it, in the same order, with no early return or break before one.
#pragma once

#include <cstdint>

#include "builder/parallel/platform.h"

namespace copse {

class Warp {
 public:
  static constexpr uint32_t size = 32;

  HD uint32_t lane() const;
  /// Memory that the warp's lanes share: `sharedBytes` of launchWarps, aligned to 16, uninitialised.
  HD void* shared() const;

  HD void sync();
  HD uint32_t ballot(bool predicate);
  HD bool any(bool predicate);
  HD bool all(bool predicate);
  /// Lane `from`'s value; T of 4 or 8 bytes, or a trivially copyable struct of whole words.
  template <class T>
  HD T shfl(T value, uint32_t from);
};

// template <class Kernel>   kernel: HD void operator()(Warp& warp, uint32_t index) const
// void launchWarps(const Device& device, const char* name, uint32_t warps, const Kernel& kernel,
//                  uint32_t sharedBytes = 0);

}  // namespace copse
