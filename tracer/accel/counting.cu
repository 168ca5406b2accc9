// Counts are summed in a fixed tree, without atomics: the same on any number of threads and on both devices.
#include "tracer/accel/counting.h"

#include <algorithm>

#include "builder/parallel/reduce.h"

namespace copse {

namespace {

/// Traces ray i and answers it; the value is what it took.
struct CountClosest {
  TraversalView view;
  const Ray* rays;
  Hit* hits;
  HD TraversalSteps operator()(uint32_t i) const {
    TraversalSteps steps;
    hits[i] = countedHit<false>(view, rays[i], steps);
    return steps;
  }
};

struct CountAny {
  TraversalView view;
  const Ray* rays;
  uint32_t* occluded;
  HD TraversalSteps operator()(uint32_t i) const {
    TraversalSteps steps;
    occluded[i] = countedHit<true>(view, rays[i], steps).triangle != Hit::none;
    return steps;
  }
};

struct AddSteps {
  HD TraversalSteps operator()(const TraversalSteps& a, const TraversalSteps& b) const {
    return {a.rays + b.rays, a.nodes + b.nodes, a.triangles + b.triangles};
  }
};

uint32_t raysOf(const Device& device, uint32_t most, const uint32_t* count) {
  if (!count) return most;
  uint32_t counted;
  copyToHost(device, &counted, count, sizeof counted);
  return std::min(most, counted);
}

}  // namespace

void CountingRayTracer::closest(const Device& device, const char* name, uint32_t most, const uint32_t* count,
                                const Ray* rays, Hit* hits) const {
  TraversalSteps& sum = steps_[name];
  sum = AddSteps{}(sum, reduce(device, name, raysOf(device, most, count), TraversalSteps{},
                               CountClosest{view_, rays, hits}, AddSteps{}));
}

void CountingRayTracer::any(const Device& device, const char* name, uint32_t most, const uint32_t* count,
                            const Ray* rays, uint32_t* occluded) const {
  TraversalSteps& sum = steps_[name];
  sum = AddSteps{}(sum, reduce(device, name, raysOf(device, most, count), TraversalSteps{},
                               CountAny{view_, rays, occluded}, AddSteps{}));
}

TraversalSteps CountingRayTracer::steps(const std::string& name) const {
  const auto found = steps_.find(name);
  return found == steps_.end() ? TraversalSteps{} : found->second;
}

}  // namespace copse
