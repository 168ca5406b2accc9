// A walk that needs no stack, for trees deeper than one: up by the nodes' parents, and down again into the child that
// comes second (Hapala et al. 2011). Each node is tested up to three times; memory is a link and where it came from.
#pragma once

#include "tracer/accel/ray_triangle.h"

namespace copse::detail::inline COPSE_ISA {

/// No node and no leaf: a leaf's first triangle is below 2^31 - 1.
constexpr uint32_t emptyLink = 0xffffffffu;

/// Entries of a stack. What would need more goes on without one.
constexpr uint32_t stackSize = 64;

/// All that is computed once for a ray.
struct RayInTree {
  float tMin;
  bool valid;
  BoxRay boxes;
  TriangleRay triangles;

  RayInTree() = default;
  HD RayInTree(const TraversalView& view, const Ray& ray)
      : RayInTree(view, ray, view.nodeCount ? BoxRay::padFor(ray.origin, view.nodes[0]) : FLT_MAX) {}

 private:
  HD RayInTree(const TraversalView& view, const Ray& ray, float pad)
      : tMin(maxOf(ray.tMin, 0.0f)), valid(isValid(view, ray, pad)), boxes(ray, pad), triangles(ray) {}

  HD bool isValid(const TraversalView& view, const Ray& ray, float pad) const {
    const vec3 d = ray.direction;
    const float length = absOf(d.x) + absOf(d.y) + absOf(d.z);
    return view.nodeCount > 0 && pad < FLT_MAX && length > 0 && length < FLT_MAX && tMin < ray.tMax;
  }
};

/// Tests a leaf's triangles; true where `any` and there is a hit.
/// `counter`, here and below, is nothing, or one such as CountSteps in counting.h: it is told of each triangle that is
/// tested and of each node whose children are.
template <bool any, class... Counter>
HD inline bool intersectLeaf(const TraversalView& view, const TriangleRay& triangles, const BoxRay& boxes, float tMin,
                             uint32_t link, Hit& best, Counter... counter) {
  const TraversalTriangle* triangle = view.triangles + (link & ~TraversalNode::leafBit);
  while (true) {
    (counter.triangle(), ...);
    if (intersect(triangles, boxes, tMin, *triangle, best) && any) return true;
    if (triangle->last) return false;
    ++triangle;
  }
}
template <bool any, class... Counter>
HD inline bool intersectLeaf(const TraversalView& view, const RayInTree& ray, uint32_t link, Hit& best,
                             Counter... counter) {
  return intersectLeaf<any>(view, ray.triangles, ray.boxes, ray.tMin, link, best, counter...);
}

/// Continues with `best`, from the root.
template <bool any, class... Counter>
HD inline Hit traverseDeep(const TraversalView& view, const RayInTree& ray, Hit best, Counter... counter) {
  uint32_t at = 0, from = emptyLink;  // `from` is the child that was left, or emptyLink on the way down.
  while (true) {
    const TraversalNode& node = view.nodes[at];
    (counter.node(), ...);
    const BoxHits hits = ray.boxes.test(node, BoxRay::limits(ray.tMin, best.t));
    // The order of the children depends on the ray alone, so that it is the same at each visit.
    const uint32_t first = hits.firstIsNear() ? 0 : 1;
    uint32_t down = emptyLink;
    for (uint32_t step = from == emptyLink ? 0 : from == node.child[first] ? 1 : 2; step < 2; ++step) {
      const uint32_t c = first ^ step;
      if (!hits.hit(c)) continue;
      if (!(node.child[c] & TraversalNode::leafBit)) {
        down = node.child[c];
        break;
      }
      if (intersectLeaf<any>(view, ray, node.child[c], best, counter...)) return best;
    }
    if (down != emptyLink) {
      at = down;
      from = emptyLink;
    } else {
      if (at == 0) return best;
      from = at;
      at = view.parents[at];
    }
  }
}

}  // namespace copse::detail::inline COPSE_ISA
