// The warps that run fetch rays from a counter until none is left. A lane that reaches a leaf puts it aside and goes on
// to the next node until every lane has a leaf (or nothing to do), so that the lanes test nodes together and triangles
// together. When too few lanes have a ray, those without fetch new ones. All votes are convergent: lanes take part by
// predicate and never leave early.
#include "tracer/traversal/persistent.h"

#include <algorithm>

#include "builder/parallel/atomics.h"
#include "builder/parallel/buffer.h"
#include "builder/parallel/launch_warps.h"
#include "tracer/traversal/traverse.h"

namespace copse {

namespace {

/// With fewer lanes at work than this, idle ones fetch rays. Aila and Laine's choice.
constexpr uint32_t busyLanes = 20;

using detail::emptyLink;
using detail::StackEntry;

HD bool isNode(uint32_t link) { return !(link & TraversalNode::leafBit); }

/// For a ray that would need a longer stack. Not inlined: it is rare, and takes registers.
template <bool any>
COPSE_RARE HD Hit startAgain(TraversalView view, const Ray* ray, Hit best) {
  return detail::traverseDeep<any>(view, detail::RayInTree(view, *ray), best);
}

/// One lane's ray on its way. The mathematics is the per-ray functions'; the warp only decides when it is done. The
/// stack is no member: an array that is indexed lies in memory, and on a GPU what stands beside it would too.
template <bool any>
struct Lane {
  detail::RayInTree ray{};
  Hit best{};
  uint32_t link = emptyLink;  ///< Next node or leaf; emptyLink: none left.
  uint32_t leaf = emptyLink;  ///< The postponed leaf, or emptyLink.
  uint32_t depth = 0;
  bool tooDeep = false;  ///< Finished, but startAgain() has to.

  HD void start(const TraversalView& view, Ray r) {
    ray = detail::RayInTree(view, r);
    best = {r.tMax, 0, 0, Hit::none};
    link = ray.valid ? 0 : emptyLink;
    leaf = emptyLink;
    depth = 0;
    tooDeep = false;
  }
  HD bool finished() const { return link == emptyLink && leaf == emptyLink; }
  HD void finish() {
    link = leaf = emptyLink;
    depth = 0;
  }
  HD void pop(const StackEntry* stack) {
    link = emptyLink;
    while (depth > 0 && link == emptyLink) {
      const StackEntry top = stack[--depth];
      if (top.near <= best.t) link = top.link;
    }
  }

  HD void stepNode(const TraversalView& view, StackEntry* stack) {
    const TraversalNode& node = view.nodes[link];
    const uint32_t first = node.child[0], second = node.child[1];
    const BoxHits hits = ray.boxes.test(node, BoxRay::limits(ray.tMin, best.t));
    if ((hits.bits & 3) == 3) {
      if (depth == detail::stackSize) {
        tooDeep = true;
        return finish();
      }
      const bool firstIsNear = hits.firstIsNear();
      stack[depth++] = {firstIsNear ? second : first, hits.enter(firstIsNear)};
      link = firstIsNear ? first : second;
    } else if (hits.bits & 3) {
      link = hits.hit(1) ? second : first;
    } else {
      pop(stack);
    }
    if (!isNode(link) && leaf == emptyLink) postpone(stack);
  }

  HD void postpone(const StackEntry* stack) {
    leaf = link;
    if (link != emptyLink) pop(stack);
  }

  /// The postponed leaf, and the one after it where traversal stands at a second.
  HD void testLeaves(const TraversalView& view, const StackEntry* stack) {
    while (leaf != emptyLink) {
      if (detail::intersectLeaf<any>(view, ray, leaf, best)) {
        finish();
      } else {
        leaf = emptyLink;
        if (!isNode(link)) postpone(stack);
      }
    }
  }
};

HD void write(Hit& to, const Hit& hit) { to = hit; }
HD void write(uint32_t& to, const Hit& hit) { to = hit.triangle != Hit::none; }

template <bool any, class Answer>
struct Persistent {
  TraversalView view;
  uint32_t most;
  const uint32_t* count;
  const Ray* rays;
  Answer* answers;
  uint32_t* next;  ///< The first ray that nobody has fetched.

  /// Of four warps. Left to itself ptxas takes registers for 16 warps; for 20 it keeps five of a lane's numbers in
  /// memory, which its neighbours' lie beside.
  static constexpr int residentBlocks = 5;

  HD void operator()(Warp& warp, uint32_t) const {
    const uint32_t total = count && *count < most ? *count : most;
    StackEntry stack[detail::stackSize];
    Lane<any> lane;
    uint32_t mine = 0;
    bool busy = false, moreToFetch = true;
    do {
      const uint32_t idle = warp.ballot(!busy);
      if (moreToFetch) {  // The same in all lanes.
        const uint32_t leader = lowestBit(idle), wanted = popCount(idle);
        uint32_t first = 0;
        if (warp.lane() == leader) first = atomicAddRelaxed(next, wanted);
        first = warp.shfl(first, leader);
        mine = busy ? mine : first + warp.rank(idle);
        if (!busy && mine < total) {
          busy = true;
          lane.start(view, rays[mine]);
        }
        moreToFetch = first + wanted < total;
      }
      uint32_t working;
      do {
        while (warp.any(isNode(lane.link) && lane.leaf == emptyLink))
          if (isNode(lane.link)) lane.stepNode(view, stack);
        lane.testLeaves(view, stack);
        if (busy && lane.finished()) {
          write(answers[mine], lane.tooDeep ? startAgain<any>(view, rays + mine, lane.best) : lane.best);
          busy = false;
        }
        working = popCount(warp.ballot(busy));
      } while (working >= busyLanes || (working > 0 && !moreToFetch));
    } while (warp.any(busy || moreToFetch));
  }
};

template <bool any, class Answer>
void trace(const Device& device, const char* name, const TraversalView& view, uint32_t most, const uint32_t* count,
           const Ray* rays, Answer* answers) {
  if (most == 0) return;
  using Kernel = Persistent<any, Answer>;
  const uint32_t warps = std::min(residentWarps<Kernel>(device), (most - 1) / Warp::size + 1);
  Buffer<uint32_t> next(device, 1);
  next.fill(0);
  launchWarps(device, name, warps, Kernel{view, most, count, rays, answers, next.data()});
}

}  // namespace

void traceClosestPersistent(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                            const uint32_t* count, const Ray* rays, Hit* hits) {
  trace<false>(device, name, view, most, count, rays, hits);
}

void traceAnyPersistent(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                        const uint32_t* count, const Ray* rays, uint32_t* occluded) {
  trace<true>(device, name, view, most, count, rays, occluded);
}

}  // namespace copse
