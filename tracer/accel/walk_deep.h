// A stackless walk, for trees deeper than the stack, in any format: up to a node's parent, and down again into the next
// child (Hapala et al. 2011, for two children). Each node is tested again for each of its children; the state is a link
// and where the walk came from, so a tree may have any depth. Degenerate trees have thousands of levels, and a longer
// stack would have to be device memory that is allocated per batch of rays.
#pragma once

#include "tracer/accel/ray_triangle.h"

namespace copse::inline COPSE_ISA {

/// The steps of a format; each format specialises it.
///   ByNodes  one node at a time: on a GPU, and where steps are counted;
///   InTurn   for several rays in turn on a CPU;
///   InARow   for coherent rays, one after another on a CPU, or void.
template <class Format>
struct StepsOf;

/// Tests a leaf's triangles; true where `any` and there is a hit.
template <bool any, class View, class Filter, class... Counter>
HD inline bool intersectLeaf(const View& view, const TriangleRay& triangles, const BoxRay& boxes, float tMin,
                             uint32_t leaf, Hit& best, const Filter& accepts, Counter... counter) {
  const TraversalTriangle* triangle = view.triangles + (leaf & ~leafBit);
  while (true) {
    (counter.triangle(), ...);
    if (intersect(triangles, boxes, tMin, *triangle, best, accepts) && any) return true;
    if (triangle->last) return false;
    ++triangle;
  }
}

/// The children of a node that are hit, in the order in which the ray enters them: that depends on the ray alone, so it
/// is the same at each visit. Ties are in the order of their slots.
template <uint32_t width>
struct OrderedChildren {
  float near[width];
  uint32_t hit;  ///< One bit per child.

  /// The slot that comes after `slot`, or the first where `slot` is `width`; `width` where there is none.
  HD uint32_t after(uint32_t slot) const {
    uint32_t next = width;
    for (uint32_t k = 0; k < width; ++k)
      if ((hit >> k & 1) && (slot == width || isBefore(slot, k)) && (next == width || isBefore(k, next))) next = k;
    return next;
  }

 private:
  HD bool isBefore(uint32_t a, uint32_t b) const { return near[a] < near[b] || (near[a] == near[b] && a < b); }
};

/// Continues with `best`, from the root.
template <class Format, bool any, class Filter, class... Counter>
HD inline Hit walkDeep(const typename Format::View& view, const BoxRay& boxes, const TriangleRay& triangles, float tMin,
                       Hit best, const Filter& accepts, Counter... counter) {
  typename StepsOf<Format>::ByNodes steps;
  steps.start(boxes);
  uint32_t at = 0, from = emptyLink;  // `from` is the child that was left, or emptyLink on the way down.
  while (true) {
    (counter.node(), ...);
    steps.setLimits(tMin, best.t);
    OrderedChildren<Format::width> children;
    children.hit = steps.test(view, boxes, tMin, best.t, at, children.near);
    const uint32_t* const child = view.nodes[at].child;
    uint32_t slot = Format::width;
    if (from != emptyLink)
      for (slot = 0; child[slot] != from;) ++slot;
    while ((slot = children.after(slot)) != Format::width && !isNode(child[slot]))
      if (intersectLeaf<any>(view, triangles, boxes, tMin, child[slot], best, accepts, counter...)) return best;
    if (slot != Format::width) {
      at = child[slot];
      from = emptyLink;
    } else {
      if (at == 0) return best;
      from = at;
      at = view.parents[at];
    }
  }
}

}  // namespace copse::inline COPSE_ISA
