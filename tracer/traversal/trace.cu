// Batches of rays: runs of them on the CPU's threads, persistent warps on CUDA; through wide nodes a thread a ray.
#include "tracer/traversal/trace.h"

#include <algorithm>

#include "builder/parallel/launch.h"
#include "tracer/traversal/persistent.h"
#include "tracer/traversal/ray_tracer.h"
#include "tracer/traversal/traverse.h"
#include "tracer/traversal/traverse_in_turn.h"
#include "tracer/traversal/traverse_wide.h"

namespace copse {

namespace {

constexpr uint32_t run = 256;  ///< Rays that a CPU thread takes at a time.

/// Whether neighbours among the rays mostly take the same way, as the camera's do: their directions' signs tell.
HD bool coherent(const Ray* rays, uint32_t begin, uint32_t end) {
  const auto octant = [&](uint32_t i) {
    const vec3 d = rays[i].direction;
    return (d.x < 0 ? 1 : 0) | (d.y < 0 ? 2 : 0) | (d.z < 0 ? 4 : 0);
  };
  uint32_t changes = 0;
  for (uint32_t i = begin + 1; i < end; ++i) changes += octant(i) != octant(i - 1);
  return changes <= (end - begin) / 8;
}

struct StoreHit {
  Hit* hits;
  HD void operator()(uint32_t i, const Hit& hit) const { hits[i] = hit; }
};

struct StoreOccluded {
  uint32_t* occluded;
  HD void operator()(uint32_t i, const Hit& hit) const { occluded[i] = hit.triangle != Hit::none; }
};

/// Kernels over runs of rays, `count` in all.
struct TraceClosest {
  TraversalView view;
  const Ray* rays;
  Hit* hits;
  uint32_t count;

  HD void operator()(uint32_t i) const {
    const uint32_t begin = i * run, end = begin + minOf(run, count - begin);
    const StoreHit store{hits};
    if (view.wideNodes) return detail::traverseInTurn<false, detail::WideSteps>(view, rays, begin, end, store);
    if (!coherent(rays, begin, end))
      return detail::traverseInTurn<false, detail::PairSteps>(view, rays, begin, end, store);
    for (uint32_t ray = begin; ray < end; ++ray) hits[ray] = closestHit(view, rays[ray]);
  }
};

struct TraceAny {
  TraversalView view;
  const Ray* rays;
  uint32_t* occluded;
  uint32_t count;

  HD void operator()(uint32_t i) const {
    const uint32_t begin = i * run, end = begin + minOf(run, count - begin);
    const StoreOccluded store{occluded};
    if (view.wideNodes) return detail::traverseInTurn<true, detail::WideSteps>(view, rays, begin, end, store);
    detail::traverseInTurn<true, detail::PairSteps>(view, rays, begin, end, store);
  }
};

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

template <bool any, class Answer>
void traceWide(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
               const Ray* rays, Answer* answers) {
  const uint32_t n = count && !device.isCuda() ? std::min(most, *count) : most;
  launch(device, name, n, TraceWide<any, Answer>{view, count, rays, answers}, run);
}

uint32_t runsOf(uint32_t rays) { return rays / run + (rays % run ? 1 : 0); }

}  // namespace

void traceClosest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                  const uint32_t* count, const Ray* rays, Hit* hits) {
  if (device.isCuda() && view.wideNodes) return traceWide<false>(device, name, view, most, count, rays, hits);
  if (device.isCuda()) return traceClosestPersistent(device, name, view, most, count, rays, hits);
  const uint32_t n = count ? std::min(most, *count) : most;
  launch(device, name, runsOf(n), TraceClosest{view, rays, hits, n}, 1);
}

void traceAny(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
              const Ray* rays, uint32_t* occluded) {
  if (device.isCuda() && view.wideNodes) return traceWide<true>(device, name, view, most, count, rays, occluded);
  if (device.isCuda()) return traceAnyPersistent(device, name, view, most, count, rays, occluded);
  const uint32_t n = count ? std::min(most, *count) : most;
  launch(device, name, runsOf(n), TraceAny{view, rays, occluded, n}, 1);
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
