// Batches of rays on CPU threads.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/accel/ray.h"

namespace copse {

/// hits[i] is the closest hit of rays[i], for i below `count`, in host memory. `name` is the phase. Instantiated for
/// each Format of tracer/accel.
template <class Format>
void traceClosestOnHost(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
                        const Ray* rays, Hit* hits);
/// occluded[i] is 1 where rays[i] hits anything, otherwise 0.
template <class Format>
void traceAnyOnHost(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
                    const Ray* rays, uint32_t* occluded);

}  // namespace copse
