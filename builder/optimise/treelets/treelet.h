// A treelet: the top of a subtree, grown by opening the leaf of largest area until there are enough.
#pragma once

#include "builder/math/simd.h"
#include "builder/optimise/treelets/tree.h"

namespace copse::treelets {

/// A restructuring that gains less may be rounding alone.
constexpr float minGain = 1e-6f;

/// In memory that the lanes share. Leaves of the treelet are nodes of the tree, inner ones most of them.
/// `capacity` is a multiple of eight, so that one lane can take boxes by eights.
template <uint32_t capacity>
struct Treelet {
  static_assert(capacity % 8 == 0);
  uint32_t inner[capacity];  ///< Nodes that were opened, the treelet's root first: one less than there are leaves.
  uint32_t leaves[capacity];
  uint32_t left[capacity], right[capacity];  ///< Children of the leaves.
  float openable[capacity];                  ///< Minus the area of a leaf that can be opened, otherwise 1.
  float lo[3][capacity], hi[3][capacity];
  float cost[capacity];
  uint32_t count[capacity];

  HD Box box(uint32_t i) const {
    Box b;
    b.lo = {lo[0][i], lo[1][i], lo[2][i]};
    b.hi = {hi[0][i], hi[1][i], hi[2][i]};
    return b;
  }
  HD void setBox(uint32_t i, const Box& b) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis][i] = b.lo[axis];
      hi[axis][i] = b.hi[axis];
    }
  }

  HD void setLeaf(const Tree& tree, uint32_t i, uint32_t at) {
    const BvhNode node = tree.nodes[at];
    const Subtree subtree = tree.subtrees[at];
    const Box b = node.box();
    leaves[i] = at;
    left[i] = node.left;
    right[i] = node.right;
    const float area = b.area();
    openable[i] = node.isLeaf() ? 1 : area > 0 ? -area : 0;
    setBox(i, b);
    cost[i] = subtree.cost;
    count[i] = subtree.count;
  }

  /// Grows to at most `maxLeaves` leaves and says how many there are. Synchronises before and after.
  template <class Lanes>
  HD uint32_t grow(Lanes& lanes, const Tree& tree, uint32_t root, uint32_t maxLeaves) {
    lanes.sync();
    uint32_t size = 1, opened = 0, at = root, first = tree.nodes[root].left, second = tree.nodes[root].right;
    for (;;) {
      if (lanes.lane() == 0) inner[size - 1] = at;
      for (uint32_t child = lanes.lane(); child < 2; child += Lanes::size)
        setLeaf(tree, child ? size : opened, child ? second : first);
      ++size;
      lanes.sync();
      if (size == maxLeaves) return size;
      opened = lowest(lanes, size, [&](uint32_t i) { return openable[i]; }).index;
      if (openable[opened] > 0) return size;
      at = leaves[opened];
      first = left[opened];
      second = right[opened];
      lanes.sync();
    }
  }
};

inline namespace COPSE_ISA {

/// first, first + 1, … first + 7.
HD inline F32x8 eightFrom(uint32_t first) {
  return F32x8(F32x4(0, 1, 2, 3), F32x4(4, 5, 6, 7)) + F32x8(static_cast<float>(first));
}

/// Boxes by eights, as one lane of the CPU takes them.
struct EightBoxes {
  F32x8 lo[3], hi[3];

  HD static EightBoxes all(const Box& b) {
    return {{F32x8(b.lo.x), F32x8(b.lo.y), F32x8(b.lo.z)}, {F32x8(b.hi.x), F32x8(b.hi.y), F32x8(b.hi.z)}};
  }
  template <uint32_t capacity>
  HD static EightBoxes load(const Treelet<capacity>& t, uint32_t first) {
    return {{F32x8::load(t.lo[0] + first), F32x8::load(t.lo[1] + first), F32x8::load(t.lo[2] + first)},
            {F32x8::load(t.hi[0] + first), F32x8::load(t.hi[1] + first), F32x8::load(t.hi[2] + first)}};
  }
  HD void grow(const EightBoxes& b) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = minOf(b.lo[axis], lo[axis]);
      hi[axis] = maxOf(b.hi[axis], hi[axis]);
    }
  }
  /// The same bits as Box::area().
  HD F32x8 area() const {
    const F32x8 x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2], none(0);
    F32x8 area = F32x8(2) * (x * y + y * z + z * x);
    for (int axis = 0; axis < 3; ++axis) area = select(lo[axis] <= hi[axis], area, none);
    return area;
  }
};

}  // namespace COPSE_ISA

/// Writes an inner node of a restructured treelet.
HD inline void writeInner(const Tree& tree, uint32_t at, const Box& box, uint32_t left, uint32_t right,
                          const Subtree& subtree) {
  tree.nodes[at] = BvhNode::inner(box, left, right);
  tree.subtrees[at] = subtree;
  tree.parents.words[left] = at;
  tree.parents.words[right] = at;
}

}  // namespace copse::treelets
