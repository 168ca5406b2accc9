// Which subtrees become leaves, and so what a subtree costs: for the choice of leaves, and for optimisers that mean to
// lower the cost of the tree that the choice will leave.
#pragma once

#include <cmath>

#include "builder/metrics/sah_costs.h"
#include "builder/parallel/platform.h"

namespace copse {

/// Costs are by the surface area heuristic, times the root's area. A subtree is told by the area of its box, how many
/// references it has, and what the nodes below it cost together.
struct LeafRule {
  float traversal, intersection;
  uint32_t leafMax;
  bool byCount;  ///< leaf.rule = count: what can be a leaf is one, whatever it costs.

  /// The cost of all its references in one leaf, however many they are.
  HD float ofLeaf(float area, uint32_t count) const { return intersection * area * static_cast<float>(count); }
  /// Whether it becomes a leaf where that costs `leaf`, and the tree `tree`.
  HD bool choosesLeaf(uint32_t count, float leaf, float tree) const {
    return count <= leafMax && (byCount || leaf < tree);
  }

  /// The cost as one leaf; infinite where that is too large.
  HD float asLeaf(float area, uint32_t count) const { return count <= leafMax ? ofLeaf(area, count) : INFINITY; }
  /// The cost of its inner node alone; infinite where it must be a leaf.
  HD float ofNode(float area, uint32_t count) const {
    return byCount && count <= leafMax ? INFINITY : traversal * area;
  }
  /// The lower one of both ways to store it.
  HD float ofSubtree(float area, uint32_t count, float below) const {
    const float leaf = asLeaf(area, count), tree = ofNode(area, count) + below;
    return tree < leaf ? tree : leaf;
  }
};

/// As sah.traversal, sah.intersection, leaf.max and leaf.rule say.
LeafRule leafRuleOf(const Parameters& parameters);
/// Those four.
std::vector<ParameterSpec> leafParameters();

}  // namespace copse
