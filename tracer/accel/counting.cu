// A launch with one ray per index, and a sum by a fixed tree, without atomics.
#include "tracer/accel/counting.h"

#include "builder/parallel/launch.h"
#include "builder/parallel/reduce.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/wide8_steps.h"

namespace copse {

namespace {

constexpr uint32_t grain = 256;  // Rays that a CPU thread takes at a time.

template <class Format, bool any>
HD Hit counted(const typename Format::View& view, const Ray& ray, RaySteps& steps) {
  RaySteps counts{0, 0};
  const Hit hit = traverse<typename StepsOf<Format>::ByNodes, any>(view, ray, AcceptAll{}, CountSteps{&counts});
  steps = counts;
  return hit;
}

template <class Format>
struct CountClosest {
  typename Format::View view;
  const Ray* rays;
  Hit* hits;
  RaySteps* steps;
  HD void operator()(uint32_t i) const { hits[i] = counted<Format, false>(view, rays[i], steps[i]); }
};

template <class Format>
struct CountAny {
  typename Format::View view;
  const Ray* rays;
  uint32_t* occluded;
  RaySteps* steps;
  HD void operator()(uint32_t i) const {
    occluded[i] = counted<Format, true>(view, rays[i], steps[i]).triangle != Hit::none;
  }
};

struct StepsOfRay {
  const RaySteps* steps;
  HD TraversalSteps operator()(uint32_t i) const { return {1, steps[i].nodes, steps[i].triangles}; }
};

struct AddSteps {
  HD TraversalSteps operator()(const TraversalSteps& a, const TraversalSteps& b) const {
    return {a.rays + b.rays, a.nodes + b.nodes, a.triangles + b.triangles};
  }
};

}  // namespace

template <class Format>
void countClosest(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
                  const Ray* rays, Hit* hits, RaySteps* steps) {
  launch(device, name, count, CountClosest<Format>{view, rays, hits, steps}, grain);
}

template <class Format>
void countAny(const Device& device, const char* name, const typename Format::View& view, uint32_t count,
              const Ray* rays, uint32_t* occluded, RaySteps* steps) {
  launch(device, name, count, CountAny<Format>{view, rays, occluded, steps}, grain);
}

template void countClosest<Binary>(const Device&, const char*, const Binary::View&, uint32_t, const Ray*, Hit*,
                                   RaySteps*);
template void countAny<Binary>(const Device&, const char*, const Binary::View&, uint32_t, const Ray*, uint32_t*,
                               RaySteps*);
template void countClosest<Wide8>(const Device&, const char*, const Wide8::View&, uint32_t, const Ray*, Hit*,
                                  RaySteps*);
template void countAny<Wide8>(const Device&, const char*, const Wide8::View&, uint32_t, const Ray*, uint32_t*,
                              RaySteps*);

void CountingRayTracer::closest(const Device& device, const char* name, uint32_t count, const Ray* rays,
                                Hit* hits) const {
  tracer_.closest(device, name, count, rays, hits, room(device, count));
  add(device, name, count);
}

void CountingRayTracer::any(const Device& device, const char* name, uint32_t count, const Ray* rays,
                            uint32_t* occluded) const {
  tracer_.any(device, name, count, rays, occluded, room(device, count));
  add(device, name, count);
}

RaySteps* CountingRayTracer::room(const Device& device, uint32_t count) const {
  if (ofRays_.size() < count) ofRays_ = Buffer<RaySteps>(device, count);
  return ofRays_.data();
}

void CountingRayTracer::add(const Device& device, const char* name, uint32_t count) const {
  TraversalSteps& sum = sums_[name];
  sum = AddSteps{}(sum, reduce(device, name, count, TraversalSteps{}, StepsOfRay{ofRays_.data()}, AddSteps{}));
}

TraversalSteps CountingRayTracer::steps(const std::string& name) const {
  const auto found = sums_.find(name);
  return found == sums_.end() ? TraversalSteps{} : found->second;
}

}  // namespace copse
