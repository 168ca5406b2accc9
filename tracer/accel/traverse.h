// One ray through the tree: the closest hit, or whether there is any. The nearer child first, the others on a stack of
// 64 entries; a ray that would need more walks by the nodes' parents instead (traverse_deep.h).
// A GPU takes a node at a time. A host takes two siblings at a time and tests their four children at once: about half
// the steps, each of the same few vector instructions. The hit is the same: it depends on the triangles alone, not on
// the tree or on the way through it, and ties go to the lowest triangle.
#pragma once

#include "builder/parallel/bits.h"
#include "tracer/accel/ray_triangle.h"
#include "tracer/accel/traverse_deep.h"

namespace copse::detail::inline COPSE_ISA {

/// A child that was put aside, and where the ray enters it.
struct alignas(8) StackEntry {
  uint32_t link;
  float near;
};

/// A node at a time.
template <bool any, class... Counter>
HD inline Hit traverseNodes(const TraversalView& view, const Ray& ray, Counter... counter) {
  Hit best{ray.tMax, 0, 0, Hit::none};
  const RayInTree r(view, ray);
  if (!r.valid) return best;
  StackEntry stack[stackSize];
  uint32_t depth = 0;
  uint32_t link = 0;
  F32x4 limits = BoxRay::limits(r.tMin, best.t);
  while (true) {
    while (!(link & TraversalNode::leafBit)) {
      const TraversalNode& node = view.nodes[link];
      const uint32_t first = node.child[0], second = node.child[1];
      (counter.node(), ...);
      const BoxHits hits = r.boxes.test(node, limits);
      if ((hits.bits & 3) == 3) {
        if (depth == stackSize) return traverseDeep<any>(view, r, best, counter...);
        const bool firstIsNear = hits.firstIsNear();
        stack[depth++] = {firstIsNear ? second : first, hits.enter(firstIsNear)};
        link = firstIsNear ? first : second;
      } else {
        link = hits.bits & 3 ? (hits.hit(1) ? second : first) : emptyLink;
      }
    }
    if (link != emptyLink) {
      if (intersectLeaf<any>(view, r, link, best, counter...)) return best;
      limits = BoxRay::limits(r.tMin, best.t);
    }
    do {
      if (depth == 0) return best;
      --depth;
    } while (stack[depth].near > best.t);
    link = stack[depth].link;
  }
}

/// The children of two siblings that are hit, `bits` of them, nearest first; at least one. Returns their number.
HD inline uint32_t childrenInOrder(const TraversalNode nodes[2], uint32_t bits, const float near[8],
                                   StackEntry children[4]) {
  uint32_t count = 0;
  for (; bits; bits &= bits - 1) {
    const uint32_t lane = lowestBit(bits);
    const StackEntry child{nodes[lane >> 2].below[lane & 1], near[lane]};
    uint32_t at = count++;
    for (; at > 0 && child.near < children[at - 1].near; --at) children[at] = children[at - 1];
    children[at] = child;
  }
  return count;
}

/// The closest hit, two siblings at a time where they stand side by side.
HD inline Hit closestHitByPairs(const TraversalView& view, const Ray& ray) {
  Hit best{ray.tMax, 0, 0, Hit::none};
  const RayInTree r(view, ray);
  if (!r.valid) return best;
  StackEntry stack[stackSize];
  uint32_t depth = 0;
  uint32_t link = 0;
  F32x8 limits = BoxRay::limitsTwice(r.tMin, best.t);
  while (true) {
    while (!(link & TraversalNode::leafBit)) {
      if (link & TraversalNode::pairBit) {
        const TraversalNode* nodes = view.nodes + (link & ~TraversalNode::pairBit);
        alignas(32) float near[8];
        uint32_t bits = r.boxes.testPair(nodes[0], nodes[1], limits, near);
        if (bits == 0) {
          link = emptyLink;
          break;
        }
        const uint32_t lane = lowestBit(bits);
        link = nodes[lane >> 2].below[lane & 1];
        const uint32_t others = bits & (bits - 1);
        if (others == 0) continue;
        if (depth + 3 > stackSize) return traverseDeep<false>(view, r, best);
        if ((others & (others - 1)) == 0) {
          const uint32_t other = lowestBit(others);
          StackEntry far{nodes[other >> 2].below[other & 1], near[other]};
          if (far.near < near[lane]) {
            const uint32_t nearer = far.link;
            far = {link, near[lane]};
            link = nearer;
          }
          stack[depth++] = far;
        } else {
          StackEntry children[4];
          const uint32_t count = childrenInOrder(nodes, bits, near, children);
          for (uint32_t i = count - 1; i > 0; --i) stack[depth++] = children[i];
          link = children[0].link;
        }
      } else {
        const TraversalNode& node = view.nodes[link];
        const BoxHits hits = r.boxes.test(node, limits.lower());
        if ((hits.bits & 3) == 3) {
          if (depth == stackSize) return traverseDeep<false>(view, r, best);
          const uint32_t far = hits.firstIsNear();
          float near[4];
          hits.near.store(near);
          stack[depth++] = {node.below[far], near[far]};
          link = node.below[far ^ 1];
        } else {
          link = hits.bits & 3 ? node.below[hits.bits >> 1 & 1] : emptyLink;
        }
      }
    }
    if (link != emptyLink) {
      intersectLeaf<false>(view, r, link, best);
      limits = BoxRay::limitsTwice(r.tMin, best.t);
    }
    do {
      if (depth == 0) return best;
      --depth;
    } while (stack[depth].near > best.t);
    link = stack[depth].link;
  }
}

/// Whether there is any hit, two siblings at a time. In no order, as any order will do: what is put aside is links
/// alone.
HD inline bool anyHitByPairs(const TraversalView& view, const Ray& ray) {
  Hit best{ray.tMax, 0, 0, Hit::none};
  const RayInTree r(view, ray);
  if (!r.valid) return false;
  const F32x8 limits = BoxRay::limitsTwice(r.tMin, best.t);
  uint32_t stack[stackSize];
  uint32_t depth = 0;
  uint32_t link = 0;
  while (true) {
    if (link & TraversalNode::leafBit) {
      if (intersectLeaf<true>(view, r, link, best)) return true;
    } else {
      const TraversalNode* nodes = view.nodes + (link & ~TraversalNode::pairBit);
      alignas(32) float near[8];
      uint32_t bits = link & TraversalNode::pairBit ? r.boxes.testPair(nodes[0], nodes[1], limits, near)
                                                    : r.boxes.test(*nodes, limits.lower()).bits & 3;
      if (bits) {
        if (depth + 3 > stackSize) return traverseDeep<true>(view, r, best).triangle != Hit::none;
        uint32_t lane = lowestBit(bits);
        link = nodes[lane >> 2].below[lane & 1];
        while (bits &= bits - 1) {
          stack[depth++] = link;
          lane = lowestBit(bits);
          link = nodes[lane >> 2].below[lane & 1];
        }
        continue;
      }
    }
    if (depth == 0) return false;
    link = stack[--depth];
  }
}

}  // namespace copse::detail::inline COPSE_ISA

namespace copse::inline COPSE_ISA {

/// The nearest hit with tMin < t < tMax, where tMin below 0 counts as 0; `triangle` is Hit::none and `t` tMax where
/// there is none, as for a ray that is not finite or has no direction.
HD inline Hit closestHit(const TraversalView& view, const Ray& ray) {
#if COPSE_DEVICE_CODE
  return detail::traverseNodes<false>(view, ray);
#else
  return detail::closestHitByPairs(view, ray);
#endif
}

/// Whether anything is hit with tMin < t < tMax.
HD inline bool anyHit(const TraversalView& view, const Ray& ray) {
#if COPSE_DEVICE_CODE
  return detail::traverseNodes<true>(view, ray).triangle != Hit::none;
#else
  return detail::anyHitByPairs(view, ray);
#endif
}

}  // namespace copse::inline COPSE_ISA
