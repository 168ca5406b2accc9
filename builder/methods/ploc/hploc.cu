// Parallel locally-ordered clustering along the radix tree: where the walk of lbvh-apetrei joins two ranges of leaves,
// the clusters that are left of them join their nearest until at most sixteen are left, in one kernel after the sort.
// Benthin et al.: H-PLOC: Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction
// (HPG 2024). What becomes of a range depends on its leaves alone, so the tree does not depend on who arrives first.
// O(n radius) and the radix sort.
#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/methods/lbvh.h"
#include "builder/methods/ploc/nearest.h"
#include "builder/parallel/one_lane.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace {

constexpr uint32_t maxKept = 16, maxRadius = 16;

/// A lane per leaf walks up; all lanes join the clusters of one lane's range after the other.
struct JoinRanges {
  using Clusters = ploc::Clusters<2 * maxKept, maxRadius>;
  static constexpr uint32_t nobody = ~0u;
  static constexpr uint32_t prefetchDistance = 16;  ///< In leaves.

  RadixTree tree;
  const Box* boxes;
  const uint32_t* order;
  ploc::Joins joins;
  ploc::Cluster* kept;  ///< What a range has left, from its first place on.
  uint32_t* otherEnd;   ///< Per split, as in lbvh-apetrei.
  uint32_t radius;

  struct Range {
    uint32_t first, split, last;
  };

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    const uint32_t i = index * Lanes::size + lanes.lane();
    bool walking = i < tree.count;
    Range range{i, i, i};
    if (walking) putLeaf(i);
    while (lanes.any(walking)) {
      walking = walking && !isRoot(range) && goUp(range);
      const bool due = walking && (range.last - range.first >= maxKept || isRoot(range));
      for (uint32_t lanesDue = lanes.ballot(due); lanesDue; lanesDue &= lanesDue - 1)
        joinRange(lanes, lanes.shfl(range, lowestBit(lanesDue)));
      lanes.sync();  // What other lanes wrote comes before this lane's next arrival.
    }
  }

  HD void putLeaf(uint32_t i) const {
    if (i + prefetchDistance < tree.count) prefetch(boxes + order[i + prefetchDistance]);
    const Box box = boxes[order[i]];  // A copy, for two loads of 16 bytes.
    joins.nodes[tree.count - 1 + i] = BvhNode::leaf(box, i, 1);
    kept[i] = {tree.count - 1 + i, i};
    if (tree.count == 1) joins.parents[0] = ParentLinks::none;
  }

  HD bool isRoot(const Range& range) const { return range.first == 0 && range.last == tree.count - 1; }

  /// To the parent's range, for the second of the two that meet there.
  HD bool goUp(Range& range) const {
    const bool left = range.first == 0 ||
                      (range.last != tree.count - 1 &&
                       tree.difference(range.last, range.last + 1) < tree.difference(range.first - 1, range.first));
    range.split = left ? range.last : range.first - 1;
    const uint32_t end = atomicExchangeAcqRel(otherEnd + range.split, left ? range.first : range.last);
    if (end == nobody) return false;
    (left ? range.last : range.first) = end;
    return true;
  }

  template <class Lanes>
  HD void joinRange(Lanes& lanes, const Range& range) const {
    auto& clusters = *static_cast<Clusters*>(lanes.shared());
    uint32_t count = load(lanes, clusters, 0, range.first, range.split);
    count = load(lanes, clusters, count, range.split + 1, range.last);
    const uint32_t target = isRoot(range) ? 1 : maxKept;
    while (count > target) count = clusters.round(lanes, count, radius, joins);
    for (uint32_t i = lanes.lane(); i < maxKept && range.first + i <= range.last; i += Lanes::size)
      kept[range.first + i] = i < count ? clusters.cluster[i] : ploc::Cluster{ploc::Cluster::nobody, 0};
    if (target == 1 && lanes.lane() == 0) bringToFront(joins.nodes, joins.parents, clusters.cluster[0].node);
    lanes.sync();
  }

  /// The clusters of first … last behind the `count` that are there; their new number.
  template <class Lanes>
  HD uint32_t load(Lanes& lanes, Clusters& clusters, uint32_t count, uint32_t first, uint32_t last) const {
    const uint32_t places = last - first < maxKept ? last - first + 1 : maxKept;
    for (uint32_t base = 0; base < places; base += Lanes::size) {
      const uint32_t i = base + lanes.lane();
      const ploc::Cluster cluster = i < places ? kept[first + i] : ploc::Cluster{ploc::Cluster::nobody, 0};
      const bool there = cluster.node != ploc::Cluster::nobody;
      const uint32_t found = lanes.ballot(there);
      if (there) clusters.put(count + lanes.lane(), joins.nodes[cluster.node].box(), cluster);
      if (!found) break;
      count += popCount(found);
    }
    lanes.sync();
    return count;
  }
};

OpenTree buildHploc(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  if (n == 0) return {};
  MortonOrder sorted = mortonOrder(device, input, parameters);
  Phase phase(device, phases::hierarchy);
  OpenTree bvh = treeOver(device, sorted);
  Buffer<uint32_t> otherEnd(device, n);
  otherEnd.fill(0xff);
  Buffer<ploc::Cluster> kept(device, n);
  launchLanes(device, "join ranges", n,
              JoinRanges{{sorted.keys.data(), n},
                         input.boxes,
                         bvh.order.data(),
                         {bvh.nodes.data(), bvh.parents.data()},
                         kept.data(),
                         otherEnd.data(),
                         static_cast<uint32_t>(parameters.integer("hploc.radius"))},
              sizeof(JoinRanges::Clusters), evenGrain(device, n, 256));
  return bvh;
}

}  // namespace

namespace methods {

Method hploc() {
  return {
      .name = "hploc",
      .source = "Benthin 2024",
      .meaning = "locally-ordered clustering along the radix tree, in one bottom-up pass",
      .family = "ploc",
      .page = "docs/builders/hploc.md",
      .build = buildHploc,
      .parameters = {{.name = "hploc.radius",
                      .standard = 8,
                      .min = 1,
                      .max = maxRadius,
                      .meaning = "places in Morton order, to either side, in which a cluster looks for its nearest"}}};
}

}  // namespace methods

}  // namespace copse
