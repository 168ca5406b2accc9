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
  uint32_t maxLeafTriangles = 0;   ///< References: a triangle that was split is one in each of its leaves.
  uint32_t references = 0;         ///< In all leaves; more than triangles where some were split.
  uint32_t arity = 2;              ///< The maximum number of children per node.
};

/// What a build may be asked for beside its method.
struct BuildOptions {
  OptimiserNames optimisers = {};  ///< Run after those that the builder's name stands for, in this order.
  bool keepParents = false;        ///< Bvh::parents are linked, so that fit() need not do it before it refits.
};

/// The tree that is traversed, built by `builder` with `parameters` (presets of the builder's name are already applied
/// by the caller through withPreset). Stages: primitivesOf(), buildOpenTree(), collapseAndLayout(). Phases in the
/// device's timeline: "boxes", then the method's own (lbvh: "morton", "sort", "hierarchy"; sah: "sort", "sweep") and
/// the optimisers', "collapse" and "layout".
Bvh buildBvh(const Device& device, const TrianglesView& triangles, const BuilderEntry& builder,
             const Parameters& parameters, const BuildOptions& options = {});

/// The method's tree, and the optimisers run over it: first the builder's own, then `optimisers`. No primitives: no
/// nodes. Throws InputError where the tree has too many references, or an optimiser cannot take it.
OpenTree buildOpenTree(const Device& device, const Primitives& primitives, const BuilderEntry& builder,
                       const Parameters& parameters, const OptimiserNames& optimisers = {});

/// `chosen` over the builder's preset over the defaults, and what the method derives from them.
Parameters withPreset(const BuilderEntry& builder, const Parameters& chosen);

/// chooseLeaves() and layOut(): boxes of inner nodes, leaves by leaf.rule and leaf.max, each leaf's references
/// ascending; children side by side, in the order of `tree`. The arity stays: wide nodes are marks over a binary tree,
/// so a further collapse to a width is a function over the Bvh that sets joints, and moves nothing.
Bvh collapseAndLayout(const Device& device, OpenTree tree, const Parameters& parameters);

/// Computed on the host from a copy; O(n).
TreeStatistics statistics(const Device& device, const Bvh& bvh, const Parameters& parameters);

/// Checks that each triangle is in one leaf, boxes contain what is below them, counts and depth are sound, no leaf
/// holds more than `maxLeaf`, and no node has more children than the tree's arity. Where a tree has more references
/// than triangles, each triangle is in one leaf or more, whose boxes together must hold all of it, up to a hundred
/// thousandth of its area for rounding. Throws ValidationError saying which node and what.
void validate(const Device& device, const Bvh& bvh, const TrianglesView& triangles, uint32_t maxLeaf);

}  // namespace copse
