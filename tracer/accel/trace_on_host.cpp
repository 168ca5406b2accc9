// Each thread takes runs of neighbouring rays.
#include "tracer/accel/trace_on_host.h"

#include <algorithm>

#include "builder/parallel/timeline.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/runs.h"

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

}  // namespace

void HostTracer<Binary>::closest(const Device& device, const char* name, const Binary::View& view, uint32_t count,
                                 const Ray* rays, Hit* hits) const {
  inRuns(device, name, count,
         [=](uint32_t begin, uint32_t end) { closestOfRun<Binary>(view, rays, begin, end, hits); });
}

void HostTracer<Binary>::any(const Device& device, const char* name, const Binary::View& view, uint32_t count,
                             const Ray* rays, uint32_t* occluded) const {
  inRuns(device, name, count,
         [=](uint32_t begin, uint32_t end) { anyOfRun<Binary>(view, rays, begin, end, occluded); });
}

void HostTracer<Wide8>::closest(const Device& device, const char* name, const Wide8::View& view, uint32_t count,
                                const Ray* rays, Hit* hits) const {
  const auto trace = kernels_->closest;
  inRuns(device, name, count, [=](uint32_t begin, uint32_t end) { trace(view, rays, begin, end, hits); });
}

void HostTracer<Wide8>::any(const Device& device, const char* name, const Wide8::View& view, uint32_t count,
                            const Ray* rays, uint32_t* occluded) const {
  const auto trace = kernels_->any;
  inRuns(device, name, count, [=](uint32_t begin, uint32_t end) { trace(view, rays, begin, end, occluded); });
}

}  // namespace copse
