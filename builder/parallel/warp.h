// 32 lanes that work together. On CUDA the _sync intrinsics with a full mask; on the CPU 32 fibers of one thread that
// switch at each collective, so the very index arithmetic of the lanes runs and is tested.
// Every collective is convergent: all 32 lanes call it, in the same order, with no early return or break before one;
// the CPU reports a lane that does not. Only sync() orders memory, on both devices: between one lane's write to shared
// or global memory and another lane's read there is a sync(), or ThreadSanitizer reports the race. Kernels that take a
// Warp are run by launchWarps, in launch_warps.h.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "builder/parallel/bits.h"
#include "builder/parallel/platform.h"

namespace copse {

struct Device;
class Warp;

namespace detail {
class FiberWarp;
void fiberSync(FiberWarp* warp, uint32_t lane);
uint32_t fiberBallot(FiberWarp* warp, uint32_t lane, bool predicate);
void fiberShuffle(FiberWarp* warp, uint32_t lane, const void* value, uint32_t bytes, uint32_t from, void* result);

/// Runs `call(kernel, warp, index)` on 32 fibers per index, indices shared out among the CPU's threads.
/// Throws what the kernel threw in the lowest index that failed, or DeviceError where lanes part company.
void runWarpsOnFibers(const Device& device, const char* name, uint32_t warps, uint32_t sharedBytes, const void* kernel,
                      void (*call)(const void* kernel, Warp& warp, uint32_t index));
}  // namespace detail

class Warp {
 public:
  static constexpr uint32_t size = 32;
  static constexpr uint32_t maxShuffleBytes = 128;  ///< For one lane's value in shfl.

  HD Warp(uint32_t lane, void* shared, detail::FiberWarp* fibers) : lane_(lane), shared_(shared), fibers_(fibers) {}
  Warp(const Warp&) = delete;
  Warp& operator=(const Warp&) = delete;

  HD uint32_t lane() const { return lane_; }
  /// Memory that the warp's lanes share: `sharedBytes` of launchWarps, aligned to 16, uninitialised.
  HD void* shared() const { return shared_; }

  /// Waits for all lanes; what any lane wrote before it is seen by every lane after it.
  HD void sync() {
#if defined(__CUDA_ARCH__)
    __syncwarp(fullMask);
#else
    detail::fiberSync(fibers_, lane_);
#endif
  }

  /// Bit i is lane i's predicate.
  HD uint32_t ballot(bool predicate) {
#if defined(__CUDA_ARCH__)
    return __ballot_sync(fullMask, predicate);
#else
    return detail::fiberBallot(fibers_, lane_, predicate);
#endif
  }
  HD bool any(bool predicate) { return ballot(predicate) != 0; }

  /// Lane `from`'s value (`from` modulo 32); T of 4 or 8 bytes, or a trivially copyable struct of whole words.
  template <class T>
  HD T shfl(T value, uint32_t from) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0 && sizeof(T) <= maxShuffleBytes);
    T result = value;
#if defined(__CUDA_ARCH__)
    if constexpr (sizeof(T) == 4 || sizeof(T) == 8) {
      using Word = std::conditional_t<sizeof(T) == 4, uint32_t, unsigned long long>;
      Word word;
      memcpy(&word, &value, sizeof word);
      word = __shfl_sync(fullMask, word, from);
      memcpy(&result, &word, sizeof word);
    } else {
      uint32_t words[sizeof(T) / 4];
      memcpy(words, &value, sizeof words);
#pragma unroll
      for (uint32_t& word : words) word = __shfl_sync(fullMask, word, from);
      memcpy(&result, words, sizeof words);
    }
#else
    detail::fiberShuffle(fibers_, lane_, &value, sizeof value, from % size, &result);
#endif
    return result;
  }

  /// The combination of all lanes' values, in every lane: a butterfly, so float sums are the same on both devices.
  template <class T, class Combine>
  HD T reduce(T value, Combine combine) {
    for (uint32_t step = 1; step < size; step *= 2) value = combine(value, shfl(value, lane_ ^ step));
    return value;
  }
  template <class T>
  HD T reduceAdd(T value) {
    return reduce(value, Add{});
  }
  /// How many lanes below this one are set in a ballot's `mask`: the place of this lane among them.
  HD uint32_t rank(uint32_t mask) const { return popCount(mask & ((1u << lane_) - 1)); }

 private:
  static constexpr uint32_t fullMask = 0xffffffffu;

  struct Add {
    template <class T>
    HD T operator()(const T& a, const T& b) const {
      return a + b;
    }
  };

  uint32_t lane_;
  void* shared_;
  detail::FiberWarp* fibers_;  ///< Null on CUDA.
};

}  // namespace copse
