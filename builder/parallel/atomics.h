// Atomic operations on plain memory, the same on both devices. The order is on the operation itself:
// ThreadSanitizer does not model separate fences.
#pragma once

#include <cstdint>
#include <type_traits>

#include "builder/parallel/platform.h"

#if defined(__CUDACC__)
#include <cuda/atomic>
#else
#include <atomic>
#endif

namespace copse {

namespace detail {
#if defined(__CUDACC__)
template <class T>
using AtomicRef = cuda::atomic_ref<T, cuda::thread_scope_device>;
namespace order = cuda::std;
#else
template <class T>
using AtomicRef = std::atomic_ref<T>;
namespace order = std;
#endif
}  // namespace detail

/// The value before the sum. Relaxed: no other memory is ordered by it.
template <class T>
HD T atomicAddRelaxed(T* to, T value) {
  return detail::AtomicRef<T>(*to).fetch_add(value, detail::order::memory_order_relaxed);
}
/// Acquire and release: what the thread wrote before is seen by whoever counts after it.
template <class T>
HD T atomicAddAcqRel(T* to, T value) {
  return detail::AtomicRef<T>(*to).fetch_add(value, detail::order::memory_order_acq_rel);
}
/// What was there before.
template <class T>
HD T atomicExchangeRelaxed(T* to, T value) {
  return detail::AtomicRef<T>(*to).exchange(value, detail::order::memory_order_relaxed);
}
/// Acquire and release: what the thread wrote before is seen by whoever exchanges after it.
template <class T>
HD T atomicExchangeAcqRel(T* to, T value) {
  return detail::AtomicRef<T>(*to).exchange(value, detail::order::memory_order_acq_rel);
}
template <class T>
HD T atomicLoadRelaxed(T* from) {
  return detail::AtomicRef<T>(*from).load(detail::order::memory_order_relaxed);
}
template <class T>
HD void atomicStoreRelaxed(T* to, T value) {
  detail::AtomicRef<T>(*to).store(value, detail::order::memory_order_relaxed);
}
#if defined(__CUDA_ARCH__)
namespace detail {
// Floats of one sign stand in the order of their bits, those below 0 in the opposite one; each is then one instruction
// that nothing waits for. NaN is left out.
__device__ inline void atomicMinFloat(float* to, float value) {
  if (value != value) return;
  const int bits = __float_as_int(value);
  if (bits >= 0)
    atomicMin(reinterpret_cast<int*>(to), bits);
  else
    atomicMax(reinterpret_cast<unsigned*>(to), static_cast<unsigned>(bits));
}
__device__ inline void atomicMaxFloat(float* to, float value) {
  if (value != value) return;
  const int bits = __float_as_int(value);
  if (bits >= 0)
    atomicMax(reinterpret_cast<int*>(to), bits);
  else
    atomicMin(reinterpret_cast<unsigned*>(to), static_cast<unsigned>(bits));
}
}  // namespace detail
#endif

/// Minimum and maximum of integers and floats; NaN never replaces a number. Of 0 and -0 either may stay.
template <class T>
HD void atomicMinRelaxed(T* to, T value) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<T, float>) return detail::atomicMinFloat(to, value);
#endif
  detail::AtomicRef<T> ref(*to);
  T seen = ref.load(detail::order::memory_order_relaxed);
  while (value < seen && !ref.compare_exchange_weak(seen, value, detail::order::memory_order_relaxed)) {
  }
}
template <class T>
HD void atomicMaxRelaxed(T* to, T value) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<T, float>) return detail::atomicMaxFloat(to, value);
#endif
  detail::AtomicRef<T> ref(*to);
  T seen = ref.load(detail::order::memory_order_relaxed);
  while (value > seen && !ref.compare_exchange_weak(seen, value, detail::order::memory_order_relaxed)) {
  }
}

}  // namespace copse
