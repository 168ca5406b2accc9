// Each thread takes runs of neighbouring rays. The rays of a run are traced in turn; where they are coherent, and the
// format has a step for that, one after another.
#include "tracer/accel/trace_on_host.h"

#include <algorithm>
#include <type_traits>

#include "builder/parallel/timeline.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/in_turn.h"
#include "tracer/accel/wide8_steps.h"

namespace copse {

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

/// Whether neighbouring rays are mostly coherent, as the camera's are: the signs of their directions tell.
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

template <class Format>
void traceClosestOnHost(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
                        const Ray* rays, Hit* hits) {
  using StepInARow = typename StepsOf<Format>::InARow;
  inRuns(device, name, count, [=](uint32_t begin, uint32_t end) {
    if constexpr (!std::is_void_v<StepInARow>)
      if (coherent(rays, begin, end)) {
        for (uint32_t i = begin; i < end; ++i) hits[i] = traverse<StepInARow, false>(view, rays[i]);
        return;
      }
    traverseInTurn<typename StepsOf<Format>::InTurn, false>(view, rays, begin, end,
                                                            [=](uint32_t i, const Hit& hit) { hits[i] = hit; });
  });
}

template <class Format>
void traceAnyOnHost(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
                    const Ray* rays, uint32_t* occluded) {
  inRuns(device, name, count, [=](uint32_t begin, uint32_t end) {
    traverseInTurn<typename StepsOf<Format>::InTurn, true>(
        view, rays, begin, end, [=](uint32_t i, const Hit& hit) { occluded[i] = hit.triangle != Hit::none; });
  });
}

template void traceClosestOnHost<Binary>(const Device&, const char*, const Binary::View&, uint32_t, const Ray*, Hit*);
template void traceAnyOnHost<Binary>(const Device&, const char*, const Binary::View&, uint32_t, const Ray*, uint32_t*);
template void traceClosestOnHost<Wide8>(const Device&, const char*, const Wide8::View&, uint32_t, const Ray*, Hit*);
template void traceAnyOnHost<Wide8>(const Device&, const char*, const Wide8::View&, uint32_t, const Ray*, uint32_t*);

}  // namespace copse
