// What a tree is: nodes, and the order in which its leaves hold their references to triangles.
#pragma once

#include <cstdint>

#include "builder/math/box.h"
#include "builder/parallel/buffer.h"

namespace copse {

/// No leaf holds more, whatever leaf.max says.
constexpr uint32_t maxLeafSize = 64;

/// No node has more children, whatever a method's arity.
constexpr uint32_t maxArity = 8;

/// Node indices are 32 bits with two of them for marks, and there are 2n-1 nodes.
constexpr uint32_t maxReferences = 1u << 29;

/// 32 bytes, two 16-byte words. An inner node's `left` and `right` are node indices; a leaf's references are
/// order[left] … order[left + count - 1], with count in the low bits of `right`.
struct alignas(16) BvhNode {
  static constexpr uint32_t leafBit = 0x80000000u;

  vec3 lo;
  uint32_t left;
  vec3 hi;
  uint32_t right;

  HD bool isLeaf() const { return right & leafBit; }
  HD uint32_t first() const { return left; }
  HD uint32_t count() const { return right & ~leafBit; }
  HD Box box() const {
    Box b;
    b.lo = lo;
    b.hi = hi;
    return b;
  }
  HD static BvhNode inner(const Box& b, uint32_t left, uint32_t right) { return {b.lo, left, b.hi, right}; }
  HD static BvhNode leaf(const Box& b, uint32_t first, uint32_t count) { return {b.lo, first, b.hi, count | leafBit}; }
};
static_assert(sizeof(BvhNode) == 32);

/// The tree that is traversed: binary, its root is node 0, siblings stand side by side, and every box is around what is
/// below it. No references: no nodes. One reference: the root is a leaf.
///
/// A reference is a triangle's appearance in a leaf. Where triangles were split a triangle has several, each in a leaf
/// of its own whose box is around a part of it; otherwise each triangle has one and the two counts are equal.
///
/// A tree of wide nodes is kept as a binary one with marks: a joint is an inner node that has been collapsed
/// into the wide node above it, whose children it joins. Not counting joints, each node has up to `arity` children.
struct Bvh {
  Buffer<BvhNode> nodes;
  Buffer<uint32_t> order;    ///< Per reference: its triangle. A leaf's ascend.
  Buffer<uint32_t> parents;  ///< Per node, as ParentLinks has them; empty unless the build was to keep them.
  Buffer<uint8_t> joints;    ///< Per node: 1 for a joint (collapsed inner node), otherwise 0; empty for a binary tree.
  uint32_t arity = 2;        ///< The maximum of a node's children.
  uint32_t nodeCount = 0;
  uint32_t referenceCount = 0;
  uint32_t triangleCount = 0;
};

/// Indexed triangles in device memory: `count` triples into `positions`.
struct TrianglesView {
  const vec3* positions;
  const uvec3* indices;
  uint32_t count;
};

}  // namespace copse
