// A treelet's topology by agglomeration: the two clusters whose union has the least area become one, until one is left.
// Domingues and Pedrini: Bounding Volume Hierarchy Optimization through Agglomerative Treelet Restructuring (HPG 2015).
// O(m^2) areas and O(m^3) comparisons a treelet of m, against 3^m for the best topology.
#pragma once

#include "builder/methods/treelets/treelet.h"

namespace copse::treelets {

struct AgglomeratedTreelets {
  static constexpr uint32_t capacity = 20;

  struct Work {
    Treelet<capacity> clusters;  ///< `leaves` are the clusters' nodes.
    /// Area of the union of clusters row and column < row; numbers, at most FLT_MAX.
    float area[capacity * (capacity - 1) / 2];
    Box box[capacity];  ///< What is to be written if it pays, the treelet's root at 0.
    uint32_t left[capacity], right[capacity];
    Subtree subtree[capacity];
  };
  static constexpr uint32_t sharedBytes = sizeof(Work);

  uint32_t size;  ///< Leaves of a treelet, 3 to capacity.

  template <class Lanes>
  HD void restructure(Lanes& lanes, const Tree& tree, uint32_t root) const {
    Work& work = *static_cast<Work*>(lanes.shared());
    const uint32_t leaves = work.clusters.grow(lanes, tree, root, size);
    if (leaves < 3) return;
    const float before = tree.subtrees[root].cost;
    for (uint32_t k = lanes.lane(); k < pairs(leaves); k += Lanes::size) {
      const Pair pair = pairOf(k);
      work.area[k] = areaOfUnion(work.clusters.box(pair.row), work.clusters.box(pair.column));
    }
    lanes.sync();
    for (uint32_t count = leaves; count > 1; --count) join(lanes, work, count, tree.costs);
    if (!(work.subtree[0].cost < before - leastGain * before)) return;
    for (uint32_t k = lanes.lane(); k + 1 < leaves; k += Lanes::size)
      writeInner(tree, work.clusters.inner[k], work.box[k], work.left[k], work.right[k], work.subtree[k]);
  }

  struct Pair {
    uint32_t row, column;  ///< column < row.
  };
  HD static uint32_t pairs(uint32_t count) { return count * (count - 1) / 2; }
  HD static uint32_t indexOf(uint32_t a, uint32_t b) { return a > b ? pairs(a) + b : pairs(b) + a; }
  HD static Pair pairOf(uint32_t k) {
    const auto row = static_cast<uint32_t>((1 + sqrtf(static_cast<float>(8 * k + 1))) / 2);
    return {row, k - pairs(row)};
  }
  HD static float areaOfUnion(const Box& a, const Box& b) {
    const float area = unite(a, b).area();
    return area < FLT_MAX ? area : FLT_MAX;
  }

  /// Joins the closest two of `count` clusters: the pair's lower place has their union, its higher one the last cluster.
  template <class Lanes>
  HD static void join(Lanes& lanes, Work& work, uint32_t count, const Costs& costs) {
    Treelet<capacity>& c = work.clusters;
    const Pair pair = pairOf(lowest(lanes, pairs(count), [&](uint32_t k) { return work.area[k]; }).index);
    const uint32_t from = pair.column, other = pair.row, last = count - 1, slot = count - 2;
    const Box box = unite(c.box(from), c.box(other));
    const uint32_t triangles = c.count[from] + c.count[other];
    const float cost = costs.ofSubtree(box.area(), triangles, c.cost[from] + c.cost[other]);
    lanes.sync();
    if (lanes.lane() == 0) {
      work.box[slot] = box;
      work.left[slot] = c.leaves[from];
      work.right[slot] = c.leaves[other];
      work.subtree[slot] = {cost, triangles};
      c.setBox(from, box);
      c.leaves[from] = c.inner[slot];
      c.cost[from] = cost;
      c.count[from] = triangles;
      if (other != last) {
        c.setBox(other, c.box(last));
        c.leaves[other] = c.leaves[last];
        c.cost[other] = c.cost[last];
        c.count[other] = c.count[last];
      }
    }
    if (other != last)
      for (uint32_t k = lanes.lane(); k < last; k += Lanes::size)
        if (k != other && k != from) work.area[indexOf(other, k)] = work.area[indexOf(last, k)];
    lanes.sync();
    for (uint32_t k = lanes.lane(); k < last; k += Lanes::size)
      if (k != from) work.area[indexOf(from, k)] = areaOfUnion(box, c.box(k));
    lanes.sync();
  }
};

}  // namespace copse::treelets
