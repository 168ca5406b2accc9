// Runs of neighbouring rays, a thread each. The rays of a run are traced in turn; where they take the same way through
// a binary tree, one after the other is faster.
#include "tracer/accel/trace_on_host.h"

#include <algorithm>

#include "builder/parallel/timeline.h"
#include "tracer/accel/traverse.h"
#include "tracer/accel/traverse_in_turn.h"
#include "tracer/accel/traverse_wide.h"

namespace copse::detail {

namespace {

constexpr uint32_t run = 256;  ///< Rays that a thread takes at a time.

/// Calls trace(begin, end) for runs that make up 0 … count-1.
template <class Trace>
void inRuns(const Device& device, const char* name, uint32_t count, const Trace& trace) {
  if (count == 0) return;
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
  const int64_t runs = (int64_t{count} + run - 1) / run;
#pragma omp parallel for schedule(dynamic) num_threads(device.threads) if (runs > 1)
  for (int64_t i = 0; i < runs; ++i) {
    const auto begin = static_cast<uint32_t>(i * run);
    trace(begin, begin + std::min(run, count - begin));
  }
}

/// Whether neighbours among the rays mostly take the same way, as the camera's do: their directions' signs tell.
bool coherent(const Ray* rays, uint32_t begin, uint32_t end) {
  const auto octant = [&](uint32_t i) {
    const vec3 d = rays[i].direction;
    return (d.x < 0 ? 1 : 0) | (d.y < 0 ? 2 : 0) | (d.z < 0 ? 4 : 0);
  };
  uint32_t changes = 0;
  for (uint32_t i = begin + 1; i < end; ++i) changes += octant(i) != octant(i - 1);
  return changes <= (end - begin) / 8;
}

}  // namespace

void traceClosestOnHost(const Device& device, const char* name, const TraversalView& view, uint32_t count,
                        const Ray* rays, Hit* hits) {
  const auto store = [=](uint32_t i, const Hit& hit) { hits[i] = hit; };
  inRuns(device, name, count, [=](uint32_t begin, uint32_t end) {
    if (view.wideNodes) return traverseInTurn<false, WideSteps>(view, rays, begin, end, store);
    if (!coherent(rays, begin, end)) return traverseInTurn<false, PairSteps>(view, rays, begin, end, store);
    for (uint32_t i = begin; i < end; ++i) hits[i] = closestHit(view, rays[i]);
  });
}

void traceAnyOnHost(const Device& device, const char* name, const TraversalView& view, uint32_t count, const Ray* rays,
                    uint32_t* occluded) {
  const auto store = [=](uint32_t i, const Hit& hit) { occluded[i] = hit.triangle != Hit::none; };
  inRuns(device, name, count, [=](uint32_t begin, uint32_t end) {
    if (view.wideNodes) return traverseInTurn<true, WideSteps>(view, rays, begin, end, store);
    traverseInTurn<true, PairSteps>(view, rays, begin, end, store);
  });
}

}  // namespace copse::detail
