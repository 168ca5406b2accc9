// From a builder's tree to the one that rays read: inner nodes are numbered by a scan, and each then writes its node,
// and each leaf marks where it ends. O(n); the same on both devices.
#include "tracer/accel/binary.h"

#include "builder/base/error.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"
#include "tracer/accel/phases.h"

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

HD void setChild(BinaryNode& node, uint32_t c, const Box& box, uint32_t child, uint32_t below) {
  node.x[c] = box.lo.x, node.y[c] = box.lo.y, node.z[c] = box.lo.z;
  node.x[2 + c] = box.hi.x, node.y[2 + c] = box.hi.y, node.z[2 + c] = box.hi.z;
  node.child[c] = child;
  node.below[c] = below;
}

/// Node i of the builder's tree: an inner node writes its node of the new tree, a leaf marks its last triangle.
struct WriteNodes {
  const BvhNode* from;
  uint32_t count;
  const uint32_t* number;  ///< Per node: the inner nodes before it; then their total.
  BinaryNode* nodes;
  uint8_t* isLast;  ///< All 0.
  uint32_t* parents;

  static constexpr uint32_t prefetchDistance = 32;  ///< In nodes.

  HD void operator()(uint32_t i) const {
    prefetch(from + i + 2 * prefetchDistance);
    if (i + prefetchDistance < count) {  // For a leaf this is an unrelated address, which does no harm.
      prefetch(from + from[i + prefetchDistance].left);
      prefetch(number + from[i + prefetchDistance].left);
    }
    const BvhNode node = from[i];
    if (node.isLeaf())
      isLast[node.first() + node.count() - 1] = 1;
    else
      writeNode(number[i], node);
  }

  HD void writeNode(uint32_t at, const BvhNode& node) const {
    BinaryNode result;
    prefetchForStore(nodes + at + prefetchDistance / 2);
    // The larger child stands second: any-hit traversal tries it first, as it stops more rays (after Nah and
    // Manocha 2014).
    const BvhNode left = from[node.left], right = from[node.right];  // Copies, for loads of 16 bytes.
    const bool leftIsSecond = left.box().area() > right.box().area();
    setChild(result, 0, leftIsSecond ? right : left, leftIsSecond ? node.right : node.left, at);
    setChild(result, 1, leftIsSecond ? left : right, leftIsSecond ? node.left : node.right, at);
    nodes[at] = result;
  }

  HD void setChild(BinaryNode& result, uint32_t c, const BvhNode& child, uint32_t i, uint32_t parent) const {
    uint32_t link = leafBit | child.first(), below = link;
    if (!child.isLeaf()) {
      link = number[i];
      parents[link] = parent;
      below = belowOf(child, link);
    }
    copse::setChild(result, c, child.box(), link, below);
  }

  /// A GPU visits one node at a time and never reads it: there it is the link, which costs nothing.
  HD uint32_t belowOf([[maybe_unused]] const BvhNode& child, uint32_t link) const {
#if !COPSE_DEVICE_CODE
    const uint32_t first = number[child.left];
    const bool twoInner = number[child.left + 1] != first && number[child.right + 1] != number[child.right];
    if (twoInner && number[child.right] == first + 1) return BinaryNode::pairBit | first;
#endif
    return link;
  }
};

/// What every tree has: its bounds, a parent of the root, and the root above a single leaf.
struct WriteRoot {
  const BvhNode* from;
  BinaryNode* nodes;
  uint32_t* parents;
  Box* bounds;
  HD void operator()(uint32_t) const {
    parents[0] = 0;
    const BvhNode root = from[0];
    bounds[0] = root.isLeaf() ? root.box() : unite(from[root.left].box(), from[root.right].box());
    if (!root.isLeaf()) return;
    const uint32_t leaf = leafBit | root.first();
    BinaryNode above;
    setChild(above, 0, root.box(), leaf, leaf);
    setChild(above, 1, Box{}, leaf, leaf);
    nodes[0] = above;
  }
};

}  // namespace

Binary::Tree Binary::build(const Device& device, const Bvh& bvh, const TrianglesView& triangles, const Settings&) {
  Tree tree;
  if (bvh.nodeCount == 0) return tree;
  const uint32_t inner = (bvh.nodeCount - 1) / 2;  // Each has two children.
  if (inner >= BinaryNode::pairBit) throw InputError("a tree of 2^30 nodes or more cannot be traversed");
  Phase phase(device, phases::traversalLayout);
  const uint32_t count = inner > 0 ? inner : 1;
  tree.nodes = Buffer<BinaryNode>(device, count);
  tree.parents = Buffer<uint32_t>(device, count);
  tree.bounds = Buffer<Box>(device, 1);
  Buffer<uint32_t> number(device, std::size_t{bvh.nodeCount} + 1);
  launch(device, "mark nodes", bvh.nodeCount + 1, MarkInner{bvh.nodes.data(), bvh.nodeCount, number.data()});
  exclusiveScan(device, "number nodes", bvh.nodeCount + 1, number.data(), number.data(), nullptr);
  launch(device, "root", 1, WriteRoot{bvh.nodes.data(), tree.nodes.data(), tree.parents.data(), tree.bounds.data()});
  Buffer<uint8_t> isLast(device, bvh.referenceCount);
  isLast.fill(0);
  launch(device, "write nodes", bvh.nodeCount,
         WriteNodes{bvh.nodes.data(), bvh.nodeCount, number.data(), tree.nodes.data(), isLast.data(),
                    tree.parents.data()});
  tree.triangles = traversalTriangles(device, bvh, triangles, isLast.data());
  return tree;
}

}  // namespace copse
