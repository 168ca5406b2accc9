// Batches of rays by the per-ray functions.
#include "tracer/traversal/trace.h"

#include <algorithm>

#include "builder/parallel/launch.h"
#include "tracer/traversal/ray_tracer.h"
#include "tracer/traversal/traverse.h"

namespace copse {

namespace {

constexpr uint32_t raysAtATime = 256;

struct TraceClosest {
  TraversalView view;
  const uint32_t* count;
  const Ray* rays;
  Hit* hits;
  HD void operator()(uint32_t i) const {
    if (!count || i < *count) hits[i] = closestHit(view, rays[i]);
  }
};

struct TraceAny {
  TraversalView view;
  const uint32_t* count;
  const Ray* rays;
  uint32_t* occluded;
  HD void operator()(uint32_t i) const {
    if (!count || i < *count) occluded[i] = anyHit(view, rays[i]);
  }
};

}  // namespace

void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                  const uint32_t* count, const Ray* rays, Hit* hits) {
  if (!device.isCuda() && count) most = std::min(most, *count), count = nullptr;
  launch(device, name, most, TraceClosest{view, count, rays, hits}, raysAtATime);
}

void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
              const Ray* rays, uint32_t* occluded) {
  if (!device.isCuda() && count) most = std::min(most, *count), count = nullptr;
  launch(device, name, most, TraceAny{view, count, rays, occluded}, raysAtATime);
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
