// Several rays per CPU thread in turn, one step of each: while one waits for its node to come from memory another
// computes, as warps do on a GPU.
#pragma once

#include "tracer/accel/walk.h"

namespace copse::inline COPSE_ISA {

/// Calls arrived(i, hit) for each of rays begin … end-1, in no particular order. For `any` the leaf that stopped one
/// ray is tried first for the next, which it often stops too (a shadow cache).
template <class Step, bool any, class Arrived, class Filter = AcceptAll>
inline void traverseInTurn(const typename Step::Format::View& view, const Ray* rays, uint32_t begin, uint32_t end,
                           const Arrived& arrived, const Filter& accepts = {}) {
  struct Lane {
    Walk<Step, any, Filter> walk;
    TriangleRay triangles;
    uint32_t ray;
    uint64_t stack[stackSize];
  };
  constexpr uint32_t lanes = any ? 4 : 8;  // More lanes gain nothing.
  Lane lane[lanes];
  uint32_t live = 0, next = begin, recent = emptyLink;
  const auto start = [&](Lane& l) {
    l.ray = next;
    const Ray& ray = rays[next++];
    if (!l.walk.start(view, ray)) return;
    l.triangles = TriangleRay(ray);
    if (any && recent != emptyLink) {
      l.walk.link = recent;
      l.stack[l.walk.depth++] = stackEntry(0, 0);  // The root.
    }
  };
  while (live < lanes && next < end) start(lane[live++]);
  while (live > 0)
    for (uint32_t k = 0; k < live;) {
      Lane& l = lane[k];
      if (l.walk.step(view, l.triangles, l.stack, accepts)) {
        // Not in a function of its own: g++ takes a call that only prefetches for one without effect, and removes it.
        if (isNode(l.walk.link)) {
          Step::prefetchNode(view, l.walk.link);
        } else {
          Step::prefetchLeaf(view, l.walk.link);
        }
        ++k;
        continue;
      }
      arrived(l.ray, l.walk.hit(view, l.triangles, accepts));
      if (any && l.walk.best.triangle != Hit::none) recent = l.walk.link;
      if (next < end)
        start(l);
      else if (--live > k)
        l = lane[live];
    }
}

}  // namespace copse::inline COPSE_ISA
