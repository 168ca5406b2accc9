// One ray through the tree: the closest hit, or whether there is any. The nearer child first, the other on a stack of
// 64 entries; a ray that would need more walks by the nodes' parents instead (traverse_deep.h).
// The hit depends on the triangles alone, not on the tree: ties go to the lowest triangle.
#pragma once

#include "tracer/traversal/ray_triangle.h"
#include "tracer/traversal/traverse_deep.h"

namespace copse {

namespace detail {

constexpr uint32_t stackSize = 64;

template <bool any>
HD inline Hit traverse(const TraversalView& view, const Ray& ray) {
  Hit best{ray.tMax, 0, 0, Hit::none};
  const RayInTree r(view, ray);
  if (!r.valid) return best;

  struct Entry {
    uint32_t link;
    float near;
  };
  Entry stack[stackSize];
  uint32_t depth = 0;
  uint32_t link = 0;
  Float4 limits = BoxRay::limits(r.tMin, best.t);
  while (true) {
    while (!(link & TraversalNode::leafBit)) {
      const TraversalNode& node = view.nodes[link];
      const BoxHits hits = r.boxes.test(node, limits);
      if ((hits.bits & 3) == 3) {
        if (depth == stackSize) return traverseDeep<any>(view, r, best);
        const uint32_t far = hits.firstIsNear();
        float near[4];
        hits.near.store(near);
        stack[depth++] = {node.child[far], near[far]};
        prefetch(&view.nodes[node.child[far]]);
        link = node.child[far ^ 1];
      } else if (hits.bits & 3) {
        link = node.child[hits.bits >> 1 & 1];
      } else {
        link = emptyLink;
      }
    }
    if (link != emptyLink) {
      if (intersectLeaf<any>(view, r, link, best)) return best;
      limits = BoxRay::limits(r.tMin, best.t);
    }
    do {
      if (depth == 0) return best;
      --depth;
    } while (stack[depth].near > best.t);
    link = stack[depth].link;
  }
}

}  // namespace detail

/// The nearest hit with tMin < t < tMax, where tMin below 0 counts as 0; `triangle` is Hit::none and `t` tMax where
/// there is none, as for a ray that is not finite or has no direction.
HD inline Hit closestHit(const TraversalView& view, const Ray& ray) { return detail::traverse<false>(view, ray); }

/// Whether anything is hit with tMin < t < tMax.
HD inline bool anyHit(const TraversalView& view, const Ray& ray) {
  return detail::traverse<true>(view, ray).triangle != Hit::none;
}

}  // namespace copse
