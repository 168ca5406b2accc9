// Batches of rays: ray by ray on the CPU, by persistent warps on CUDA.
#include "tracer/traversal/trace.h"

#include <algorithm>

#include "builder/parallel/launch.h"
#include "tracer/traversal/persistent.h"
#include "tracer/traversal/ray_tracer.h"
#include "tracer/traversal/traverse.h"

namespace copse {

namespace {

constexpr uint32_t raysAtATime = 256;  // What a CPU thread takes.

struct TraceClosest {
  TraversalView view;
  const Ray* rays;
  Hit* hits;
  HD void operator()(uint32_t i) const { hits[i] = closestHit(view, rays[i]); }
};

struct TraceAny {
  TraversalView view;
  const Ray* rays;
  uint32_t* occluded;
  HD void operator()(uint32_t i) const { occluded[i] = anyHit(view, rays[i]); }
};

}  // namespace

void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                  const uint32_t* count, const Ray* rays, Hit* hits) {
  if (device.isCuda()) return traceClosestPersistent(device, name, view, most, count, rays, hits);
  launch(device, name, count ? std::min(most, *count) : most, TraceClosest{view, rays, hits}, raysAtATime);
}

void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
              const Ray* rays, uint32_t* occluded) {
  if (device.isCuda()) return traceAnyPersistent(device, name, view, most, count, rays, occluded);
  launch(device, name, count ? std::min(most, *count) : most, TraceAny{view, rays, occluded}, raysAtATime);
}

void BvhRayTracer::closest(const Device& device, const char* name, uint32_t most, const uint32_t* count,
                           const Ray* rays, Hit* hits) const {
  traceClosest(device, name, view_, most, count, rays, hits);
}

void BvhRayTracer::any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
                       uint32_t* occluded) const {
  traceAny(device, name, view_, most, count, rays, occluded);
}

}  // namespace copse
