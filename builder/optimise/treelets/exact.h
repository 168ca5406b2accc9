// The best topology of a treelet of at most seven leaves, by dynamic programming over its 127 subsets of leaves.
// Karras and Aila: Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (HPG 2013).
// (3^m + 1) / 2 - 2^m partitions per treelet of m. A subset's cost is a minimum over the same sums whatever their
// order, so 32 lanes and one lane may share the work as suits them; which partition it was is found again where the
// treelet is rebuilt.
#pragma once

#include <array>

#include "builder/optimise/treelets/exact_eights.h"
#include "builder/parallel/bits.h"

namespace copse::treelets {

/// Which subsets of two to six leaves each lane of a warp solves, in turn: sizes 2, 3, 3, 4, 4, 5, 6, one byte each; 0
/// for none. A subset of six is solved by four lanes side by side.
struct LaneSchedule {
  static constexpr uint32_t turns = 7;
  uint64_t bytes;

  HD uint32_t subset(uint32_t turn) const { return static_cast<uint32_t>(bytes >> (8 * turn)) & 0xff; }
};
std::array<LaneSchedule, 32> laneSchedules();

struct ExactTreelets {
  struct Work {
    Treelet<8> treelet;
    SubsetCosts costs;
    uint32_t parts[SubsetCosts::maxLeaves];
  };

  uint32_t size;                  ///< Leaves of a treelet, 3 to 7.
  const LaneSchedule* schedules;  ///< 32, in the device's memory.

  uint32_t sharedBytes(bool) const { return sizeof(Work); }

  template <class Lanes>
  HD void restructure(Lanes& lanes, const Tree& tree, uint32_t root) const {
    Work& work = *static_cast<Work*>(lanes.shared());
    const uint32_t leaves = work.treelet.grow(lanes, tree, root, size);
    if (leaves < 3) return;
    const float before = tree.subtrees[root].cost;
    if constexpr (Lanes::size == 1) {
      weighByEights(work.costs, work.treelet, leaves, tree.costs);
      solveByEights(work.costs, leaves);
    } else {
      weigh(lanes, work, leaves, tree.costs);
      solve(lanes, work.costs, leaves);
    }
    if (work.costs.min[(1u << leaves) - 1] < before - minGain * before) rebuild(lanes, work, leaves, tree);
  }

  /// Costs of every subset as a node and as a leaf, from its box and its triangles. A leaf of the treelet has its cost.
  template <class Lanes>
  HD static void weigh(Lanes& lanes, Work& work, uint32_t leaves, const LeafRule& costs) {
    const Treelet<8>& t = work.treelet;
    for (uint32_t s = 1 + lanes.lane(); s < 1u << leaves; s += Lanes::size) {
      const Part part = partOf(t, s);
      const float area = part.box.area();
      work.costs.node[s] = costs.ofNode(area, part.count);
      work.costs.leaf[s] = costs.asLeaf(area, part.count);
      if (!isInner(s)) work.costs.min[s] = t.cost[lowestBit(s)];
    }
    lanes.sync();
  }

  template <class Lanes>
  HD void solve(Lanes& lanes, SubsetCosts& costs, uint32_t leaves) const {
    const uint32_t all = (1u << leaves) - 1;
    const LaneSchedule schedule = schedules[lanes.lane()];
    for (uint32_t turn = 0; turn < LaneSchedule::turns; ++turn) {
      const uint32_t s = schedule.subset(turn);
      const bool mine = s && s <= all, together = turn + 1 == LaneSchedule::turns;
      const float best = mine ? minCost(costs, s, together ? lanes.lane() % 4 : 0, together ? 2 : 0) : INFINITY;
      finishTogether(lanes, costs, mine ? s : 0, best, together ? 4 : 1);
    }
    if (leaves == SubsetCosts::maxLeaves)
      finishTogether(lanes, costs, all, minCost(costs, all, lanes.lane(), 5), Lanes::size);
  }

