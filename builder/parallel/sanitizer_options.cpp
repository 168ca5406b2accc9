// The sanitizers' run-time options, compiled into every program of a build with sanitizers, so that one started by hand
// is checked as strictly as one that ctest starts. The environment's ASAN_OPTIONS and the like still come on top.
#include "builder/parallel/sanitizers.h"

#if defined(COPSE_ASAN)
// A size that no memory could hold is an error that Copse reports, not the end of the program.
extern "C" const char* __asan_default_options() {
  return "malloc_context_size=2:detect_leaks=1:allocator_may_return_null=1:check_initialization_order=1:strict_string_"
         "checks=1";
}
extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1:halt_on_error=1"; }
// LLVM's OpenMP does not free what it knows of a team, not even where it is told to end. That is what it allocates
// itself: of a deeper stack the same line would hide every leak in a parallel region.
// ASAN_OPTIONS=malloc_context_size=30 shows whole stacks.
extern "C" const char* __lsan_default_suppressions() { return "leak:libomp.so"; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

#if defined(COPSE_TSAN)
// Libraries that are not instrumented (OpenEXR's threads, OpenMP's own bookkeeping) are not watched: Archer tells
// ThreadSanitizer of OpenMP's order, and Copse's own code is watched in full.
extern "C" const char* __tsan_default_options() {
  return "ignore_noninstrumented_modules=1:allocator_may_return_null=1:exitcode=66";
}
#endif
