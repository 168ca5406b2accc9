// From a builder's tree to the one that rays read. The order of the nodes is decided on the host, depth first;
// boxes and triangles are copied where they are. O(n).
#include "tracer/traversal/traversal_bvh.h"

#include <vector>

#include "builder/parallel/launch.h"

namespace copse {

namespace {

struct CopyTriangles {
  TrianglesView triangles;
  const uint32_t* order;
  const uint32_t* lastOfLeaf;
  TraversalTriangle* out;
  HD void operator()(uint32_t i) const {
    const uint32_t id = order[i];
    const uvec3 t = triangles.indices[id];
    const vec3 a = triangles.positions[t.x], b = triangles.positions[t.y], c = triangles.positions[t.z];
    out[i] = {{a.x, b.x, c.x}, id, {a.y, b.y, c.y}, lastOfLeaf[i], {a.z, b.z, c.z}, 0};
  }
};

void setChild(TraversalNode& node, int c, const Box& box, uint32_t link) {
  node.x[c] = box.lo.x, node.y[c] = box.lo.y, node.z[c] = box.lo.z;
  node.x[2 + c] = box.hi.x, node.y[2 + c] = box.hi.y, node.z[2 + c] = box.hi.z;
  node.child[c] = link;
}

}  // namespace

TraversalBvh traversalBvh(const Device& device, const Bvh& bvh, const TrianglesView& triangles) {
  TraversalBvh result;
  if (bvh.nodeCount == 0) return result;
  Phase phase(device, "traversal layout");
  const std::vector<BvhNode> from = bvh.nodes.toHost(bvh.nodeCount);
  const std::vector<uint32_t> order = bvh.order.toHost(bvh.primitiveCount);

  std::vector<TraversalNode> nodes;
  nodes.reserve(bvh.nodeCount / 2 + 1);
  std::vector<uint32_t> newOrder;
  newOrder.reserve(order.size());
  std::vector<uint32_t> last(order.size(), 0);
  auto addLeaf = [&](const BvhNode& leaf) {
    const uint32_t first = static_cast<uint32_t>(newOrder.size());
    for (uint32_t i = 0; i < leaf.count(); ++i) newOrder.push_back(order[leaf.first() + i]);
    last[newOrder.size() - 1] = 1;
    return TraversalNode::leafBit | first;
  };

  if (from[0].isLeaf()) {
    TraversalNode root{};
    setChild(root, 0, from[0].box(), addLeaf(from[0]));
    setChild(root, 1, Box{}, TraversalNode::leafBit);
    nodes.push_back(root);
  } else {
    struct Task {
      uint32_t node, parent;
      int child;
    };
    std::vector<Task> tasks{{0, 0, -1}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const BvhNode& node = from[task.node];
      uint32_t link;
      if (node.isLeaf()) {
        link = addLeaf(node);
      } else {
        link = static_cast<uint32_t>(nodes.size());
        nodes.emplace_back();
        nodes.back().parent = task.parent;
        tasks.push_back({node.right, link, 1});
        tasks.push_back({node.left, link, 0});
      }
      if (task.child >= 0) setChild(nodes[task.parent], task.child, node.box(), link);
    }
  }

  result.nodeCount = static_cast<uint32_t>(nodes.size());
  result.triangleCount = static_cast<uint32_t>(newOrder.size());
  result.nodes = Buffer<TraversalNode>(device, nodes);
  result.triangles = Buffer<TraversalTriangle>(device, newOrder.size());
  const Buffer<uint32_t> orderThere(device, newOrder), lastThere(device, last);
  launch(device, "traversal layout", result.triangleCount,
         CopyTriangles{triangles, orderThere.data(), lastThere.data(), result.triangles.data()});
  return result;
}

}  // namespace copse
