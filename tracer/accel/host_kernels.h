// The CPU's kernels for wide trees, once per instruction set: each in a source file with compiler flags of its own, and
// chosen when a program runs, so that an installed Copse uses what its processor has and needs no more.
#pragma once

#include <span>

#include "builder/parameters.h"
#include "tracer/accel/ray.h"
#include "tracer/accel/wide8.h"

namespace copse {

/// Traces rays begin … end-1 on the calling thread.
struct HostKernels {
  const char* name;  ///< A word of trace.simd.
  bool (*runsHere)();
  void (*closest)(const Wide8View& view, const Ray* rays, uint32_t begin, uint32_t end, Hit* hits);
  void (*any)(const Wide8View& view, const Ray* rays, uint32_t begin, uint32_t end, uint32_t* occluded);
};

/// Those that were compiled, the portable one first and the one that needs most last. Hits are the same.
std::span<const HostKernels> hostKernels();

/// What trace.simd says; for auto the last that runs on this processor. Throws InputError for one that does not.
const HostKernels& chosenKernels(const Parameters& parameters);

/// trace.simd.
ParameterSpec simdParameter();

}  // namespace copse
