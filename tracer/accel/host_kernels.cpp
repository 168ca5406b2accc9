// Which kernels there are, and which this processor has the instructions for.
#include "tracer/accel/host_kernels.h"

#include <fmt/format.h>

#include <algorithm>

#include "builder/base/error.h"
#include "tracer/accel/wide8_kernels.h"

namespace copse {

namespace {

constexpr const char* automatic = "auto";

bool everywhere() { return true; }

#if defined(__x86_64__)
// What gcc and clang mean by -march=x86-64-v3 and -v4, as far as kernels may use it.
bool hasAvx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2");
}
bool hasAvx512() {
  return hasAvx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd");
}
#endif

constexpr HostKernels table[] = {
    {"portable", everywhere, wide8ClosestPortable, wide8AnyPortable},
#if defined(__x86_64__)
    {"avx2", hasAvx2, wide8ClosestAvx2, wide8AnyAvx2},
    {"avx512", hasAvx512, wide8ClosestAvx512, wide8AnyAvx512},
#endif
};

}  // namespace

std::span<const HostKernels> hostKernels() { return table; }

ParameterSpec simdParameter() {
  return {.name = "trace.simd",
          .standard = automatic,
          .words = {automatic, "portable", "avx2", "avx512"},
          .meaning = "instructions that the CPU traces wide trees with; auto: the most that it has",
          .ofTree = false};
}

const HostKernels& chosenKernels(const Parameters& parameters) {
  const auto name = parameters.text(simdParameter());
  const auto kernels = hostKernels();
  const auto runs = [&](const HostKernels& k) { return (name == automatic || name == k.name) && k.runsHere(); };
  const auto found = std::find_if(kernels.rbegin(), kernels.rend(), runs);
  if (found == kernels.rend())
    throw InputError(fmt::format("trace.simd: expected instructions that this processor has, got {}", name));
  return *found;
}

}  // namespace copse
