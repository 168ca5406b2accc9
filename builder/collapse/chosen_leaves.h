// What the choice of leaves tells layout, and how: in the open tree itself where that saves reading a second place per
// node. Only the two stages know of it.
#pragma once

#include "builder/collapse/leaf_rule.h"
#include "builder/open_tree.h"

namespace copse {

/// What was chosen for an inner node of the open tree. Of a leaf it follows from the node itself, which spares writing
/// and reading as much as the nodes of the leaves have.
struct alignas(16) ChosenSubtree {
  static constexpr uint32_t scattered = 0xffffffffu;

  float cost;  ///< SAH cost of the best way to store it, times the root's area.
  uint32_t references;
  uint32_t leaves;  ///< Leaves that it keeps: 1 where it becomes one.
  uint32_t place;   ///< Where its references stand in the order; or `scattered` where they are not side by side.

  HD bool isLeaf() const { return leaves == 1; }
};

/// Marks in the words of the open tree's nodes, which leave the bits free: links to children that become leaves are
/// marked, and a node that becomes one is written as a leaf already, unless its references are scattered.
struct LeafMarks {
  static constexpr uint32_t leftIsLeaf = 0x80000000u, rightIsLeaf = 0x40000000u;
  static constexpr uint32_t became = 0x40000000u;  ///< In a leaf's `right`: the node was none before.

  HD static uint32_t left(const BvhNode& node) { return node.left & ~leftIsLeaf; }
  HD static uint32_t right(const BvhNode& node) { return node.right & ~rightIsLeaf; }
  HD static uint32_t count(const BvhNode& leaf) { return leaf.count() & ~became; }
  HD static bool isLeafFromTheStart(uint32_t right) {
    return (right & (BvhNode::leafBit | became)) == BvhNode::leafBit;
  }
};

/// Puts `reference` into the `count` ascending ones at `to`.
HD inline void insertSorted(uint32_t* to, uint32_t count, uint32_t reference) {
  uint32_t at = count;
  for (; at > 0 && to[at - 1] > reference; --at) to[at] = to[at - 1];
  to[at] = reference;
}

/// The tree's nodes are marked, its boxes fitted, its leaves' references ascend, and of `parents` the first innerEnd()
/// words are no parents any more: 1 for an inner node that stays one, otherwise 0.
struct ChosenLeaves {
  struct Summary {
    uint32_t anyScattered;  ///< Not 0: a leaf's references are not side by side in the order.
    uint32_t leaves;        ///< In the whole tree.
  };

  Buffer<ChosenSubtree> subtrees;  ///< Per node before innerEnd(); written for those that came in as inner ones.
  Buffer<Summary> summary;         ///< One. What the host must know before layout.
};

/// A subtree of at most leaf.max references becomes a leaf where `rule` finds that cheaper. A leaf that is larger
/// already stays. A joint costs nothing and becomes no leaf; a wide node that becomes one takes its joints with it.
/// Phase "collapse". O(n); it does not wait for the device.
ChosenLeaves chooseLeaves(const Device& device, OpenTree& tree, const LeafRule& rule);

/// The tree that is traversed: the root is node 0, and the two children of the inner node that is the r-th to stay,
/// counted from 0 in the order of `tree`, are 1 + 2r and 2 + 2r. Phase "layout". O(n); the host waits once, while a
/// scan runs.
Bvh layOut(const Device& device, OpenTree tree, const ChosenLeaves& chosen);

}  // namespace copse
