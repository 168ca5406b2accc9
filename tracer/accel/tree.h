// What all tree formats share: links, the triangles in the order of the leaves, and the plain view that kernels take by
// value. A format is a type such as Binary (binary.h) or Wide8 (wide8.h) with its Node, its View, its Tree that owns
// what the view shows, a build from a Bvh, and the steps that a walk takes in it (walk.h says what a step is).
#pragma once

#include "builder/bvh.h"

namespace copse {

/// A link is how a node refers to a child. With `leafBit` it is a leaf, and the other bits are the leaf's first
/// triangle; otherwise it is a node.
constexpr uint32_t leafBit = 0x80000000u;

/// No node and no leaf: a leaf's first triangle is below 2^31 - 1.
constexpr uint32_t emptyLink = 0xffffffffu;

HD inline bool isNode(uint32_t link) { return !(link & leafBit); }

/// A triangle by axis: the three vertices' x, then y, then z, in their given order, so that an edge shared by two
/// triangles is computed alike in both.
struct alignas(16) TraversalTriangle {
  float x[3];
  uint32_t id;  ///< The scene's triangle.
  float y[3];
  uint32_t last;  ///< 1 for the last triangle of its leaf, otherwise 0.
  float z[3];
  uint32_t unused;
};
static_assert(sizeof(TraversalTriangle) == 48);

/// What kernels take by value. The root is node 0. Without triangles there are no nodes and no bounds.
template <class N>
struct TreeView {
  const N* nodes;
  const TraversalTriangle* triangles;
  const uint32_t* parents;  ///< Per node, for a walk that has run out of stack. The root is its own parent.
  const Box* bounds;        ///< Those of the whole tree: how far boxes have to be padded for a ray depends on them.
  uint32_t nodeCount;
};

/// The buffers behind a TreeView.
template <class N>
struct TreeBuffers {
  Buffer<N> nodes;
  Buffer<TraversalTriangle> triangles;
  Buffer<uint32_t> parents;
  Buffer<Box> bounds;

  TreeView<N> view() const {
    return {nodes.data(), triangles.data(), parents.data(), bounds.data(), static_cast<uint32_t>(nodes.size())};
  }
  std::size_t bytes() const { return nodes.bytes() + triangles.bytes() + parents.bytes() + bounds.bytes(); }
};

/// Gathers the triangles in the order of `bvh`'s leaves. `isLast[i]` says whether the i-th is the last of its leaf: the
/// kernel that writes a format's nodes visits every leaf and has marked it.
Buffer<TraversalTriangle> traversalTriangles(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                                             const uint8_t* isLast);

}  // namespace copse
