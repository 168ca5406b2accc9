// What the treelet methods know of a tree: nodes, parents, and of every node what its subtree costs and holds.
#pragma once

#include <cmath>
#include <cstdint>

#include "builder/bottom_up.h"
#include "builder/bvh.h"
#include "builder/collapse/leaf_rule.h"

namespace copse::treelets {

struct alignas(8) Subtree {
  float cost;
  uint32_t count;  ///< References.
};

/// A binary tree with its nodes in any order, the root first.
struct Tree {
  BvhNode* nodes;
  ParentLinks parents;
  Subtree* subtrees;
  uint32_t nodeCount;
  uint32_t firstLeaf;   ///< No leaf stands before it.
  bool isInnerFirst;    ///< All leaves stand from there on.
  bool hasLargeLeaves;  ///< Some leaf has more than one reference.
  LeafRule costs;       ///< For the tree that the choice of leaves will make.

  /// The cost of `at` from those of its children; its box and count are known.
  HD float costFromChildren(uint32_t at) const {
    const BvhNode& node = nodes[at];
    return costs.ofSubtree(node.box().area(), subtrees[at].count, subtrees[node.left].cost + subtrees[node.right].cost);
  }
};

/// An index and what it is judged by. Ties go to the lower index, so that the number of lanes does not matter.
struct Candidate {
  static constexpr uint32_t none = 0xffffffffu;

  float value;
  uint32_t index;
};

struct Lower {
  HD Candidate operator()(const Candidate& a, const Candidate& b) const {
    return b.value < a.value || (b.value == a.value && b.index < a.index) ? b : a;
  }
};

/// The index i < n of the lowest value(i), `none` where no value is below infinity; the same in all lanes.
template <class Lanes, class Value>
HD Candidate lowest(Lanes& lanes, uint32_t n, Value value) {
  Candidate best{INFINITY, Candidate::none};
  for (uint32_t i = lanes.lane(); i < n; i += Lanes::size)
    if (const float v = value(i); v < best.value) best = {v, i};
  return lanes.reduce(best, Lower{});
}

}  // namespace copse::treelets
