// Batches of rays on the CPU's threads. trace.h chooses between this and CUDA.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/accel/ray.h"
#include "tracer/accel/traversal_bvh.h"

namespace copse::detail {

/// As traceClosest() and traceAny() for `count` rays in host memory.
void traceClosestOnHost(const Device& device, const char* name, const TraversalView& view, uint32_t count,
                        const Ray* rays, Hit* hits);
void traceAnyOnHost(const Device& device, const char* name, const TraversalView& view, uint32_t count, const Ray* rays,
                    uint32_t* occluded);

}  // namespace copse::detail
