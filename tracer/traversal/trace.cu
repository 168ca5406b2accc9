// Batches of rays: runs of them on the CPU's threads, persistent warps on CUDA; through wide nodes a thread a ray.
#include "tracer/traversal/trace.h"

#include <algorithm>

#include "builder/parallel/launch.h"
#include "tracer/traversal/persistent.h"
#include "tracer/traversal/ray_tracer.h"
#include "tracer/traversal/trace_on_host.h"
#include "tracer/traversal/traverse_wide.h"

namespace copse {

namespace {

HD void write(Hit& to, const Hit& hit) { to = hit; }
HD void write(uint32_t& to, const Hit& hit) { to = hit.triangle != Hit::none; }

/// A kernel over rays. `count` may be null.
template <bool any, class Answer>
struct TraceWide {
  TraversalView view;
  const uint32_t* count;
  const Ray* rays;
  Answer* answers;

  HD void operator()(uint32_t i) const {
    if (!count || i < *count) write(answers[i], detail::traverseWide<any>(view, rays[i]));
  }
};

}  // namespace

void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                  const uint32_t* count, const Ray* rays, Hit* hits) {
  if (!device.isCuda())
    detail::traceClosestOnHost(device, name, view, count ? std::min(most, *count) : most, rays, hits);
  else if (view.wideNodes)
    launch(device, name, most, TraceWide<false, Hit>{view, count, rays, hits});
  else
    traceClosestPersistent(device, name, view, most, count, rays, hits);
}

void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
              const Ray* rays, uint32_t* occluded) {
  if (!device.isCuda())
    detail::traceAnyOnHost(device, name, view, count ? std::min(most, *count) : most, rays, occluded);
  else if (view.wideNodes)
    launch(device, name, most, TraceWide<true, uint32_t>{view, count, rays, occluded});
  else
    traceAnyPersistent(device, name, view, most, count, rays, occluded);
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
