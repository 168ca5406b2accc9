// What the source files of the kernels define, for host_kernels.cpp: one pair of functions per instruction set. Each of
// these files has inline functions in COPSE_ISA alone (builder/math/simd.h), or so small ones that the compiler keeps
// no copy of them: else the linker could keep one for all, with instructions that a processor lacks.
#pragma once

#include "tracer/accel/ray.h"
#include "tracer/accel/wide8.h"

namespace copse {

#define COPSE_WIDE8_KERNELS(Isa)                                                                           \
  void wide8Closest##Isa(const Wide8View& view, const Ray* rays, uint32_t begin, uint32_t end, Hit* hits); \
  void wide8Any##Isa(const Wide8View& view, const Ray* rays, uint32_t begin, uint32_t end, uint32_t* occluded)

COPSE_WIDE8_KERNELS(Portable);
COPSE_WIDE8_KERNELS(Avx2);
COPSE_WIDE8_KERNELS(Avx512);

}  // namespace copse
