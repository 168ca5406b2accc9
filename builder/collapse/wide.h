// A binary tree as one of nodes with up to eight children, at the minimum expected cost of a ray: which nodes become
// wide nodes, and which subtrees leaves, by dynamic programming (Ylitie, Karras and Laine: Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs, HPG 2017). Leaves hold blocks of triangles that are tested together.
#pragma once

#include <vector>

#include "builder/bvh.h"
#include "builder/parallel/timeline.h"
#include "builder/parameters.h"

namespace copse {

constexpr uint32_t wideWidth = 8;
/// Triangles of a block.
constexpr uint32_t wideBlock = 4;

/// The cost of a ray that meets a box, per surface area: wide.node for a node, wide.leaf for a leaf and wide.block for
/// each of its blocks.
struct WideRule {
  float node, leaf, block;
  uint32_t leafMax;  ///< No subtree of more triangles becomes a leaf; a leaf of the binary tree stays one.
  bool ownChildren;  ///< No more children than the binary tree's joints give a node, and its leaves.

  WideRule() : WideRule(Parameters()) {}
  explicit WideRule(const Parameters& parameters);
};

/// wide.node, wide.leaf, wide.block, wide.leaf_max and wide.children.
std::vector<ParameterSpec> wideParameters();

/// Up to eight nodes of the binary tree, those of smaller surface area first.
struct WideChildren {
  static constexpr uint32_t absent = 0xffffffffu;
  /// The child is a leaf of the wide tree: all that is below it.
  static constexpr uint32_t leafBit = 0x80000000u;

  uint32_t child[wideWidth];
};

/// Wide nodes of the same depth.
struct WideLevel {
  Buffer<WideChildren> children;  ///< Per node.
  Buffer<uint64_t> offset;        ///< Per node: of the level's before it, the inner children, and << 32 the blocks.
  uint32_t inner = 0, blocks = 0;
};

/// The levels from the root down. A tree of one leaf has a root with one child. The same on both devices; O(n), with
/// one wait for the device per level. Phase "widen". Throws InputError where `bvh` has an arity above 8.
std::vector<WideLevel> widen(const Device& device, const Bvh& bvh, const WideRule& rule);

/// The number of blocks that hold `count` triangles.
HD constexpr uint32_t blocksOf(uint32_t count) { return (count + wideBlock - 1) / wideBlock; }

}  // namespace copse
