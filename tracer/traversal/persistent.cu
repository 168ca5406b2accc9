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

/// One lane's ray on its way. The mathematics is the per-ray functions'; the warp only decides when it is done.
template <bool any>
struct Lane {
  const TraversalView& view;
  detail::RayInTree ray;
  Hit best;
  uint32_t link;  ///< Next node or leaf; emptyLink: none left.
  uint32_t leaf;  ///< The postponed leaf, or emptyLink.
  uint32_t depth = 0;
  StackEntry stack[detail::stackSize];

  HD explicit Lane(const TraversalView& v) : view(v), ray(v, Ray{}), best{}, link(emptyLink), leaf(emptyLink) {}

  HD void start(const Ray& r) {
    ray = detail::RayInTree(view, r);
    best = {r.tMax, 0, 0, Hit::none};
    link = ray.valid ? 0 : emptyLink;
    leaf = emptyLink;
    depth = 0;
  }
  HD bool finished() const { return link == emptyLink && leaf == emptyLink; }
  HD void finish() {
    link = leaf = emptyLink;
    depth = 0;
  }
  HD void pop() {
    link = emptyLink;
    while (depth > 0 && link == emptyLink)
      if (stack[--depth].near <= best.t) link = stack[depth].link;
  }

  HD void stepNode() {
    const TraversalNode& node = view.nodes[link];
    const BoxHits hits = ray.boxes.test(node, BoxRay::limits(ray.tMin, best.t));
    if ((hits.bits & 3) == 3) {
      if (depth == detail::stackSize) {
        best = detail::traverseDeep<any>(view, ray, best);
        finish();
        return;
      }
      const uint32_t far = hits.firstIsNear();
      float near[4];
      hits.near.store(near);
      stack[depth++] = {node.child[far], near[far]};
      link = node.child[far ^ 1];
    } else if (hits.bits & 3) {
      link = node.child[hits.bits >> 1 & 1];
    } else {
      pop();
    }
    if (!isNode(link) && leaf == emptyLink) postpone();
  }

  HD void postpone() {
    leaf = link;
    if (link != emptyLink) pop();
  }

  /// The postponed leaf, and the one after it where traversal stands at a second.
  HD void testLeaves() {
    while (leaf != emptyLink) {
      if (detail::intersectLeaf<any>(view, ray, leaf, best)) {
        finish();
      } else {
        leaf = emptyLink;
        if (!isNode(link)) postpone();
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

  HD void operator()(Warp& warp, uint32_t) const {
    const uint32_t total = count && *count < most ? *count : most;
    Lane<any> lane(view);
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
          lane.start(rays[mine]);
        }
        moreToFetch = first + wanted < total;
      }
      uint32_t working;
      do {
        while (warp.any(isNode(lane.link) && lane.leaf == emptyLink))
          if (isNode(lane.link)) lane.stepNode();
        lane.testLeaves();
        if (busy && lane.finished()) {
          write(answers[mine], lane.best);
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
