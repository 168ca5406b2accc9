// A treelet's topology by agglomeration: the two clusters of the smallest union become one, until one is left.
// Domingues and Pedrini: Bounding Volume Hierarchy Optimization through Agglomerative Treelet Restructuring (HPG 2015).
// O(m^2) areas and O(m^3) comparisons per treelet of m, against 3^m for the best topology.
#pragma once

#include <type_traits>

#include "builder/optimise/treelets/cluster_areas.h"

namespace copse::treelets {

/// Treelets of at most `maxLeaves` leaves.
template <uint32_t maxLeaves>
struct AgglomeratedTreelets {
  template <class Areas>
  struct Work {
    typename Areas::Clusters clusters;  ///< `leaves` are the clusters' nodes.
    Areas areas;
    Box box[maxLeaves];  ///< What is to be written if it pays, the treelet's root at 0.
    uint32_t left[maxLeaves], right[maxLeaves];
    Subtree subtree[maxLeaves];
  };

  uint32_t size;  ///< Leaves of a treelet, 3 to `maxLeaves`.

  uint32_t sharedBytes(bool oneLane) const {
    return oneLane ? sizeof(Work<RowAreas<maxLeaves>>) : sizeof(Work<PackedAreas<maxLeaves>>);
  }

  template <class Lanes>
  HD void restructure(Lanes& lanes, const Tree& tree, uint32_t root) const {
    using Areas = std::conditional_t<Lanes::size == 1, RowAreas<maxLeaves>, PackedAreas<maxLeaves>>;
    auto& work = *static_cast<Work<Areas>*>(lanes.shared());
    const uint32_t leaves = work.clusters.grow(lanes, tree, root, size);
    if (leaves < 3) return;
    const float before = tree.subtrees[root].cost;
    work.areas.fill(lanes, work.clusters, leaves);
    for (uint32_t count = leaves; count > 1; --count) join(lanes, work, count, tree.costs);
    if (!(work.subtree[0].cost < before - minGain * before)) return;
    for (uint32_t k = lanes.lane(); k + 1 < leaves; k += Lanes::size)
      writeInner(tree, work.clusters.inner[k], work.box[k], work.left[k], work.right[k], work.subtree[k]);
  }

  /// Joins the closest two of `count` clusters: the pair's lower place has their union, the higher the last cluster.
  template <class Lanes, class Areas>
  HD static void join(Lanes& lanes, Work<Areas>& work, uint32_t count, const LeafRule& costs) {
    typename Areas::Clusters& c = work.clusters;
    const ClusterPair pair = work.areas.closest(lanes, count);
    const uint32_t last = count - 1, slot = count - 2;
    const Box box = unite(c.box(pair.low), c.box(pair.high));
    const uint32_t triangles = c.count[pair.low] + c.count[pair.high];
    const float cost = costs.ofSubtree(box.area(), triangles, c.cost[pair.low] + c.cost[pair.high]);
    work.areas.join(lanes, c, pair, box, count);
    if (lanes.lane() == 0) {
      work.box[slot] = box;
      work.left[slot] = c.leaves[pair.low];
      work.right[slot] = c.leaves[pair.high];
      work.subtree[slot] = {cost, triangles};
      c.setBox(pair.high, c.box(last));
      c.leaves[pair.high] = c.leaves[last];
      c.cost[pair.high] = c.cost[last];
      c.count[pair.high] = c.count[last];
      c.setBox(pair.low, box);
      c.leaves[pair.low] = c.inner[slot];
      c.cost[pair.low] = cost;
      c.count[pair.low] = triangles;
    }
    lanes.sync();
  }
};

}  // namespace copse::treelets
