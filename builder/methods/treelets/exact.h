// The best topology of a treelet of at most seven leaves, by dynamic programming over its 127 subsets of leaves.
// Karras and Aila: Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (HPG 2013). (3^m + 1) / 2
// partitions a treelet of m. A subset's cost is a minimum over the same sums whatever their order, so the lanes may share
// the work as suits them; which partition it was is found again where the treelet is rebuilt, instead of kept for all.
#pragma once

#include <array>

#include "builder/methods/treelets/treelet.h"
#include "builder/parallel/bits.h"

namespace copse::treelets {

/// The partitions of a subset into two are subset - p and p, for p each non-empty subset of `most`.
struct Partitions {
  uint32_t subset, most;

  HD explicit Partitions(uint32_t s) : subset(s), most(s & (s - 1)) {}
  HD uint32_t first() const { return most & (0 - most); }
  HD uint32_t after(uint32_t p) const { return (p - most) & most; }  ///< 0 after the last.
};

/// Which subsets of two to six leaves each lane of a warp solves, in turn: sizes 2, 3, 3, 4, 4, 5, 6, a byte each; 0 for
/// none. A subset of six is solved by four lanes side by side.
struct LaneSchedule {
  static constexpr uint32_t turns = 7;
  uint64_t bytes;

  HD uint32_t subset(uint32_t turn) const { return static_cast<uint32_t>(bytes >> (8 * turn)) & 0xff; }
};
std::array<LaneSchedule, 32> laneSchedules();

struct ExactTreelets {
  static constexpr uint32_t capacity = 7, subsets = 128;

  struct Work {
    Treelet<capacity + 1> treelet;
    float node[subsets];   ///< Cost of the inner node above a subset alone.
    float leaf[subsets];   ///< Cost of the subset as one leaf.
    float least[subsets];  ///< Cost of the best subtree.
    uint32_t parts[capacity];
  };
  static constexpr uint32_t sharedBytes = sizeof(Work);

  uint32_t size;                   ///< Leaves of a treelet, 3 to 7.
  const LaneSchedule* schedules;  ///< 32, in the device's memory.

  template <class Lanes>
  HD void restructure(Lanes& lanes, const Tree& tree, uint32_t root) const {
    Work& work = *static_cast<Work*>(lanes.shared());
    const uint32_t leaves = work.treelet.grow(lanes, tree, root, size);
    if (leaves < 3) return;
    const float before = tree.subtrees[root].cost;
    weigh(lanes, work, leaves, tree.costs);
    solve(lanes, work, leaves);
    if (work.least[(1u << leaves) - 1] < before - leastGain * before) rebuild(lanes, work, leaves, tree);
  }

  /// Costs of every subset as a node and as a leaf, from its box and its triangles.
  template <class Lanes>
  HD static void weigh(Lanes& lanes, Work& work, uint32_t leaves, const Costs& costs) {
    const Treelet<capacity + 1>& t = work.treelet;
    for (uint32_t s = 1 + lanes.lane(); s < 1u << leaves; s += Lanes::size) {
      Box box;
      uint32_t count = 0;
      for (uint32_t rest = s; rest; rest &= rest - 1) {
        const uint32_t i = lowestBit(rest);
        box.grow(t.box(i));
        count += t.count[i];
      }
      const float area = box.area();
      work.node[s] = costs.ofNode(area, count);
      work.leaf[s] = costs.asLeaf(area, count);
    }
    for (uint32_t i = lanes.lane(); i < leaves; i += Lanes::size) work.least[1u << i] = t.cost[i];
    lanes.sync();
  }

