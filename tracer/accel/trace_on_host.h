// Batches of rays on CPU threads.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/host_kernels.h"

namespace copse {

/// For each Format of tracer/accel. hits[i] is the closest hit of rays[i], for i below `count`, in host memory;
/// occluded[i] is 1 where rays[i] hits anything, otherwise 0. `name` is the phase.
template <class Format>
class HostTracer;

template <>
class HostTracer<Binary> {
 public:
  explicit HostTracer(const Parameters&) {}
  void closest(const Device& device, const char* name, const Binary::View& view, uint32_t count, const Ray* rays,
               Hit* hits) const;
  void any(const Device& device, const char* name, const Binary::View& view, uint32_t count, const Ray* rays,
           uint32_t* occluded) const;
};

/// By the kernels of trace.simd.
template <>
class HostTracer<Wide8> {
 public:
  explicit HostTracer(const Parameters& parameters) : kernels_(&chosenKernels(parameters)) {}
  void closest(const Device& device, const char* name, const Wide8::View& view, uint32_t count, const Ray* rays,
               Hit* hits) const;
  void any(const Device& device, const char* name, const Wide8::View& view, uint32_t count, const Ray* rays,
           uint32_t* occluded) const;

 private:
  const HostKernels* kernels_;
};

}  // namespace copse
