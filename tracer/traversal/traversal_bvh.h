// The tree as rays read it: 64-byte nodes that hold both children's boxes (Aila and Laine 2009), and triangles in the
// order of the leaves. Nodes stand in depth-first order, so that a path down the tree stays close in memory.
#pragma once

#include "builder/bvh.h"

namespace copse {

/// Boxes of the two children by axis, and links. A link with `leafBit` is a leaf, and the rest of it the leaf's first
/// triangle; any other is a node. An absent child has an empty box, which no ray hits.
struct alignas(64) TraversalNode {
  static constexpr uint32_t leafBit = 0x80000000u;

  float x[4];  ///< lo of child 0, lo of child 1, hi of child 0, hi of child 1
  float y[4];
  float z[4];
  uint32_t child[2];
  uint32_t parent;  ///< For walking without a stack; the root is its own.
  uint32_t unused;
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
  uint32_t nodeCount;
  uint32_t triangleCount;
};

struct TraversalBvh {
  Buffer<TraversalNode> nodes;
  Buffer<TraversalTriangle> triangles;
  uint32_t nodeCount = 0;
  uint32_t triangleCount = 0;

  TraversalView view() const { return {nodes.data(), triangles.data(), nodeCount, triangleCount}; }
  std::size_t bytes() const { return nodes.bytes() + triangles.bytes(); }
};

/// Phase "traversal layout". A tree of one leaf gets a root whose other child is absent.
TraversalBvh traversalBvh(const Device& device, const Bvh& bvh, const TrianglesView& triangles);

}  // namespace copse
