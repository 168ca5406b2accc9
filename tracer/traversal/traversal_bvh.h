// The tree as rays read it: 64-byte nodes that hold both children's boxes (Aila and Laine 2009), and triangles in the
// order of the leaves.
#pragma once

#include "builder/bvh.h"

namespace copse {

/// Child boxes and links. A child >= 0 is a node; a child < 0 is a leaf, ~child its first triangle.
struct alignas(64) TraversalNode {
  vec4 c0xy;  ///< child 0: lo.x, hi.x, lo.y, hi.y
  vec4 c1xy;  ///< child 1, the same
  vec4 z;     ///< child 0: lo.z, hi.z; child 1: lo.z, hi.z
  int32_t child0, child1;
  uint32_t count0, count1;  ///< Triangles of a child that is a leaf.
};
static_assert(sizeof(TraversalNode) == 64);

/// Vertices as they came, so that edges shared by two triangles are computed alike.
struct alignas(16) TraversalTriangle {
  vec3 v0;
  uint32_t id;  ///< The scene's triangle.
  vec3 v1;
  float pad1;
  vec3 v2;
  float pad2;
};
static_assert(sizeof(TraversalTriangle) == 48);

struct TraversalView {
  const TraversalNode* nodes;
  const TraversalTriangle* triangles;
  uint32_t nodeCount;
  uint32_t triangleCount;
  uint32_t depth;
};

struct TraversalBvh {
  Buffer<TraversalNode> nodes;
  Buffer<TraversalTriangle> triangles;
  uint32_t nodeCount = 0;
  uint32_t triangleCount = 0;
  uint32_t depth = 0;

  TraversalView view() const { return {nodes.data(), triangles.data(), nodeCount, triangleCount, depth}; }
  std::size_t bytes() const { return nodes.bytes() + triangles.bytes(); }
};

/// Phase "traversal layout". A tree of one leaf gets a root whose other child is empty.
TraversalBvh traversalBvh(const Device& device, const Bvh& bvh, const TrianglesView& triangles);

}  // namespace copse
