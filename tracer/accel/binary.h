// The binary tree as rays read it: 64-byte nodes that hold both children's boxes (Aila and Laine 2009).
#pragma once

#include "builder/parameters.h"
#include "tracer/accel/tree.h"

namespace copse {

/// Boxes of the two children by axis, and links. An absent child has an empty box, which no ray hits.
struct alignas(64) BinaryNode {
  static constexpr uint32_t pairBit = 0x40000000u;

  float x[4];  ///< lo of child 0, lo of child 1, hi of child 0, hi of child 1
  float y[4];
  float z[4];
  uint32_t child[2];
  /// Where a CPU walk that tests four boxes at a time goes on: `pairBit` and the first of the child's two children if
  /// both are adjacent inner nodes; otherwise, and on a GPU, the same as `child`.
  uint32_t below[2];
};
static_assert(sizeof(BinaryNode) == 64);

/// The format. Its steps are in binary_steps.h.
struct Binary {
  using Node = BinaryNode;
  using View = TreeView<BinaryNode>;
  using Tree = TreeBuffers<BinaryNode>;
  static constexpr uint32_t width = 2;

  /// There is nothing to choose.
  struct Settings {
    explicit Settings(const Parameters& = {}) {}
  };

  /// Phase "traversal layout". Nodes keep the order of `bvh`'s inner nodes; where siblings are adjacent there, as
  /// collapseAndLayout() leaves them, four boxes can be tested at a time. A tree of one leaf gets a root whose other
  /// child is absent. Throws InputError for 2^30 nodes or more.
  static Tree build(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                    const Settings& settings = Settings());
};

}  // namespace copse
