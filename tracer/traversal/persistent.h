// Batches of rays by persistent warps: Aila and Laine, Understanding the Efficiency of Ray Traversal on GPUs (2009),
// with their later kernels' postponed leaf and dynamic fetch (2012). For CUDA; on the CPU 32 fibers, for tests.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/traversal/ray.h"
#include "tracer/traversal/traversal_bvh.h"

namespace copse {

/// As traceClosest() and traceAny() in trace.h, whatever the device.
void traceClosestPersistent(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                            const uint32_t* count, const Ray* rays, Hit* hits);
void traceAnyPersistent(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                        const uint32_t* count, const Ray* rays, uint32_t* occluded);

}  // namespace copse