  /// The minimum sum over those partitions of `s` whose one part has, of its highest `bits` leaves, those of `choice`.
  HD static float minCost(const SubsetCosts& costs, uint32_t s, uint32_t choice, uint32_t bits) {
    uint32_t rest = s & (s - 1), fixed = 0;
    for (uint32_t i = 0; i < bits; ++i) {
      const uint32_t highest = 0x80000000u >> leadingZeros(rest);
      rest ^= highest;
      if (choice >> i & 1) fixed |= highest;
    }
    float best = fixed ? costs.sum(s, fixed) : INFINITY;
    for (uint32_t p = rest & (0 - rest); p; p = (p - rest) & rest) best = minOf(costs.sum(s, fixed | p), best);
    return best;
  }

  /// The minimum of `group` neighbouring lanes' values finishes subset `s`, if any.
  template <class Lanes>
  HD static void finishTogether(Lanes& lanes, SubsetCosts& costs, uint32_t s, float best, uint32_t group) {
    for (uint32_t step = 1; step < group; step *= 2) best = minOf(lanes.shfl(best, lanes.lane() ^ step), best);
    if (s && lanes.lane() % group == 0) costs.min[s] = minOf(costs.node[s] + best, costs.leaf[s]);
    lanes.sync();
  }

  /// Writes the topology of minimum cost, from the root down, over the treelet's own inner nodes.
  template <class Lanes>
  HD static void rebuild(Lanes& lanes, Work& work, uint32_t leaves, const Tree& tree) {
    const Treelet<8>& t = work.treelet;
    if (lanes.lane() == 0) work.parts[0] = (1u << leaves) - 1;
    lanes.sync();
    for (uint32_t k = 0, used = 1; k + 1 < leaves; ++k) {
      const uint32_t s = work.parts[k], right = bestPartition(lanes, work.costs, s, leaves), left = s ^ right;
      const uint32_t leftSlot = used, rightSlot = used + isInner(left);
      used = rightSlot + isInner(right);
      if (lanes.lane() == 0) {
        if (isInner(left)) work.parts[leftSlot] = left;
        if (isInner(right)) work.parts[rightSlot] = right;
        const Part part = partOf(t, s);
        writeInner(tree, t.inner[k], part.box, isInner(left) ? t.inner[leftSlot] : t.leaves[lowestBit(left)],
                   isInner(right) ? t.inner[rightSlot] : t.leaves[lowestBit(right)], {work.costs.min[s], part.count});
      }
      lanes.sync();
    }
  }

  /// The first of the partitions of `s` of minimum sum, as the part without the lowest leaf.
  template <class Lanes>
  HD static uint32_t bestPartition(Lanes& lanes, const SubsetCosts& costs, uint32_t s, uint32_t leaves) {
    const uint32_t rest = s & (s - 1), first = rest & (0 - rest);
    uint32_t best = Candidate::none;
    if constexpr (Lanes::size == 1) {
      float min = INFINITY;
      for (uint32_t p = first; p; p = (p - rest) & rest)
        if (const float sum = costs.sum(s, p); sum < min) {
          min = sum;
          best = p;
        }
    } else {
      const auto sum = [&](uint32_t p) { return p && (p & ~rest) == 0 ? costs.sum(s, p) : INFINITY; };
      best = lowest(lanes, 1u << leaves, sum).index;
    }
    return best == Candidate::none ? first : best;
  }

  struct Part {
    Box box;
    uint32_t count;
  };
  HD static Part partOf(const Treelet<8>& t, uint32_t s) {
    Part part{{}, 0};
    for (uint32_t rest = s; rest; rest &= rest - 1) {
      const uint32_t i = lowestBit(rest);
      part.box.grow(t.box(i));
      part.count += t.count[i];
    }
    return part;
  }
  HD static bool isInner(uint32_t s) { return s & (s - 1); }
};

}  // namespace copse::treelets
