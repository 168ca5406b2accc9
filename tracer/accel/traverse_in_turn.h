// Several rays of a host's thread in turn, a step of each: while one waits for its node to come from memory another
// computes, as warps do on a GPU. No branch of a step depends on which children are hit, as that cannot be foreseen for
// rays that have nothing to do with each other. For neighbours that take the same way it can, and then the functions of
// traverse.h are faster. Two siblings at a time where they stand side by side: their four children are tested at once.
#pragma once

#include <cstring>

#include "tracer/accel/ray_triangle.h"
#include "tracer/accel/traverse_deep.h"

namespace copse::detail::inline COPSE_ISA {

/// A step of a Walk: a node of the binary tree, or two siblings where they stand side by side.
class PairSteps {
 public:
  static constexpr uint32_t most = 4;  ///< Children that a step puts aside.

  HD void start(const BoxRay&) {}
  HD void setLimits(float tMin, float tMax) { limits_ = BoxRay::limitsTwice(tMin, tMax); }

  /// Writes the children that are hit, for a closest hit the nearest last, and returns their number. All of to[0] …
  /// to[most - 1] may be written.
  template <bool any>
  HD uint32_t putAside(const TraversalView& view, const BoxRay& ray, uint32_t link, uint64_t* to) const {
    const uint32_t pair = link & TraversalNode::pairBit ? 1 : 0;
    const TraversalNode& first = view.nodes[link & ~TraversalNode::pairBit];
    const TraversalNode& second = *(&first + pair);
    alignas(32) float near[8];
    const uint32_t bits = ray.testPair(first, second, limits_, near) & (pair ? 0x33 : 0x03);
    if (any) {  // In any order. The larger child of a node stands second, and then comes off first.
      uint64_t* top = to;
      *top = first.below[0], top += bits & 1;
      *top = first.below[1], top += bits >> 1 & 1;
      *top = second.below[0], top += bits >> 4 & 1;
      *top = second.below[1], top += bits >> 5 & 1;
      return static_cast<uint32_t>(top - to);
    }
    uint64_t a = entry(first.below[0], near[0], bits), b = entry(first.below[1], near[1], bits >> 1);
    uint64_t c = entry(second.below[0], near[4], bits >> 4), d = entry(second.below[1], near[5], bits >> 5);
    descend(a, b);
    descend(c, d);
    descend(a, c);
    descend(b, d);
    descend(b, c);  // The nearest of those that are hit is now the last, and the others, all 0, follow.
    to[0] = a, to[1] = b, to[2] = c, to[3] = d;
    return (bits & 1) + (bits >> 1 & 1) + (bits >> 4 & 1) + (bits >> 5 & 1);
  }

  HD static void prefetchNode(const TraversalView& view, uint32_t link) {
    const TraversalNode* const node = view.nodes + (link & ~TraversalNode::pairBit);
    prefetch(node);
    prefetch(node + 1);
  }

 private:
  /// A child that was put aside: where the ray enters it, which as a number orders as its bits do, and its link.
  HD static uint64_t entry(uint32_t link, float near, uint32_t hit) {
    uint32_t bits;
    std::memcpy(&bits, &near, sizeof bits);
    return (static_cast<uint64_t>(bits) << 32 | link) & (0 - static_cast<uint64_t>(hit & 1));
  }
  HD static void descend(uint64_t& a, uint64_t& b) {
    const uint64_t x = a, y = b;
    a = x > y ? x : y;
    b = x > y ? y : x;
  }

  F32x8 limits_;
};

/// A ray on its way to its closest hit, or to `any`, by steps of PairSteps or of WideSteps.
template <bool any, class Steps>
class Walk {
 public:
  /// `first` is a leaf to try before the tree, or emptyLink.
  HD void start(const TraversalView& view, const Ray& ray, uint32_t first) {
    ray_ = RayInTree(view, ray);
    best_ = {ray.tMax, 0, 0, Hit::none};
    steps_.start(ray_.boxes);
    steps_.setLimits(ray_.tMin, best_.t);
    link_ = ray_.valid ? first : emptyLink;
    depth_ = 0;
    if (!ray_.valid) return;
    stack_[depth_++] = 0;  // The root.
    if (first == emptyLink) pop(view);
  }

  /// A leaf, or what the steps take at a time. False when the ray has arrived.
  template <class... Counter>
  HD bool step(const TraversalView& view, Counter... counter) {
    if (link_ & TraversalNode::leafBit) {
      if (link_ == emptyLink || (intersectLeaf<any>(view, ray_, link_, best_, counter...) && any)) return false;
      steps_.setLimits(ray_.tMin, best_.t);
      return pop(view);
    }
    if (depth_ + Steps::most > stackSize) {
      best_ = traverseDeep<any>(view, ray_, best_, counter...);
      link_ = emptyLink;
      return false;
    }
    (counter.node(), ...);
    depth_ += steps_.template putAside<any>(view, ray_.boxes, link_, stack_ + depth_);
    return pop(view);
  }

  HD const Hit& best() const { return best_; }
  /// The leaf that stopped the ray, if one did, or emptyLink.
  HD uint32_t occluder() const { return best_.triangle == Hit::none ? emptyLink : link_; }

 private:
  HD bool pop(const TraversalView& view) {
    uint32_t best;
    std::memcpy(&best, &best_.t, sizeof best);
    do {
      if (depth_ == 0) return false;
      --depth_;
    } while (stack_[depth_] >> 32 > best);
    link_ = static_cast<uint32_t>(stack_[depth_]);
    if (link_ & TraversalNode::leafBit) {
      const TraversalTriangle* const triangle = view.triangles + (link_ & ~TraversalNode::leafBit);
      prefetch(triangle);
      prefetch(triangle + 1);
    } else {
      Steps::prefetchNode(view, link_);
    }
    return true;
  }

  RayInTree ray_;
  Hit best_;
  Steps steps_;
  uint32_t link_, depth_;
  uint64_t stack_[stackSize];
};

/// Calls arrived(i, hit) for each of rays begin … end-1, in no order. For `any` the leaf that stopped one ray is the
/// first that is tried for the next: its neighbour is often stopped by it too (a shadow cache).
template <bool any, class Steps, class Arrived>
HD inline void traverseInTurn(const TraversalView& view, const Ray* rays, uint32_t begin, uint32_t end,
                              const Arrived& arrived) {
  constexpr uint32_t most = any ? 4 : 8;  // More gain no more.
  Walk<any, Steps> walks[most];
  uint32_t of[most], live = 0, next = begin, recent = emptyLink;
  for (; live < most && next < end; ++live) {
    of[live] = next;
    walks[live].start(view, rays[next++], recent);
  }
  while (live > 0)
    for (uint32_t k = 0; k < live;) {
      Walk<any, Steps>& walk = walks[k];
      if (walk.step(view)) {
        ++k;
        continue;
      }
      arrived(of[k], walk.best());
      if (any && walk.occluder() != emptyLink) recent = walk.occluder();
      if (next < end) {
        of[k] = next;
        walk.start(view, rays[next++], recent);
      } else if (--live > k) {
        of[k] = of[live];
        walk = walks[live];
      }
    }
}

}  // namespace copse::detail::inline COPSE_ISA