  template <class Lanes>
  HD void solve(Lanes& lanes, Work& work, uint32_t leaves) const {
    const uint32_t all = (1u << leaves) - 1;
    if constexpr (Lanes::size == 1) {
      for (uint32_t s = 3; s <= all; ++s) {  // Every subset of s has a lower number.
        if ((s & (s - 1)) == 0) continue;
        const Partitions partitions(s);
        float best = INFINITY;
        for (uint32_t p = partitions.first(); p; p = partitions.after(p)) best = lower(best, sum(work, s, p));
        finish(work, s, best);
      }
    } else {
      const LaneSchedule schedule = schedules[lanes.lane()];
      for (uint32_t turn = 0; turn < LaneSchedule::turns; ++turn) {
        const uint32_t s = schedule.subset(turn);
        const bool mine = s && s <= all;
        const bool shared = turn + 1 == LaneSchedule::turns;
        const float best = mine ? partOf(work, s, shared ? lanes.lane() % 4 : 0, shared ? 2 : 0) : INFINITY;
        finishTogether(lanes, work, mine ? s : 0, best, shared ? 4 : 1);
      }
      if (leaves == capacity) finishTogether(lanes, work, all, partOf(work, all, lanes.lane(), 5), 32);
    }
  }

  HD static float lower(float a, float b) { return b < a ? b : a; }
  HD static float sum(const Work& work, uint32_t s, uint32_t p) { return work.least[s ^ p] + work.least[p]; }
  HD static void finish(Work& work, uint32_t s, float best) {
    work.least[s] = lower(work.leaf[s], work.node[s] + best);
  }

  /// The least sum over the partitions of `s` that hold of its highest `bits` leaves just those that `choice` says.
  HD static float partOf(const Work& work, uint32_t s, uint32_t choice, uint32_t bits) {
    uint32_t most = s & (s - 1), fixed = 0;
    for (uint32_t i = 0; i < bits; ++i) {
      const uint32_t highest = 0x80000000u >> leadingZeros(most);
      most ^= highest;
      if (choice >> i & 1) fixed |= highest;
    }
    float best = fixed ? sum(work, s, fixed) : INFINITY;
    for (uint32_t p = most & (0 - most); p; p = (p - most) & most) best = lower(best, sum(work, s, fixed | p));
    return best;
  }

  /// The least of `group` neighbouring lanes' values finishes subset `s`, if any.
  template <class Lanes>
  HD static void finishTogether(Lanes& lanes, Work& work, uint32_t s, float best, uint32_t group) {
    for (uint32_t step = 1; step < group; step *= 2) best = lower(best, lanes.shfl(best, lanes.lane() ^ step));
    if (s && lanes.lane() % group == 0) finish(work, s, best);
    lanes.sync();
  }

  /// Writes the topology of least cost, from the root down, over the treelet's own inner nodes.
  template <class Lanes>
  HD static void rebuild(Lanes& lanes, Work& work, uint32_t leaves, const Tree& tree) {
    const Treelet<capacity + 1>& t = work.treelet;
    if (lanes.lane() == 0) work.parts[0] = (1u << leaves) - 1;
    lanes.sync();
    for (uint32_t k = 0, used = 1; k < used; ++k) {
      const uint32_t s = work.parts[k];
      const Partitions partitions(s);
      const uint32_t found = lowest(lanes, 1u << leaves, [&](uint32_t p) {
                               return p && (p & ~partitions.most) == 0 ? sum(work, s, p) : INFINITY;
                             }).index;
      const uint32_t p = found == Candidate::none ? partitions.first() : found;
      const uint32_t leftSlot = used, rightSlot = used + (isInner(s ^ p) ? 1 : 0);
      used = rightSlot + (isInner(p) ? 1 : 0);
      if (lanes.lane() == 0) {
        if (isInner(s ^ p)) work.parts[leftSlot] = s ^ p;
        if (isInner(p)) work.parts[rightSlot] = p;
        Box box;
        uint32_t count = 0;
        for (uint32_t rest = s; rest; rest &= rest - 1) {
          box.grow(t.box(lowestBit(rest)));
          count += t.count[lowestBit(rest)];
        }
        writeInner(tree, t.inner[k], box, isInner(s ^ p) ? t.inner[leftSlot] : t.leaves[lowestBit(s)],
                   isInner(p) ? t.inner[rightSlot] : t.leaves[lowestBit(p)], {work.least[s], count});
      }
      lanes.sync();
    }
  }
  HD static bool isInner(uint32_t s) { return s & (s - 1); }
};

}  // namespace copse::treelets
