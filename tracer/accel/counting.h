// How many nodes and triangles rays visit: the per-ray traversal of traverse.h and traverse_wide.h with a counter in
// it. It takes one node at a time on every device and each ray by itself, so that the counts depend on the tree and the
// rays alone. What runs without counting on a CPU takes two siblings at a time, and tries for shadow rays the leaf
// first that stopped the ray before: fewer steps, but not of this tree alone.
#pragma once

#include <map>
#include <string>

#include "tracer/accel/ray_tracer.h"
#include "tracer/accel/traverse.h"
#include "tracer/accel/traverse_wide.h"

namespace copse {

/// Of some rays together. A node is one whose children's boxes were tested; a triangle is one that was tested, and
/// counts each time.
struct TraversalSteps {
  uint64_t rays = 0, nodes = 0, triangles = 0;
};

/// What the traversal functions tell of their steps: adds to `*steps`.
struct CountSteps {
  TraversalSteps* steps;
  HD void node() const { ++steps->nodes; }
  HD void triangle() const { ++steps->triangles; }
};

inline namespace COPSE_ISA {

/// The closest hit or, for `any`, any hit, with the ray and its steps added to `steps`.
template <bool any>
HD inline Hit countedHit(const TraversalView& view, const Ray& ray, TraversalSteps& steps) {
  ++steps.rays;
  const CountSteps counter{&steps};
  return view.wideNodes ? detail::traverseWide<any>(view, ray, counter)
                        : detail::traverseNodes<any>(view, ray, counter);
}

}  // namespace COPSE_ISA

/// Answers as BvhRayTracer does and adds up the steps under each launch's name. Slower, and it waits for the device
/// after each batch: for a pass that is not timed. Not for several host threads at once.
class CountingRayTracer final : public RayTracer {
 public:
  explicit CountingRayTracer(const TraversalView& view) : view_(view) {}
  void closest(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
               Hit* hits) const override;
  void any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
           uint32_t* occluded) const override;

  /// Of all batches of that name so far; zeros where there was none.
  TraversalSteps steps(const std::string& name) const;

 private:
  TraversalView view_;
  mutable std::map<std::string, TraversalSteps> steps_;
};

}  // namespace copse
