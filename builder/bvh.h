// What a tree is: nodes, the order of the primitives in its leaves, and a plain view that kernels take by value.
#pragma once

#include <cstdint>

#include "builder/math/box.h"
#include "builder/parallel/buffer.h"

namespace copse {

/// No leaf holds more, whatever leaf.max says.
constexpr uint32_t maxLeafSize = 64;

/// No node has more children, whatever a method's arity.
constexpr uint32_t maxArity = 8;

/// 32 bytes, two 16-byte words. An inner node's `left` and `right` are node indices; a leaf's primitives are
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

struct BvhView {
  const BvhNode* nodes;
  const uint32_t* order;
  uint32_t nodeCount;
  uint32_t primitiveCount;
};

/// A binary tree whose root is node 0. No primitives: no nodes. One primitive: the root is a leaf.
/// A builder leaves one primitive a leaf (2n-1 nodes) unless its method says otherwise; nodes may stand in any order,
/// and inner nodes' boxes may be empty where the method itself has no use for them.
/// collapseAndLayout() fits the boxes and makes the tree that is traversed: larger leaves, siblings side by side.
///
/// A tree of wide nodes is kept as a binary one with marks: a joint is an inner node that is there only to join
/// children of the wide node above it. Without the joints each node has up to `arity` children.
struct Bvh {
  Buffer<BvhNode> nodes;
  Buffer<uint32_t> order;
  Buffer<uint32_t> parents;  ///< As ParentLinks has them, of every node; empty where the builder keeps none.
  Buffer<uint8_t> joints;    ///< Of every node: 1 for a joint, otherwise 0; empty for a tree that is just binary.
  uint32_t arity = 2;        ///< Most children of a node.
  uint32_t nodeCount = 0;
  uint32_t primitiveCount = 0;
  uint32_t firstLeaf = 0;  ///< No leaf stands before it.

  BvhView view() const { return {nodes.data(), order.data(), nodeCount, primitiveCount}; }
};

/// Indexed triangles in device memory: `count` triples into `positions`.
struct TrianglesView {
  const vec3* positions;
  const uvec3* indices;
  uint32_t count;
};

}  // namespace copse
