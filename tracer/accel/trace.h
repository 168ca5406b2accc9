// A batch of rays: on the CPU one by one or several in turn, on CUDA by persistent warps (persistent.h). Same hits bit
// for bit.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/accel/ray.h"
#include "tracer/accel/traversal_bvh.h"

namespace copse {

/// hits[i] is the closest hit of rays[i], for i below min(most, *count); `count`, in the device's memory, may be null:
/// then all of `most`. Nothing waits for the device.
void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                  const uint32_t* count, const Ray* rays, Hit* hits);
/// occluded[i] is 1 where rays[i] hits anything, otherwise 0.
void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
              const Ray* rays, uint32_t* occluded);

inline void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t n, const Ray* rays,
                         Hit* hits) {
  traceClosest(device, name, view, n, nullptr, rays, hits);
}
inline void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t n, const Ray* rays,
                     uint32_t* occluded) {
  traceAny(device, name, view, n, nullptr, rays, occluded);
}

}  // namespace copse
