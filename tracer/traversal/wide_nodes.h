// Nodes of up to eight children for rays: their boxes by plane, so that a host tests all of them at once (Wald, Benthin
// and Boulos 2008; Dammertz, Hanika and Keller 2008). 224 bytes a node, of whatever arity, so those of two children
// stay TraversalNodes, of 64.
#pragma once

#include "builder/bvh.h"

namespace copse {

/// Children stand in order of their surface area, the largest last. A slot without a child has an empty box.
struct alignas(32) WideNode {
  static constexpr uint32_t width = maxArity;
  static constexpr uint32_t bit = 0x20000000u;  ///< In a link: a wide node.

  float planes[6][width];  ///< Lower x, y, z, then upper x, y, z.
  uint32_t child[width];   ///< With `bit` a wide node, otherwise as in TraversalNode.
};
static_assert(sizeof(WideNode) == 224);

/// The wide nodes of a tree with joints, those above a joint and the root, which comes first; breadth-first where `bvh`
/// is. Empty for any other tree, and for one of a single leaf. `number` has the TraversalNode of each inner node; what
/// is below a node of two children is reached through it. O(n). Throws InputError where `bvh` has an arity above
/// WideNode::width, or 2^29 inner nodes.
Buffer<WideNode> wideNodes(const Device& device, const Bvh& bvh, const uint32_t* number);

}  // namespace copse
