// The warps that run fetch rays from a counter until none is left. A lane that reaches a leaf puts it aside and goes on
// to the next node until most lanes have a leaf (or nothing to do), so that the lanes test nodes together and triangles
// together: to wait for the last one would leave two lanes of three without work. When too few lanes have a ray, those
// without fetch new ones. All votes are convergent: lanes take part by predicate and never leave early.
#include "tracer/accel/persistent.h"

#include <algorithm>

#include "builder/parallel/atomics.h"
#include "builder/parallel/launch_warps.h"
#include "tracer/accel/traverse.h"

namespace copse {

namespace {

using detail::emptyLink;
using detail::StackEntry;

HD bool isNode(uint32_t link) { return !(link & TraversalNode::leafBit); }

/// For a ray that would need a longer stack. Not inlined: it is rare, and takes registers.
template <bool any>
COPSE_RARE HD Hit startAgain(TraversalView view, const Ray* ray, Hit best) {
  return detail::traverseDeep<any>(view, detail::RayInTree(view, *ray), best);
}

/// One lane's ray on its way. The mathematics is the per-ray functions'; the warp only decides when it is done. The
/// stack is no member: an array that is indexed lies in memory, and on a GPU what stands beside it would too. Nor is
/// what only triangles are tested with: it is made anew at each leaf, so that all that nodes are tested with has
/// registers.
template <bool any>
struct Lane {
  BoxRay boxes{};
  float tMin = 0;
  Hit best{};
  uint32_t link = emptyLink;  ///< Next node or leaf; emptyLink: none left.
  uint32_t leaf = emptyLink;  ///< The postponed leaf, or emptyLink.
  uint32_t depth = 0;         ///< Beyond the stack: finished, but startAgain() has to.

  HD void start(const TraversalView& view, Ray r) {
    const detail::RayInTree ray(view, r);
    boxes = ray.boxes;
    tMin = ray.tMin;
    best = {r.tMax, 0, 0, Hit::none};
    link = ray.valid ? 0 : emptyLink;
    leaf = emptyLink;
    depth = 0;
  }
  HD bool searches() const { return isNode(link) && leaf == emptyLink; }
  HD bool finished() const { return link == emptyLink && leaf == emptyLink; }
  HD bool tooDeep() const { return depth > detail::stackSize; }
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
    const BoxHits hits = boxes.test(node, BoxRay::limits(tMin, best.t));
    if ((hits.bits & 3) == 3) {
      if (depth == detail::stackSize) {
        link = leaf = emptyLink;
        ++depth;
        return;
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

  /// The postponed leaf, if there is one, and the one after it where traversal stands at a second.
  HD void testLeaves(const TraversalView& view, const Ray* own, const StackEntry* stack) {
    if (leaf == emptyLink) return;
    const Ray ray = *own;  // A copy is two loads, and a reference seven.
    const TriangleRay triangles(ray);
    do {
      if (detail::intersectLeaf<any>(view, triangles, boxes, tMin, leaf, best)) {
        link = leaf = emptyLink;
      } else {
        leaf = emptyLink;
        if (!isNode(link)) postpone(stack);
      }
    } while (leaf != emptyLink);
  }
};

HD void write(Hit& to, const Hit& hit) { to = hit; }
HD void write(uint32_t& to, const Hit& hit) { to = hit.triangle != Hit::none; }

template <bool any, class Answer>
struct Persistent {
  TraversalView view;
  PersistentSettings settings;
  uint32_t warps, most;
  const uint32_t* count;
  const Ray* rays;
  Answer* answers;
  uint32_t* next;  ///< The first ray that nobody has fetched, and behind it how many warps are done.

  /// Of four warps: what registers leave room for at 96 a thread, which all that a node takes fits into.
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
        while (true) {
          const uint32_t searching = warp.ballot(lane.searches());
          if (searching == 0) break;
          if (popCount(searching) <= settings.leave && warp.any(lane.leaf != emptyLink)) break;
          if (isNode(lane.link)) lane.stepNode(view, stack);
        }
        lane.testLeaves(view, rays + mine, stack);
        if (busy && lane.finished()) {
          write(answers[mine], lane.tooDeep() ? startAgain<any>(view, rays + mine, lane.best) : lane.best);
          busy = false;
        }
        working = popCount(warp.ballot(busy));
      } while (working > 0 && (working >= settings.fetch || !moreToFetch));
    } while (warp.any(busy || moreToFetch));
    if (warp.lane() == 0) leave();
  }

 private:
  /// The last warp sets the counters back, so that the next launch finds them at 0 and nobody has to be asked to.
  HD void leave() const {
    if (atomicAddAcqRel(next + 1, 1u) + 1 < warps) return;
    atomicStoreRelaxed(next, 0u);
    atomicStoreRelaxed(next + 1, 0u);
  }
};

using PersistentClosest = Persistent<false, Hit>;
using PersistentAny = Persistent<true, uint32_t>;

uint32_t mostBlocks(const PersistentSettings& settings) { return settings.blocks ? settings.blocks : ~0u; }

constexpr ParameterSpec leaveSpec{
    .name = "trace.leave",
    .standard = 8,
    .min = 0,
    .max = 31,
    .meaning = "on a GPU, lanes still on their way to a leaf at which those of their warp that have one no longer wait",
    .ofTree = false};
constexpr ParameterSpec fetchSpec{.name = "trace.fetch",
                                  .standard = 26,
                                  .min = 1,
                                  .max = 32,
                                  .meaning = "on a GPU, lanes with a ray below which idle ones fetch new rays",
                                  .ofTree = false};
constexpr ParameterSpec blocksSpec{
    .name = "trace.blocks",
    .standard = 0,
    .min = 0,
    .max = 32,
    .meaning =
        "on a GPU, blocks of four warps a multiprocessor that trace rays, at most; 0: as many as it has room for",
    .ofTree = false};

}  // namespace

std::vector<ParameterSpec> traceParameters() { return {leaveSpec, fetchSpec, blocksSpec}; }

PersistentSettings::PersistentSettings(const Parameters& parameters)
    : leave(static_cast<uint32_t>(parameters.integer(leaveSpec))),
      fetch(static_cast<uint32_t>(parameters.integer(fetchSpec))),
      blocks(static_cast<uint32_t>(parameters.integer(blocksSpec))) {}

PersistentTracer::PersistentTracer(const Device& device, const PersistentSettings& settings)
    : settings_(settings),
      closestWarps_(residentWarps<PersistentClosest>(device, 0, mostBlocks(settings))),
      anyWarps_(residentWarps<PersistentAny>(device, 0, mostBlocks(settings))),
      counters_(device, 2) {
  counters_.fill(0);
}

void PersistentTracer::closest(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                               const uint32_t* count, const Ray* rays, Hit* hits) const {
  if (most == 0) return;
  const uint32_t warps = std::min(closestWarps_, (most - 1) / Warp::size + 1);
  launchWarps(device, name, warps,
              PersistentClosest{view, settings_, warps, most, count, rays, hits, counters_.data()});
}

void PersistentTracer::any(const Device& device, const char* name, const TraversalView& view, uint32_t most,
                           const uint32_t* count, const Ray* rays, uint32_t* occluded) const {
  if (most == 0) return;
  const uint32_t warps = std::min(anyWarps_, (most - 1) / Warp::size + 1);
  launchWarps(device, name, warps,
              PersistentAny{view, settings_, warps, most, count, rays, occluded, counters_.data()});
}

}  // namespace copse
