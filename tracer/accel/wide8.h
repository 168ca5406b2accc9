// Nodes of up to eight children for rays: their boxes by plane, so that a host tests all of them at once (Wald, Benthin
// and Boulos 2008; Dammertz, Hanika and Keller 2008). 224 bytes per node, however many children it has.
#pragma once

#include "tracer/accel/tree.h"

namespace copse {

/// Children stand in order of their surface area, the largest last. A slot without a child has an empty box.
struct alignas(32) Wide8Node {
  static constexpr uint32_t width = maxArity;

  float planes[6][width];  ///< Lower x, y, z, then upper x, y, z.
  uint32_t child[width];
};
static_assert(sizeof(Wide8Node) == 224);

/// The format. Its step is in wide8_steps.h.
struct Wide8 {
  using Node = Wide8Node;
  using View = TreeView<Wide8Node>;
  using Tree = TreeBuffers<Wide8Node>;
  static constexpr uint32_t width = Wide8Node::width;

  /// Phase "traversal layout". Any builder's tree, breadth-first: a node's two children, or where its tree has joints
  /// its children without them; then, as long as there is one and room, the child of the largest surface area that is a
  /// node whose own children all fit in gives way to these. A tree of one leaf gets a root with one child. O(n), with
  /// one wait for the device per level. Throws InputError where `bvh` has an arity above 8.
  static Tree build(const Device& device, const Bvh& bvh, const TrianglesView& triangles);
};

}  // namespace copse
