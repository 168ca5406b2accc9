// From a builder's tree to the one that rays read: inner nodes are numbered by a scan, and each inner node and leaf
// then writes its own part. O(n); the same on both devices.
#include "tracer/traversal/traversal_bvh.h"

#include "builder/parallel/error.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace {

struct MarkInner {
  const BvhNode* nodes;
  uint32_t* isInner;
  HD void operator()(uint32_t i) const { isInner[i] = !nodes[i].isLeaf(); }
};

HD void setChild(TraversalNode& node, uint32_t c, const Box& box, uint32_t child, uint32_t below) {
  node.x[c] = box.lo.x, node.y[c] = box.lo.y, node.z[c] = box.lo.z;
  node.x[2 + c] = box.hi.x, node.y[2 + c] = box.hi.y, node.z[2 + c] = box.hi.z;
  node.child[c] = child;
  node.below[c] = below;
}

/// Node i of the builder's tree: an inner node writes its node, a leaf its triangles.
struct Convert {
  const BvhNode* from;
  const uint32_t* order;
  const uint32_t* number;  ///< Inner nodes before each node.
  TrianglesView triangles;
  TraversalNode* nodes;
  TraversalTriangle* out;
  uint32_t* parents;

  HD void operator()(uint32_t i) const {
    if (from[i].isLeaf())
      writeLeaf(from[i]);
    else
      writeNode(number[i], from[i]);
  }

  HD void writeNode(uint32_t at, const BvhNode& node) const {
    TraversalNode result;
    // The larger child stands second: any-hit traversal tries it first, as it stops more rays (after Nah and
    // Manocha 2014).
    const uint32_t larger = from[node.left].box().area() > from[node.right].box().area() ? 0 : 1;
    for (uint32_t c = 0; c < 2; ++c) {
      const uint32_t i = (c ^ larger) == 0 ? node.right : node.left;
      const BvhNode& child = from[i];
      uint32_t link, below;
      if (child.isLeaf()) {
        link = below = TraversalNode::leafBit | child.first();
      } else {
        link = below = number[i];
        parents[link] = at;
        const uint32_t first = number[child.left];
        if (!from[child.left].isLeaf() && !from[child.right].isLeaf() && number[child.right] == first + 1)
          below = TraversalNode::pairBit | first;
      }
      setChild(result, c, child.box(), link, below);
    }
    nodes[at] = result;
  }

  HD void writeLeaf(const BvhNode& leaf) const {
    for (uint32_t k = 0; k < leaf.count(); ++k) {
      const uint32_t id = order[leaf.first() + k];
      const uvec3 t = triangles.indices[id];
      const vec3 a = triangles.positions[t.x], b = triangles.positions[t.y], c = triangles.positions[t.z];
      const uint32_t last = k + 1 == leaf.count();
      out[leaf.first() + k] = {{a.x, b.x, c.x}, id, {a.y, b.y, c.y}, last, {a.z, b.z, c.z}, 0};
    }
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
  result.triangleCount = bvh.primitiveCount;
  result.nodes = Buffer<TraversalNode>(device, result.nodeCount);
  result.parents = Buffer<uint32_t>(device, result.nodeCount);
  result.triangles = Buffer<TraversalTriangle>(device, result.triangleCount);
  Buffer<uint32_t> number(device, bvh.nodeCount);
  launch(device, "mark nodes", bvh.nodeCount, MarkInner{bvh.nodes.data(), number.data()});
  exclusiveScan(device, "number nodes", bvh.nodeCount, number.data(), number.data(), nullptr);
  launch(device, "root", 1, Root{bvh.nodes.data(), result.nodes.data(), result.parents.data()});
  launch(device, "traversal layout", bvh.nodeCount,
         Convert{bvh.nodes.data(), bvh.order.data(), number.data(), triangles, result.nodes.data(),
                 result.triangles.data(), result.parents.data()});
  result.wideNodes = wideNodes(device, bvh);
  return result;
}

}  // namespace copse
