// Steps of a walk through binary nodes. A GPU visits one node at a time. A CPU visits two siblings at a time where they
// are adjacent and tests their four children at once: about half the steps, each of the same few vector instructions.
#pragma once

#include "tracer/accel/walk.h"

namespace copse::inline COPSE_ISA {

/// The first two of a leaf.
HD inline void prefetchTriangles(const Binary::View& view, uint32_t link) {
  const TraversalTriangle* const triangle = view.triangles + (link & ~leafBit);
  prefetch(triangle);
  prefetch(triangle + 1);
}

/// Visits one node.
class NodeStep {
 public:
  using Format = Binary;

  HD void start(const BoxRay&) {}
  HD void setLimits(float, float) {}

  template <bool any>
  HD Next visit(const Binary::View& view, const BoxRay& boxes, float tMin, float tMax, uint32_t& link, uint64_t* stack,
                uint32_t& depth) const {
    const BinaryNode& node = view.nodes[link];
    const uint32_t first = node.child[0], second = node.child[1];
    const BoxHits hits = boxes.test(node, BoxRay::limits(tMin, tMax));
    if ((hits.bits & 3) == 3) {
      if (depth == stackSize) return Next::tooDeep;
      const bool firstIsNear = hits.firstIsNear();
      stack[depth++] = stackEntry(firstIsNear ? second : first, hits.enter(firstIsNear));
      link = firstIsNear ? first : second;
      return Next::child;
    }
    if (!(hits.bits & 3)) return Next::stack;
    link = hits.hit(1) ? second : first;
    return Next::child;
  }

  HD uint32_t test(const Binary::View& view, const BoxRay& boxes, float tMin, float tMax, uint32_t link,
                   float near[2]) const {
    const BoxHits hits = boxes.test(view.nodes[link], BoxRay::limits(tMin, tMax));
    near[0] = hits.enter(false), near[1] = hits.enter(true);
    return hits.bits & 3;
  }

  HD static void prefetchNode(const Binary::View& view, uint32_t link) { prefetch(view.nodes + link); }
  HD static void prefetchLeaf(const Binary::View& view, uint32_t link) { prefetchTriangles(view, link); }
};

/// What both steps over siblings share: `link` and the entries of the stack are the `below` of a BinaryNode.
class PairLimits {
 public:
  using Format = Binary;

  HD void start(const BoxRay&) {}
  HD void setLimits(float tMin, float tMax) { limits_ = BoxRay::limitsTwice(tMin, tMax); }

  HD static void prefetchNode(const Binary::View& view, uint32_t link) {
    const BinaryNode* const node = view.nodes + (link & ~BinaryNode::pairBit);
    prefetch(node);
    prefetch(node + 1);
  }
  HD static void prefetchLeaf(const Binary::View& view, uint32_t link) { prefetchTriangles(view, link); }

 protected:
  F32x8 limits_;
};

/// Visits a node, or two siblings, without a branch on which children are hit, as that cannot be predicted for
/// incoherent rays.
class PairStep : public PairLimits {
 public:
  template <bool any>
  HD Next visit(const Binary::View& view, const BoxRay& boxes, float, float, uint32_t& link, uint64_t* stack,
                uint32_t& depth) const {
    if (depth + 4 > stackSize) return Next::tooDeep;
    uint64_t* const to = stack + depth;
    const uint32_t pair = link & BinaryNode::pairBit ? 1 : 0;
    const BinaryNode& first = view.nodes[link & ~BinaryNode::pairBit];
    const BinaryNode& second = *(&first + pair);
    alignas(32) float near[8];
    const uint32_t bits = boxes.testPair(first, second, limits_, near) & (pair ? 0x33 : 0x03);
    if (any) {  // Any order will do. A node's larger child is second, and so is popped first.
      uint64_t* top = to;
      *top = first.below[0], top += bits & 1;
      *top = first.below[1], top += bits >> 1 & 1;
      *top = second.below[0], top += bits >> 4 & 1;
      *top = second.below[1], top += bits >> 5 & 1;
      depth += static_cast<uint32_t>(top - to);
      return Next::stack;
    }
    uint64_t a = entry(first.below[0], near[0], bits), b = entry(first.below[1], near[1], bits >> 1);
    uint64_t c = entry(second.below[0], near[4], bits >> 4), d = entry(second.below[1], near[5], bits >> 5);
    descend(a, b);
    descend(c, d);
    descend(a, c);
    descend(b, d);
    descend(b, c);  // Now the children that are hit come first, the nearest of them last; the others, all 0, follow.
    to[0] = a, to[1] = b, to[2] = c, to[3] = d;
    depth += (bits & 1) + (bits >> 1 & 1) + (bits >> 4 & 1) + (bits >> 5 & 1);
    return Next::stack;
  }

