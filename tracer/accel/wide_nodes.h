// Nodes of up to eight children for rays: their boxes by plane, so that a host tests all of them at once (Wald, Benthin
// and Boulos 2008; Dammertz, Hanika and Keller 2008). 224 bytes a node, of whatever arity.
#pragma once

#include "builder/bvh.h"

namespace copse {

/// Children stand in order of their surface area, the largest last. A slot without a child has an empty box.
struct alignas(32) WideNode {
  static constexpr uint32_t width = maxArity;

  float planes[6][width];  ///< Lower x, y, z, then upper x, y, z.
  uint32_t child[width];   ///< A wide node, or a leaf as in TraversalNode.
};
static_assert(sizeof(WideNode) == 224);

/// The wide nodes of a tree with joints, breadth-first; empty for any other tree, and for one of a single leaf. Joints
/// disappear. Slots that are still free are filled: the largest child that is a node of two children gives way to
/// these, as long as there is one and room. So what a method leaves binary is read in wide nodes as well. O(n), with a
/// wait for the device a level. Throws InputError where `bvh` has an arity above WideNode::width.
Buffer<WideNode> wideNodes(const Device& device, const Bvh& bvh);

}  // namespace copse
