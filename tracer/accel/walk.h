// A ray's walk through a tree, written once for every format, query and leaf filter: the closest hit, or whether there
// is any. The nearer child comes first, and the others go on a stack of 64 entries; a ray that needs more goes on
// without a stack (walk_deep.h). The hit depends on the triangles alone, not on the tree or on the way through it, and
// ties go to the lowest triangle: so formats, schedulers and devices agree bit for bit.
//
// A step is a type of a format that says what a walk does at a node:
//   Format                     the format that it reads;
//   start(boxRay)              keeps what it needs of a ray;
//   setLimits(tMin, tMax)      is called at the start and whenever the closest hit so far comes nearer;
//   visit<any>(view, boxRay, tMin, tMax, link, stack, depth) → Next
//                              tests the children of the node at `link`, sets `link` to the child to go on with or puts
//                              all of them on the stack, for a closest hit the nearest on top;
//   prefetchNode(view, link)   prefetches the node, and prefetchLeaf(view, link) a leaf.
// The step that visits one node at a time also has, for walk_deep.h:
//   test(view, boxRay, tMin, tMax, link, near[width]) → a bit for each child that is hit, and where all are entered.
// A scheduler owns the stack and decides which ray's step comes next: traverse() below takes one ray to its end,
// in_turn.h several per CPU thread, persistent.cu 32 lanes that each fetch the next ray when theirs is done.
#pragma once

#include <cstring>

#include "builder/parallel/bits.h"
#include "tracer/accel/walk_deep.h"

namespace copse::inline COPSE_ISA {

/// Entries of a stack. A walk that needs more goes on without one.
constexpr uint32_t stackSize = 64;

/// A child on the stack: the distance at which the ray enters it, whose bits sort as the number does, above its link.
HD inline uint64_t stackEntry(uint32_t link, float near) {
  uint32_t bits;
  std::memcpy(&bits, &near, sizeof bits);
  return static_cast<uint64_t>(bits) << 32 | link;
}

/// Where a walk goes on after a node.
enum class Next {
  child,   ///< At the link that the step has set.
  stack,   ///< At the top of the stack.
  tooDeep  ///< Nowhere: the stack is full.
};

/// One ray under way: to its closest hit, or to `any`. The stack is not a member: an indexed array is in memory, and on
/// a GPU its neighbours would be too. Nor is what only the triangle test needs, so that a GPU may recompute it at each
/// leaf and all that the node test needs stays in registers. `counter`, here and below, is absent, or one such as
/// CountSteps in counting.h: it is told of each triangle that is tested and of each node whose children are.
template <class Step, bool any, class Filter = AcceptAll>
struct Walk {
  using Format = typename Step::Format;
  using View = typename Format::View;

  BoxRay boxes;
  float tMin;
  Hit best;
  Step steps;
  uint32_t link;   ///< The next node or leaf; emptyLink where there is none.
  uint32_t depth;  ///< Of the stack; above its size where the walk has to be finished without one.

  /// Starts at the root. False for a ray that hits nothing because it is not finite, has no direction or no length, or
  /// because the tree is empty.
  HD bool start(const View& view, const Ray& ray) {
    const float pad = view.nodeCount ? BoxRay::padFor(ray.origin, *view.bounds) : FLT_MAX;
    const vec3 d = ray.direction;
    const float length = absOf(d.x) + absOf(d.y) + absOf(d.z);
    tMin = maxOf(ray.tMin, 0.0f);
    const bool valid = view.nodeCount > 0 && pad < FLT_MAX && length > 0 && length < FLT_MAX && tMin < ray.tMax;
    boxes = BoxRay(ray, pad);
    best = {ray.tMax, 0, 0, Hit::none};
    steps.start(boxes);
    steps.setLimits(tMin, best.t);
    link = valid ? 0 : emptyLink;
    depth = 0;
    return valid;
  }

  HD bool tooDeep() const { return depth > stackSize; }

  /// Pops up to the nearest entry of the stack that is not behind the closest hit.
  HD void pop(const uint64_t* stack) {
    uint32_t limit;
    std::memcpy(&limit, &best.t, sizeof limit);
    do {
      if (depth == 0) {
        link = emptyLink;
        return;
      }
      --depth;
    } while (stack[depth] >> 32 > limit);
    link = static_cast<uint32_t>(stack[depth]);
  }

  /// `link` is a node.
  template <class... Counter>
  HD void visitNode(const View& view, uint64_t* stack, Counter... counter) {
    (counter.node(), ...);
    const Next next = steps.template visit<any>(view, boxes, tMin, best.t, link, stack, depth);
    if (next == Next::stack) {
      pop(stack);
    } else if (next == Next::tooDeep) {
      link = emptyLink;
      depth = stackSize + 1;
    }
  }

  /// True where that ends the walk: for `any`, where a triangle is hit.
  template <class... Counter>
  HD bool testLeaf(const View& view, const TriangleRay& triangles, uint32_t leaf, const Filter& accepts,
                   Counter... counter) {
    if (intersectLeaf<any>(view, triangles, boxes, tMin, leaf, best, accepts, counter...)) return true;
    if (!any) steps.setLimits(tMin, best.t);
    return false;
  }

  /// Visits a node or a leaf. False when only hit() is left to do; `link` is then the leaf that stopped the ray,
  /// if one did.
  template <class... Counter>
  HD bool step(const View& view, const TriangleRay& triangles, uint64_t* stack, const Filter& accepts,
               Counter... counter) {
    if (isNode(link)) {
      visitNode(view, stack, counter...);
    } else {
      if (link == emptyLink || testLeaf(view, triangles, link, accepts, counter...)) return false;
      pop(stack);
    }
    return link != emptyLink;
  }

  /// What the ray hits.
  template <class... Counter>
  HD Hit hit(const View& view, const TriangleRay& triangles, const Filter& accepts, Counter... counter) const {
    return tooDeep() ? walkDeep<Format, any>(view, boxes, triangles, tMin, best, accepts, counter...) : best;
  }
};

/// Traces one ray to its end. For a closest hit: the nearest with tMin < t < tMax, where tMin below 0 counts as
/// 0; `triangle` is Hit::none and `t` tMax where there is none, as for a ray that is not finite or has no direction.
/// For `any` the first hit found.
template <class Step, bool any, class Filter = AcceptAll, class... Counter>
HD inline Hit traverse(const typename Step::Format::View& view, const Ray& ray, const Filter& accepts = {},
                       Counter... counter) {
  Walk<Step, any, Filter> walk;
  if (!walk.start(view, ray)) return walk.best;
  const TriangleRay triangles(ray);
  uint64_t stack[stackSize];
  while (walk.step(view, triangles, stack, accepts, counter...)) {
  }
  return walk.hit(view, triangles, accepts, counter...);
}

}  // namespace copse::inline COPSE_ISA