 private:
  /// 0 where the child is not hit.
  HD static uint64_t entry(uint32_t link, float near, uint32_t hit) {
    return stackEntry(link, near) & (0 - static_cast<uint64_t>(hit & 1));
  }
  HD static void descend(uint64_t& a, uint64_t& b) {
    const uint64_t x = a, y = b;
    a = x > y ? x : y;
    b = x > y ? y : x;
  }
};

/// Visits a node, or two siblings, with branches on how many children are hit: coherent rays make them predictable.
class SteadyPairStep : public PairLimits {
 public:
  template <bool any>
  HD Next visit(const Binary::View& view, const BoxRay& boxes, float, float, uint32_t& link, uint64_t* stack,
                uint32_t& depth) const {
    if (!(link & BinaryNode::pairBit)) return visitOne(view.nodes[link], boxes, link, stack, depth);
    const BinaryNode* nodes = view.nodes + (link & ~BinaryNode::pairBit);
    alignas(32) float near[8];
    const uint32_t bits = boxes.testPair(nodes[0], nodes[1], limits_, near);
    if (bits == 0) return Next::stack;
    const uint32_t lane = lowestBit(bits);
    link = nodes[lane >> 2].below[lane & 1];
    const uint32_t others = bits & (bits - 1);
    if (others == 0) return Next::child;
    if (depth + 3 > stackSize) return Next::tooDeep;
    if ((others & (others - 1)) == 0) {
      const uint32_t other = lowestBit(others), otherLink = nodes[other >> 2].below[other & 1];
      const bool otherIsNear = near[other] < near[lane];
      stack[depth++] = stackEntry(otherIsNear ? link : otherLink, near[otherIsNear ? lane : other]);
      if (otherIsNear) link = otherLink;
    } else {
      uint64_t children[4];
      const uint32_t count = childrenInOrder(nodes, bits, near, children);
      for (uint32_t i = count - 1; i > 0; --i) stack[depth++] = children[i];
      link = static_cast<uint32_t>(children[0]);
    }
    return Next::child;
  }

 private:
  HD Next visitOne(const BinaryNode& node, const BoxRay& boxes, uint32_t& link, uint64_t* stack,
                   uint32_t& depth) const {
    const BoxHits hits = boxes.test(node, limits_.lower());
    if (!(hits.bits & 3)) return Next::stack;
    if ((hits.bits & 3) == 3) {
      if (depth == stackSize) return Next::tooDeep;
      const uint32_t far = hits.firstIsNear();
      float near[4];
      hits.near.store(near);
      stack[depth++] = stackEntry(node.below[far], near[far]);
      link = node.below[far ^ 1];
    } else {
      link = node.below[hits.bits >> 1 & 1];
    }
    return Next::child;
  }

  /// Sorts those children of two siblings that are hit, as `bits` says, nearest first; at least one is. Returns their
  /// number.
  HD static uint32_t childrenInOrder(const BinaryNode nodes[2], uint32_t bits, const float near[8],
                                     uint64_t children[4]) {
    uint32_t count = 0;
    for (; bits; bits &= bits - 1) {
      const uint32_t lane = lowestBit(bits);
      const uint64_t child = stackEntry(nodes[lane >> 2].below[lane & 1], near[lane]);
      uint32_t at = count++;
      for (; at > 0 && child < children[at - 1]; --at) children[at] = children[at - 1];
      children[at] = child;
    }
    return count;
  }
};

template <>
struct StepsOf<Binary> {
  using ByNodes = NodeStep;
  using InTurn = PairStep;
  using InARow = SteadyPairStep;
};

}  // namespace copse::inline COPSE_ISA
