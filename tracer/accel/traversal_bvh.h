// The tree as rays read it: 64-byte nodes that hold both children's boxes (Aila and Laine 2009), and triangles in the
// order of the leaves. A tree of wide nodes has those as well.
#pragma once

#include "builder/bvh.h"
#include "tracer/accel/wide_nodes.h"

namespace copse {

/// Boxes of the two children by axis, and links. A link with `leafBit` is a leaf, and the rest of it the leaf's first
/// triangle; any other is a node. An absent child has an empty box, which no ray hits.
struct alignas(64) TraversalNode {
  static constexpr uint32_t leafBit = 0x80000000u;
  static constexpr uint32_t pairBit = 0x40000000u;

  float x[4];  ///< lo of child 0, lo of child 1, hi of child 0, hi of child 1
  float y[4];
  float z[4];
  uint32_t child[2];
  /// Where a walk that takes four boxes at a time goes on, on a CPU: `pairBit` and the first of the child's two
  /// children where both are nodes that stand side by side; otherwise, and on a GPU, the same as `child`.
  uint32_t below[2];
};
static_assert(sizeof(TraversalNode) == 64);

/// A triangle by axis: the three vertices' x, then y, then z, as they came, so that an edge shared by two triangles is
/// computed alike in both.
struct alignas(16) TraversalTriangle {
  float x[3];
  uint32_t id;  ///< The scene's triangle.
  float y[3];
  uint32_t last;  ///< 1 for the last triangle of its leaf, otherwise 0.
  float z[3];
  uint32_t unused;
};
static_assert(sizeof(TraversalTriangle) == 48);

/// What kernels take by value. No triangles: no nodes.
struct TraversalView {
  const TraversalNode* nodes;
  const TraversalTriangle* triangles;
  const uint32_t* parents;  ///< Of each node, for walking without a stack.
  uint32_t nodeCount;
  uint32_t triangleCount;
  const WideNode* wideNodes;  ///< Null for a tree that is just binary.
};

struct TraversalBvh {
  Buffer<TraversalNode> nodes;
  Buffer<TraversalTriangle> triangles;
  Buffer<uint32_t> parents;
  Buffer<WideNode> wideNodes;  ///< Take the place of the nodes that joints join; rays begin with the first.
                               ///< On CUDA empty, where all rays go through `nodes`; counted ones where it is filled.
  uint32_t nodeCount = 0;
  uint32_t triangleCount = 0;

  TraversalView view() const {
    return {nodes.data(), triangles.data(), parents.data(), nodeCount, triangleCount, wideNodes.data()};
  }
  std::size_t bytes() const { return nodes.bytes() + triangles.bytes() + parents.bytes() + wideNodes.bytes(); }
};

/// Phase "traversal layout". Nodes keep the order of `bvh`'s inner nodes; where siblings stand side by side there, as
/// collapseAndLayout() leaves them, four boxes can be tested at a time. A tree of one leaf gets a root whose other
/// child is absent. Throws InputError for 2^30 nodes or more.
TraversalBvh traversalBvh(const Device& device, const Bvh& bvh, const TrianglesView& triangles);

}  // namespace copse
