// From a builder's tree to the one that rays read: inner nodes are numbered by a scan, and each then writes its node,
// each leaf marks where it ends, and each triangle is copied. O(n); the same on both devices.
#include "tracer/accel/traversal_bvh.h"

#include "builder/base/error.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace {

struct MarkInner {
  const BvhNode* nodes;
  uint32_t count;
  uint32_t* isInner;  ///< One more than there are nodes.
  HD void operator()(uint32_t i) const {
    prefetch(nodes + i + 64);
    isInner[i] = i < count && !nodes[i].isLeaf();
  }
};

HD void setChild(TraversalNode& node, uint32_t c, const Box& box, uint32_t child, uint32_t below) {
  node.x[c] = box.lo.x, node.y[c] = box.lo.y, node.z[c] = box.lo.z;
  node.x[2 + c] = box.hi.x, node.y[2 + c] = box.hi.y, node.z[2 + c] = box.hi.z;
  node.child[c] = child;
  node.below[c] = below;
}

/// Node i of the builder's tree: an inner node writes its node, a leaf which of its triangles is its last.
struct WriteNodes {
  const BvhNode* from;
  uint32_t count;
  const uint32_t* number;  ///< Inner nodes before each node, and in all.
  TraversalNode* nodes;
  uint8_t* isLast;  ///< All 0.
  uint32_t* parents;

  static constexpr uint32_t ahead = 32;  ///< Nodes between a request for memory and its use.

  HD void operator()(uint32_t i) const {
    prefetch(from + i + 2 * ahead);
    if (i + ahead < count) {  // A leaf's is some other place, which does no harm.
      prefetch(from + from[i + ahead].left);
      prefetch(number + from[i + ahead].left);
    }
    const BvhNode node = from[i];
    if (node.isLeaf())
      isLast[node.first() + node.count() - 1] = 1;
    else
      writeNode(number[i], node);
  }

  HD void writeNode(uint32_t at, const BvhNode& node) const {
    TraversalNode result;
    prefetchForStore(nodes + at + ahead / 2);
    // The larger child stands second: any-hit traversal tries it first, as it stops more rays (after Nah and
    // Manocha 2014).
    const BvhNode left = from[node.left], right = from[node.right];  // Copies, for loads of 16 bytes.
    const bool leftIsSecond = left.box().area() > right.box().area();
    setChild(result, 0, leftIsSecond ? right : left, leftIsSecond ? node.right : node.left, at);
    setChild(result, 1, leftIsSecond ? left : right, leftIsSecond ? node.left : node.right, at);
    nodes[at] = result;
  }

  HD void setChild(TraversalNode& result, uint32_t c, const BvhNode& child, uint32_t i, uint32_t parent) const {
    uint32_t link = TraversalNode::leafBit | child.first(), below = link;
    if (!child.isLeaf()) {
      link = number[i];
      parents[link] = parent;
      below = belowOf(child, link);
    }
    copse::setChild(result, c, child.box(), link, below);
  }

  /// A GPU takes a node at a time and never reads it: there it is the link, which costs nothing.
  HD uint32_t belowOf([[maybe_unused]] const BvhNode& child, uint32_t link) const {
#if !COPSE_DEVICE_CODE
    const uint32_t first = number[child.left];
    const bool twoInner = number[child.left + 1] != first && number[child.right + 1] != number[child.right];
    if (twoInner && number[child.right] == first + 1) return TraversalNode::pairBit | first;
#endif
    return link;
  }
};

/// The triangle that stands i-th in the order. A triangle, and then its corners, may lie anywhere in memory: the CPU
/// asks for both well ahead.
struct WriteTriangles {
  const uint32_t* order;
  const uint8_t* isLast;
  uint32_t count;  ///< Of the order.
  TrianglesView triangles;
  TraversalTriangle* out;

  static constexpr uint32_t indicesAhead = 64, cornersAhead = 32;

  HD void operator()(uint32_t i) const {
    if (i + indicesAhead < count) prefetch(triangles.indices + order[i + indicesAhead]);
    if (i + cornersAhead < count) {
      const uvec3 next = triangles.indices[order[i + cornersAhead]];
      prefetch(triangles.positions + next.x);
      prefetch(triangles.positions + next.y);
      prefetch(triangles.positions + next.z);
    }
    prefetchForStore(out + i + 16);
    const uint32_t id = order[i];
    const uvec3 t = triangles.indices[id];
    const vec3 a = triangles.positions[t.x], b = triangles.positions[t.y], c = triangles.positions[t.z];
    out[i] = {{a.x, b.x, c.x}, id, {a.y, b.y, c.y}, isLast[i], {a.z, b.z, c.z}, 0};
  }
};

/// The root above a single leaf, and every root's parent.
struct Root {
  const BvhNode* from;
  TraversalNode* nodes;
  uint32_t* parents;
  HD void operator()(uint32_t) const {
    parents[0] = 0;
    if (!from[0].isLeaf()) return;
    const uint32_t leaf = TraversalNode::leafBit | from[0].first();
    TraversalNode root;
    setChild(root, 0, from[0].box(), leaf, leaf);
    setChild(root, 1, Box{}, leaf, leaf);
    nodes[0] = root;
  }
};

}  // namespace

TraversalBvh traversalBvh(const Device& device, const Bvh& bvh, const TrianglesView& triangles) {
  TraversalBvh result;
  if (bvh.nodeCount == 0) return result;
  const uint32_t inner = (bvh.nodeCount - 1) / 2;  // Each has two children.
  if (inner >= TraversalNode::pairBit) throw InputError("a tree of 2^30 nodes or more cannot be traversed");
  Phase phase(device, "traversal layout");
  result.nodeCount = inner > 0 ? inner : 1;
  result.triangleCount = bvh.referenceCount;
  result.nodes = Buffer<TraversalNode>(device, result.nodeCount);
  result.parents = Buffer<uint32_t>(device, result.nodeCount);
  result.triangles = Buffer<TraversalTriangle>(device, result.triangleCount);
  Buffer<uint32_t> number(device, std::size_t{bvh.nodeCount} + 1);
  launch(device, "mark nodes", bvh.nodeCount + 1, MarkInner{bvh.nodes.data(), bvh.nodeCount, number.data()});
  exclusiveScan(device, "number nodes", bvh.nodeCount + 1, number.data(), number.data(), nullptr);
  launch(device, "root", 1, Root{bvh.nodes.data(), result.nodes.data(), result.parents.data()});
  Buffer<uint8_t> isLast(device, result.triangleCount);
  isLast.fill(0);
  launch(device, "write nodes", bvh.nodeCount,
         WriteNodes{bvh.nodes.data(), bvh.nodeCount, number.data(), result.nodes.data(), isLast.data(),
                    result.parents.data()});
  launch(device, "write triangles", result.triangleCount,
         WriteTriangles{bvh.order.data(), isLast.data(), bvh.referenceCount, triangles, result.triangles.data()});
  if (!device.isCuda()) result.wideNodes = wideNodes(device, bvh);
  return result;
}

}  // namespace copse
