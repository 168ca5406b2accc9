// What the treelet methods know of a tree: nodes, parents, and of every node what its subtree costs and holds.
#pragma once

#include <cmath>
#include <cstdint>

#include "builder/bottom_up.h"
#include "builder/bvh.h"

namespace copse::treelets {

/// The surface area heuristic with the leaves that collapseAndLayout() will choose, times the root's area.
struct Costs {
  float traversal, intersection;
  uint32_t leafMax;
  bool byCount;  ///< leaf.rule = count: what can be a leaf is one, whatever it costs.

  /// Of a subtree of `count` triangles as one leaf; infinite where that is too large.
  HD float asLeaf(float area, uint32_t count) const {
    return count <= leafMax ? intersection * area * static_cast<float>(count) : INFINITY;
  }
  /// Of its inner node alone; infinite where it must be a leaf.
  HD float ofNode(float area, uint32_t count) const {
    return byCount && count <= leafMax ? INFINITY : traversal * area;
  }
  /// Of a subtree whose children cost `below` together.
  HD float ofSubtree(float area, uint32_t count, float below) const {
    const float leaf = asLeaf(area, count), tree = ofNode(area, count) + below;
    return tree < leaf ? tree : leaf;
  }
};

struct alignas(8) Subtree {
  float cost;
  uint32_t count;  ///< Triangles.
};

/// As lbvh leaves it: inner nodes 0 … leaves-2, the root first, then one node a leaf.
struct Tree {
  BvhNode* nodes;
  ParentLinks parents;
  Subtree* subtrees;
  uint32_t leaves;
  Costs costs;

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
