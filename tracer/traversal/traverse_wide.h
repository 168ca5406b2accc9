// One ray through wide nodes: a node's up to eight children are tested at once, those that are hit go on the stack with
// the nearest on top. Below the last wide nodes the tree is binary, and two siblings are tested at a time. The box test
// is that of ray_box.h number for number, so the hit is the binary tree's bit for bit. A ray that would need more than
// the stack's 64 entries goes on through the binary tree by its nodes' parents.
#pragma once

#include "builder/parallel/bits.h"
#include "tracer/traversal/traverse.h"

namespace copse::detail {

/// A BoxRay's numbers, each in all of eight lanes.
struct WideBoxRay {
  uint32_t nearPlane[3], farPlane[3];  ///< Rows of a WideNode.
  Float8 nearOrigin[3], farOrigin[3], nearScale[3], farScale[3];

  HD explicit WideBoxRay(const BoxRay& ray) {
    set(0, ray.originX, ray.scaleX);
    set(1, ray.originY, ray.scaleY);
    set(2, ray.originZ, ray.scaleZ);
  }

  /// One bit a child that is hit between tMin and tMax; near[k] says where child k is entered.
  HD uint32_t test(const WideNode& node, Float8 tMin, Float8 minusTMax, float near[8]) const {
    Float8 enter = tMin, leave = minusTMax;  // `leave` is negative, so that both are maxima.
    for (int axis = 0; axis < 3; ++axis) {
      enter = maxOf((load8(node.planes[nearPlane[axis]]) - nearOrigin[axis]) * nearScale[axis], enter);
      leave = maxOf((load8(node.planes[farPlane[axis]]) - farOrigin[axis]) * farScale[axis], leave);
    }
    enter.store(near);
    return notAboveZero(enter + leave);
  }

 private:
  HD void set(uint32_t axis, Float8 origin, Float8 scale) {
    float o[4], s[4];
    origin.low().store(o);
    scale.low().store(s);
    const uint32_t backward = s[0] < 0 ? 3 : 0;
    nearPlane[axis] = axis + backward;
    farPlane[axis] = axis + 3 - backward;
    nearOrigin[axis] = allOf(o[0]);
    farOrigin[axis] = allOf(o[2]);
    nearScale[axis] = allOf(s[0]);
    farScale[axis] = allOf(s[2]);
  }
};

/// Puts the children that are hit on the stack, for a closest hit the nearest on top; returns the top one instead of
/// leaving it there, or emptyLink where there is none. linkOf(k) is the link of the child of bit k.
template <bool any, class LinkOf>
HD inline uint32_t nearestChild(uint32_t bits, const float near[8], const LinkOf& linkOf, StackEntry* stack,
                                uint32_t& depth) {
  if (bits == 0) return emptyLink;
  const uint32_t base = depth;
  while (bits & (bits - 1)) {
    const uint32_t k = lowestBit(bits);
    bits &= bits - 1;
    const StackEntry child{linkOf(k), near[k]};
    uint32_t at = depth++;
    for (; !any && at > base && stack[at - 1].near < child.near; --at) stack[at] = stack[at - 1];
    stack[at] = child;
  }
  const uint32_t last = lowestBit(bits);
  uint32_t at = depth;
  if (any || at == base || !(stack[at - 1].near < near[last])) return linkOf(last);
  const uint32_t top = stack[--at].link;
  for (; at > base && stack[at - 1].near < near[last]; --at) stack[at] = stack[at - 1];
  stack[at] = {linkOf(last), near[last]};
  return top;
}

/// As closestHit() and, for `any`, anyHit(), for a view with wide nodes.
template <bool any>
HD inline Hit traverseWide(const TraversalView& view, const Ray& ray) {
  Hit best{ray.tMax, 0, 0, Hit::none};
  const RayInTree r(view, ray);
  if (!r.valid) return best;
  const WideBoxRay boxes(r.boxes);
  const Float8 tMin = allOf(r.tMin);
  Float8 minusTMax = allOf(-best.t), limits = Float8::both(BoxRay::limits(r.tMin, best.t));
  StackEntry stack[stackSize];
  uint32_t depth = 0;
  uint32_t link = WideNode::bit;  // The root.
  while (true) {
    while (!(link & TraversalNode::leafBit)) {
      if (depth + WideNode::width > stackSize) return traverseDeep<any>(view, r, best);
      alignas(32) float near[8];
      if (link & WideNode::bit) {
        const WideNode& node = view.wideNodes[link & ~WideNode::bit];
        const uint32_t bits = boxes.test(node, tMin, minusTMax, near);
        link = nearestChild<any>(
            bits, near, [&](uint32_t k) { return node.child[k]; }, stack, depth);
      } else {
        const bool pair = link & TraversalNode::pairBit;
        const TraversalNode* const nodes = view.nodes + (link & ~TraversalNode::pairBit);
        const uint32_t bits = r.boxes.testPair(nodes[0], nodes[pair], limits, near) & (pair ? 0x33 : 0x03);
        link = nearestChild<any>(
            bits, near, [&](uint32_t k) { return nodes[k >> 2].below[k & 1]; }, stack, depth);
      }
    }
    if (link != emptyLink) {
      if (intersectLeaf<any>(view, r, link, best)) return best;
      minusTMax = allOf(-best.t);
      limits = Float8::both(BoxRay::limits(r.tMin, best.t));
    }
    do {
      if (depth == 0) return best;
      --depth;
    } while (stack[depth].near > best.t);
    link = stack[depth].link;
  }
}

}  // namespace copse::detail
