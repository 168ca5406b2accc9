// The sanitizers' run-time options, compiled into every program of a build with sanitizers, so that one started by hand
// is checked as strictly as one that ctest starts. The environment's ASAN_OPTIONS and the like still come on top.
#include "builder/parallel/sanitizers.h"

#if defined(COPSE_ASAN)
// A size that no memory could hold is an error that Copse reports, not the end of the program.
extern "C" const char* __asan_default_options() {
  return "detect_leaks=1:allocator_may_return_null=1:check_initialization_order=1:strict_string_checks=1";
}
extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1:halt_on_error=1"; }
// LLVM's OpenMP keeps what it knows of a team for the next one of that size, and does not free it at the end.
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
