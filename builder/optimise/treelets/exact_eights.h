// Subsets of a treelet's leaves by eights, as one lane of the CPU solves them: a block is a subset of the leaves from
// the fourth on, a lane one of the eight subsets of the first three. A block's partitions are sums of two lower blocks,
// eight per pair, and seven sums for those in which one part has all of the block's leaves.
#pragma once

#include "builder/optimise/treelets/treelet.h"
#include "builder/parallel/bits.h"

namespace copse::treelets {

/// Costs of every subset of a treelet's leaves, bit i being leaf i.
struct SubsetCosts {
  static constexpr uint32_t maxLeaves = 7, subsets = 1u << maxLeaves;

  float node[subsets];  ///< As the inner node above it alone.
  float leaf[subsets];  ///< As one leaf.
  float min[subsets];   ///< As the best subtree over it.

  HD float sum(uint32_t s, uint32_t part) const { return min[s ^ part] + min[part]; }
};

inline namespace COPSE_ISA {

HD inline void weighByEights(SubsetCosts& out, const Treelet<8>& t, uint32_t leaves, const LeafRule& costs) {
  // A lane without a leaf has what changes nothing.
  const float bits[3][8] = {{0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const EightBoxes empty = EightBoxes::all(Box{});
  const F32x8 one(1), infinite(INFINITY);
  EightBoxes low = empty;
  F32x8 lowCount(0);
  for (uint32_t i = 0; i < 3; ++i) {
    const F32x8 bit = F32x8::load(bits[i]);
    EightBoxes leaf = EightBoxes::all(t.box(i));
    for (int axis = 0; axis < 3; ++axis) {
      leaf.lo[axis] = select(one <= bit, leaf.lo[axis], empty.lo[axis]);
      leaf.hi[axis] = select(one <= bit, leaf.hi[axis], empty.hi[axis]);
    }
    low.grow(leaf);
    lowCount = lowCount + bit * F32x8(static_cast<float>(t.count[i]));
  }

  const F32x8 traversal(costs.traversal), intersection(costs.intersection);
  const F32x8 leafMax(static_cast<float>(costs.leafMax));
  const F32x8 leafMaxByCount(costs.byCount ? static_cast<float>(costs.leafMax) : -1);
  Box high[16];
  float highCount[16];
  highCount[0] = 0;
  for (uint32_t block = 0; block < 1u << (leaves - 3); ++block) {
    EightBoxes boxes = low;
    if (block) {
      const uint32_t i = lowestBit(block), rest = block & (block - 1);
      high[block] = unite(high[rest], t.box(3 + i));
      highCount[block] = highCount[rest] + static_cast<float>(t.count[3 + i]);
      boxes.grow(EightBoxes::all(high[block]));
    }
    // As floats, counts are right as far as leaves can go, and larger ones stay larger.
    const F32x8 area = boxes.area(), count = lowCount + F32x8(highCount[block]);
    select(count <= leafMax, intersection * area * count, infinite).store(out.leaf + 8 * block);
    select(count <= leafMaxByCount, infinite, traversal * area).store(out.node + 8 * block);
  }
  out.leaf[0] = out.node[0] = INFINITY;
  for (uint32_t i = 0; i < leaves; ++i) {
    out.leaf[1u << i] = t.cost[i];
    out.node[1u << i] = INFINITY;
  }
}

/// Lane l is lane l & k of `a`.
template <int k>
HD inline F32x8 lanesAnd(const F32x8& a) {
  const F32x8 fours = k & 4 ? a : a.halves<0, 0>();
  return fours.shuffle<0, 1 & k, 2 & k, 3 & k>();
}

/// A block's lanes l & k, for each k.
struct MaskedBlock {
  F32x8 lanes[8];

  HD explicit MaskedBlock(const F32x8& a)
      : lanes{lanesAnd<0>(a), lanesAnd<1>(a), lanesAnd<2>(a), lanesAnd<3>(a),
              lanesAnd<4>(a), lanesAnd<5>(a), lanesAnd<6>(a), a} {}
  MaskedBlock() = default;
};

HD inline void solveByEights(SubsetCosts& costs, uint32_t leaves) {
  MaskedBlock done[16];
  for (uint32_t block = 0; block < 1u << (leaves - 3); ++block) {
    const F32x8 node = F32x8::load(costs.node + 8 * block), leaf = F32x8::load(costs.leaf + 8 * block);
    const auto finish = [&](const F32x8& best) { return minOf(node + best, leaf); };
    F32x8 best(INFINITY);
    const uint32_t rest = block & (block - 1);
    for (uint32_t p = rest & (0 - rest); p; p = (p - rest) & rest) {
      const MaskedBlock& a = done[block ^ p];
      const MaskedBlock& b = done[p];
      for (uint32_t k = 0; k < 8; ++k) best = minOf(a.lanes[k] + b.lanes[7 ^ k], best);
    }
    // What is left has all of the block in one part, and there no, one or two of the first three leaves.
    F32x8 found = finish(best);
    if (block == 0) {
      const auto split = [&] {
        const MaskedBlock a(found);
        for (const uint32_t k : {1, 2, 4}) best = minOf(a.lanes[k] + a.lanes[7 ^ k], best);
        found = finish(best);
      };
      split();
      split();
    } else {
      const MaskedBlock& low = done[0];
      best = minOf(lanesAnd<0>(found) + low.lanes[7], best);
      found = finish(best);
      best = minOf(lanesAnd<1>(found) + low.lanes[6], best);
      best = minOf(lanesAnd<2>(found) + low.lanes[5], best);
      best = minOf(lanesAnd<4>(found) + low.lanes[3], best);
      found = finish(best);
      best = minOf(lanesAnd<3>(found) + low.lanes[4], best);
      best = minOf(lanesAnd<5>(found) + low.lanes[2], best);
      best = minOf(lanesAnd<6>(found) + low.lanes[1], best);
      found = finish(best);
    }
    done[block] = MaskedBlock(found);
    found.store(costs.min + 8 * block);
  }
}

}  // namespace COPSE_ISA

}  // namespace copse::treelets
