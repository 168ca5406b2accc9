// Batches of rays: runs of them on the CPU's threads, persistent warps on CUDA.
#include "tracer/accel/trace.h"

#include <algorithm>

#include "tracer/accel/ray_tracer.h"
#include "tracer/accel/trace_on_host.h"

namespace copse {

void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                  const uint32_t* count, const Ray* rays, Hit* hits) {
  BvhRayTracer(device, view).closest(device, name, most, count, rays, hits);
}

void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
              const Ray* rays, uint32_t* occluded) {
  BvhRayTracer(device, view).any(device, name, most, count, rays, occluded);
}

BvhRayTracer::BvhRayTracer(const Device& device, const TraversalView& view, const PersistentSettings& settings)
    : view_(view) {
  if (device.isCuda()) persistent_.emplace(device, settings);
}

void BvhRayTracer::closest(const Device& device, const char* name, uint32_t most, const uint32_t* count,
                           const Ray* rays, Hit* hits) const {
  if (persistent_)
    persistent_->closest(device, name, view_, most, count, rays, hits);
  else
    detail::traceClosestOnHost(device, name, view_, count ? std::min(most, *count) : most, rays, hits);
}

void BvhRayTracer::any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
                       uint32_t* occluded) const {
  if (persistent_)
    persistent_->any(device, name, view_, most, count, rays, occluded);
  else
    detail::traceAnyOnHost(device, name, view_, count ? std::min(most, *count) : most, rays, occluded);
}

}  // namespace copse
