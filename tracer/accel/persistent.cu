// The resident warps fetch rays from a counter until none is left. A lane that reaches a leaf postpones it and goes on
// to the next node until most lanes have a leaf (or nothing to do), so that the lanes test nodes together and triangles
// together: waiting for the last one would leave two lanes in three idle. When too few lanes have a ray, those without
// one fetch new rays. All votes are convergent: lanes are predicated and never leave early.
#include "tracer/accel/persistent.h"

#include <algorithm>

#include "builder/parallel/atomics.h"
#include "builder/parallel/launch_warps.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/host_kernels.h"
#include "tracer/accel/wide8_steps.h"

namespace copse {

namespace {

/// For a ray that would need a longer stack. Not inlined: it is rare, and takes registers.
template <class Format, bool any, class Filter>
COPSE_RARE HD Hit startAgain(typename Format::View view, const Ray* own, Hit best, Filter accepts) {
  Walk<typename StepsOf<Format>::ByNodes, any, Filter> walk;
  const Ray ray = *own;
  walk.start(view, ray);
  return walkDeep<Format, any>(view, walk.boxes, TriangleRay(ray), walk.tMin, best, accepts);
}

/// One lane's ray under way. The walk is that of a single ray; the warp only decides when it goes on.
template <class Format, bool any, class Filter>
struct Lane {
  using View = typename Format::View;

  Walk<typename StepsOf<Format>::ByNodes, any, Filter> walk{};
  uint32_t leaf = emptyLink;  ///< The postponed leaf, or emptyLink.

  HD Lane() { walk.link = emptyLink; }
  HD void start(const View& view, Ray ray) {
    walk.start(view, ray);
    leaf = emptyLink;
  }
  HD bool searches() const { return isNode(walk.link) && leaf == emptyLink; }
  HD bool finished() const { return walk.link == emptyLink && leaf == emptyLink; }

  HD void stepNode(const View& view, uint64_t* stack) {
    walk.visitNode(view, stack);
    if (walk.tooDeep())
      leaf = emptyLink;
    else if (!isNode(walk.link) && leaf == emptyLink)
      postpone(stack);
  }

  HD void postpone(const uint64_t* stack) {
    leaf = walk.link;
    if (walk.link != emptyLink) walk.pop(stack);
  }

  /// Visits the postponed leaf, if there is one, and then a second where traversal has already reached it.
  HD void testLeaves(const View& view, const Ray* own, const uint64_t* stack, const Filter& accepts) {
    if (leaf == emptyLink) return;
    const Ray ray = *own;  // A copy takes two loads, a reference seven.
    const TriangleRay triangles(ray);
    do {
      if (walk.testLeaf(view, triangles, leaf, accepts)) {
        walk.link = leaf = emptyLink;
      } else {
        leaf = emptyLink;
        if (!isNode(walk.link)) postpone(stack);
      }
    } while (leaf != emptyLink);
  }
};

HD void write(Hit& to, const Hit& hit) { to = hit; }
HD void write(uint32_t& to, const Hit& hit) { to = hit.triangle != Hit::none; }

template <class Format, bool any, class Answer, class Filter = AcceptAll>
struct Persistent {
  typename Format::View view;
  PersistentSettings settings;
  uint32_t warps, count;
  const Ray* rays;
  Answer* answers;
  uint32_t* next;  ///< The next ray to fetch, and behind it the number of warps that are done.

  /// Blocks of four warps: as many as fit with 96 registers per thread, which hold all that a node takes.
  static constexpr int residentBlocks = 5;

