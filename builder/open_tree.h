// A tree between the stages of its build: what a method makes, optimisers change, and the choice of leaves takes apart.
#pragma once

#include "builder/bvh.h"

namespace copse {

/// A binary tree whose root is node 0; the other nodes may stand in any order, and inner nodes keep the order among
/// themselves that they have here. A method leaves one reference per leaf (2n-1 nodes) unless it says otherwise.
///
/// Between stages: the box of each leaf is around its references. Boxes of inner nodes are nobody's: a method may leave
/// them empty, and a stage that needs them calls fit() first. `parents` are those of all nodes, or empty, which a
/// method may leave and linkParents() mends; optimisers find them linked and leave them so. `joints` are as in a Bvh.
struct OpenTree {
  Buffer<BvhNode> nodes;
  Buffer<uint32_t> order;    ///< Per place in the leaves: the reference there.
  Buffer<uint32_t> parents;  ///< One word more than there are nodes, unless inner nodes stand before all leaves.
  Buffer<uint8_t> joints;
  uint32_t arity = 2;
  uint32_t nodeCount = 0;
  uint32_t referenceCount = 0;
  uint32_t triangleCount = 0;
  uint32_t firstLeaf = 0;  ///< No leaf stands before it.

  /// Whether all inner nodes stand before all leaves: as many nodes stand before the first leaf as there are inner
  /// ones.
  bool isInnerFirst() const { return firstLeaf > 0 && firstLeaf == nodeCount / 2; }
  /// No inner node stands from there on.
  uint32_t innerEnd() const { return isInnerFirst() ? firstLeaf : nodeCount; }
};

/// Gives `tree` its parents where it has none. One launch then, otherwise nothing.
void linkParents(const Device& device, OpenTree& tree);
void linkParents(const Device& device, Bvh& bvh);
/// The parents of all nodes, as ParentLinks has them. One launch.
Buffer<uint32_t> parentsOf(const Device& device, const Bvh& bvh);

/// Boxes from the leaves up. With `boxes`, of each triangle (or reference, if the tree is open), the leaves' boxes are
/// made anew from these, so that after triangles have moved fitting again is refitting; the topology stays. Where
/// triangles were split a leaf's box is then around the whole triangles. Without, leaves keep the boxes that they have.
/// Parents are linked first where there are none, and kept. Phase "fit". O(n); it does not wait for the device.
void fit(const Device& device, OpenTree& tree, const Box* boxes = nullptr);
void fit(const Device& device, Bvh& bvh, const Box* boxes);

}  // namespace copse
