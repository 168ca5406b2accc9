// How many nodes and triangles rays visit: the walk of walk.h with a counter in it, one thread per ray on a GPU.
// Without counting, a CPU visits two siblings at a time and tries for a shadow ray first the leaf that stopped the
// previous one: fewer steps, but they do not depend on the tree alone.
#pragma once

#include <map>
#include <string>

#include "builder/parallel/buffer.h"
#include "tracer/accel/ray_tracer.h"

namespace copse {

/// How a StepTracer counts, for records.
inline constexpr const char* countedBy = "each ray by itself, one node at a time, the nearer child first";

/// The counter of a walk: adds its steps to `*steps`.
struct CountSteps {
  RaySteps* steps;
  HD void node() const { ++steps->nodes; }
  HD void triangle() const { ++steps->triangles; }
};

/// A batch as in StepTracer. Instantiated for each Format of tracer/accel.
template <class Format>
void countClosest(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
                  const Ray* rays, Hit* hits, RaySteps* steps);
template <class Format>
void countAny(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
              const Ray* rays, uint32_t* occluded, RaySteps* steps);

/// Totals over some rays.
struct TraversalSteps {
  uint64_t rays = 0, nodes = 0, triangles = 0;
};

/// Traces by a StepTracer, which must outlive it, and adds up the steps under each launch's name. It waits for the
/// device after each batch: for a pass that is not timed. Not for several host threads at once.
class CountingRayTracer final : public RayTracer {
 public:
  explicit CountingRayTracer(const StepTracer& tracer) : tracer_(tracer) {}
  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override;
  void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded) const override;

  /// The totals over all batches of that name so far; zeros where there was none.
  TraversalSteps steps(const std::string& name) const;

 private:
  RaySteps* room(const Device& device, uint32_t count) const;
  void add(const Device& device, const char* name, uint32_t count) const;

  const StepTracer& tracer_;
  mutable Buffer<RaySteps> ofRays_;
  mutable std::map<std::string, TraversalSteps> sums_;
};

}  // namespace copse