  HD void operator()(Warp& warp, uint32_t) const {
    uint64_t stack[stackSize];
    Lane<Format, any, Filter> lane;
    const Filter accepts;
    uint32_t mine = 0;
    bool busy = false, moreToFetch = true;
    do {
      const uint32_t idle = warp.ballot(!busy);
      if (moreToFetch) {  // Uniform across the warp.
        const uint32_t leader = lowestBit(idle), wanted = popCount(idle);
        uint32_t first = 0;
        if (warp.lane() == leader) first = atomicAddRelaxed(next, wanted);
        first = warp.shfl(first, leader);
        mine = busy ? mine : first + warp.rank(idle);
        if (!busy && mine < count) {
          busy = true;
          lane.start(view, rays[mine]);
        }
        moreToFetch = first + wanted < count;
      }
      uint32_t working;
      do {
        while (true) {
          const uint32_t searching = warp.ballot(lane.searches());
          if (searching == 0) break;
          if (popCount(searching) <= settings.leave && warp.any(lane.leaf != emptyLink)) break;
          if (isNode(lane.walk.link)) lane.stepNode(view, stack);
        }
        lane.testLeaves(view, rays + mine, stack, accepts);
        if (busy && lane.finished()) {
          write(answers[mine], lane.walk.tooDeep() ? startAgain<Format, any>(view, rays + mine, lane.walk.best, accepts)
                                                   : lane.walk.best);
          busy = false;
        }
        working = popCount(warp.ballot(busy));
      } while (working > 0 && (working >= settings.fetch || !moreToFetch));
    } while (warp.any(busy || moreToFetch));
    if (warp.lane() == 0) leave();
  }

 private:
  /// The last warp resets the counters, so that the next launch finds them at 0 without a launch to clear them.
  HD void leave() const {
    if (atomicAddAcqRel(next + 1, 1u) + 1 < warps) return;
    atomicStoreRelaxed(next, 0u);
    atomicStoreRelaxed(next + 1, 0u);
  }
};

template <class Format>
using PersistentClosest = Persistent<Format, false, Hit>;
template <class Format>
using PersistentAny = Persistent<Format, true, uint32_t>;

uint32_t maxBlocks(const PersistentSettings& settings) { return settings.blocks ? settings.blocks : ~0u; }

constexpr ParameterSpec leaveSpec{
    .name = "trace.leave",
    .standard = 8,
    .min = 0,
    .max = 31,
    .meaning = "on a GPU, a warp tests leaves once at most this many of its lanes still look for one",
    .ofTree = false};
constexpr ParameterSpec fetchSpec{
    .name = "trace.fetch",
    .standard = 26,
    .min = 1,
    .max = 32,
    .meaning = "on a GPU, idle lanes fetch rays where fewer lanes of the warp than this have one",
    .ofTree = false};
constexpr ParameterSpec blocksSpec{
    .name = "trace.blocks",
    .standard = 0,
    .min = 0,
    .max = 32,
    .meaning =
        "on a GPU, the maximum of blocks (four warps each) per multiprocessor that trace rays; 0: as many as fit",
    .ofTree = false};

}  // namespace

std::vector<ParameterSpec> traceParameters() { return {leaveSpec, fetchSpec, blocksSpec, simdParameter()}; }

PersistentSettings::PersistentSettings(const Parameters& parameters)
    : leave(static_cast<uint32_t>(parameters.integer(leaveSpec))),
      fetch(static_cast<uint32_t>(parameters.integer(fetchSpec))),
      blocks(static_cast<uint32_t>(parameters.integer(blocksSpec))) {}

template <class Format>
PersistentTracer<Format>::PersistentTracer(const Device& device, const PersistentSettings& settings)
    : settings_(settings),
      closestWarps_(residentWarps<PersistentClosest<Format>>(device, 0, maxBlocks(settings))),
      anyWarps_(residentWarps<PersistentAny<Format>>(device, 0, maxBlocks(settings))),
      counters_(device, 2) {
  counters_.fill(0);
}

template <class Format>
void PersistentTracer<Format>::closest(const Device& device, const char* name, const View& view, uint32_t count,
                                       const Ray* rays, Hit* hits) const {
  if (count == 0) return;
  const uint32_t warps = std::min(closestWarps_, (count - 1) / Warp::size + 1);
  launchWarps(device, name, warps,
              PersistentClosest<Format>{view, settings_, warps, count, rays, hits, counters_.data()});
}

template <class Format>
void PersistentTracer<Format>::any(const Device& device, const char* name, const View& view, uint32_t count,
                                   const Ray* rays, uint32_t* occluded) const {
  if (count == 0) return;
  const uint32_t warps = std::min(anyWarps_, (count - 1) / Warp::size + 1);
  launchWarps(device, name, warps,
              PersistentAny<Format>{view, settings_, warps, count, rays, occluded, counters_.data()});
}

template class PersistentTracer<Binary>;
template class PersistentTracer<Wide8>;

}  // namespace copse
