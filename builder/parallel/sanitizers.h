// What AddressSanitizer and ThreadSanitizer must be told about fibers; nothing in a build without them.
// Private to builder/parallel.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define COPSE_ASAN 1
#endif
#if __has_feature(thread_sanitizer)
#define COPSE_TSAN 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define COPSE_ASAN 1
#endif
#if defined(__SANITIZE_THREAD__)
#define COPSE_TSAN 1
#endif

#if defined(COPSE_ASAN)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(COPSE_TSAN)
#include <sanitizer/tsan_interface.h>
/// Bookkeeping that lanes share by running one after the other: not a kernel's own accesses, so not watched.
#define COPSE_UNWATCHED __attribute__((no_sanitize("thread")))
#else
#define COPSE_UNWATCHED
#endif

namespace copse::detail {

inline void* createThreadSanitizerFiber() {
#if defined(COPSE_TSAN)
  return __tsan_create_fiber(0);
#else
  return nullptr;
#endif
}
inline void* currentThreadSanitizerFiber() {
#if defined(COPSE_TSAN)
  return __tsan_get_current_fiber();
#else
  return nullptr;
#endif
}
inline void destroyThreadSanitizerFiber([[maybe_unused]] void* fiber) {
#if defined(COPSE_TSAN)
  __tsan_destroy_fiber(fiber);
#endif
}
/// A switch orders nothing by itself: lanes are as concurrent as on a GPU. Inlined always: a call would be entered on
/// one fiber's list of calls and left on the other's.
__attribute__((always_inline)) COPSE_UNWATCHED inline void switchThreadSanitizerFiber([[maybe_unused]] void* fiber) {
#if defined(COPSE_TSAN)
  __tsan_switch_to_fiber(fiber, __tsan_switch_to_fiber_no_sync);
#endif
}
/// What a fiber did before its release of an address comes before what a fiber does after its acquire of it.
inline void releaseOrder([[maybe_unused]] void* address) {
#if defined(COPSE_TSAN)
  __tsan_release(address);
#endif
}
inline void acquireOrder([[maybe_unused]] void* address) {
#if defined(COPSE_TSAN)
  __tsan_acquire(address);
#endif
}

}  // namespace copse::detail
