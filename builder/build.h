// Triangles in, tree out: boxes, the builder, leaves, layout. What `copse build` and `copse render` call.
#pragma once

#include <vector>

#include "builder/registry.h"

namespace copse {

struct TreeStatistics {
  /// Σ inner cT A/A_root + Σ leaves cI n A/A_root. A wide node counts cT once, for the visit, however many children it
  /// has, and its joints nothing: costs of other arities say how much is visited, not how long a visit takes.
  double sahCost = 0;
  uint32_t nodes = 0, leaves = 0;  ///< Without joints.
  uint32_t depth = 0;              ///< Edges from the root to the deepest leaf, likewise.
  uint32_t maxLeafTriangles = 0;
  uint32_t arity = 2;  ///< Most children that a node may have.
};

/// The tree that is traversed, built by `builder` with `parameters` (presets of the builder's name are already
/// applied by the caller through withPreset). Phases in the device's timeline: "boxes", then the method's own (lbvh:
/// "morton", "sort", "hierarchy"; sah: "sort", "sweep"), "collapse" and "layout".
Bvh buildBvh(const Device& device, const TrianglesView& triangles, const BuilderEntry& builder,
             const Parameters& parameters);

/// `chosen` over the builder's preset over the defaults, and what the method derives from them.
Parameters withPreset(const BuilderEntry& builder, const Parameters& chosen);

/// Boxes of the triangles, and behind the last the box around all of them; empty where there is no triangle. It does
/// not wait for the device.
Buffer<Box> triangleBoxes(const Device& device, const TrianglesView& triangles);
/// What a builder gets, in the memory of `boxes` as triangleBoxes() makes them.
BuildInput inputOf(const Buffer<Box>& boxes);

/// Boxes of inner nodes, leaves by leaf.rule and leaf.max, each leaf's triangles ascending. The root is node 0; the two
/// children of the inner node that is the r-th to stay, counted from 0 in the order of `tree`, are 1 + 2r and 2 + 2r. A
/// leaf that is larger than leaf.max already stays. A joint costs nothing and becomes no leaf; a wide node that becomes
/// one takes its joints with it.
Bvh collapseAndLayout(const Device& device, Bvh tree, const Parameters& parameters);

/// What leaves and costs depend on: sah.traversal, sah.intersection, leaf.max and leaf.rule.
std::vector<ParameterSpec> collapseParameters();

/// Computed on the host from a copy; O(n).
TreeStatistics statistics(const Device& device, const Bvh& bvh, const Parameters& parameters);

/// Checks that each primitive is in one leaf, boxes contain what is below them, counts and depth are sound, no leaf
/// holds more than `maxLeaf`, and no node has more children than the tree's arity. Throws ValidationError saying which
/// node and what.
void validate(const Device& device, const Bvh& bvh, const TrianglesView& triangles, uint32_t maxLeaf);

}  // namespace copse
