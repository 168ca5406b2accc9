// Checks a tree against the triangles that it was built from. On the host, O(n); nothing in the tree is trusted.
#include <fmt/format.h>

#include <cmath>

#include "builder/base/error.h"
#include "builder/build.h"
#include "builder/primitives/host_triangles.h"

namespace copse {

namespace {

struct Checker {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  HostTriangles triangles;
  std::vector<uint8_t> joints;
  uint32_t arity;
  uint32_t maxLeaf;
  std::vector<bool> nodeSeen, primitiveSeen;

  template <class... Args>
  [[noreturn]] static void fail(fmt::format_string<Args...> text, Args&&... args) {
    throw ValidationError("tree: " + fmt::format(text, std::forward<Args>(args)...));
  }

  static bool inside(const Box& inner, const Box& outer) {
    for (int axis = 0; axis < 3; ++axis)
      if (!(outer.lo[axis] <= inner.lo[axis] && inner.hi[axis] <= outer.hi[axis])) return false;
    return true;
  }

  /// Marks `child` of `parent` as reached.
  void reach(uint32_t child, uint32_t parent) {
    if (child >= nodes.size()) fail("node {}: its child {} is past the last node {}", parent, child, nodes.size() - 1);
    if (nodeSeen[child]) fail("node {}: its child {} has another parent, or is above it", parent, child);
    nodeSeen[child] = true;
    if (!inside(nodes[child].box(), nodes[parent].box()))
      fail("node {}: the box of its child {} is not inside its own", parent, child);
  }

  void checkLeaf(uint32_t at) {
    const BvhNode& leaf = nodes[at];
    if (leaf.count() == 0) fail("leaf {}: no triangle", at);
    if (leaf.count() > maxLeaf) fail("leaf {}: {} triangles, at most {} are allowed", at, leaf.count(), maxLeaf);
    if (leaf.first() >= order.size() || leaf.count() > order.size() - leaf.first())
      fail("leaf {}: places {} to {} of {}", at, leaf.first(), uint64_t{leaf.first()} + leaf.count() - 1, order.size());
    for (uint32_t k = leaf.first(); k < leaf.first() + leaf.count(); ++k) {
      const uint32_t primitive = order[k];
      if (primitive >= triangles.indices.size())
        fail("leaf {}: triangle {} of {}", at, primitive, triangles.indices.size());
      if (primitiveSeen[primitive]) fail("leaf {}: triangle {} is in a leaf already", at, primitive);
      primitiveSeen[primitive] = true;
      for (int corner = 0; corner < 3; ++corner)
        checkCorner(at, primitive, triangles.positions[triangles.indices[primitive][corner]]);
    }
  }

  /// A corner that is not finite is in no box; no ray hits its triangle.
  void checkCorner(uint32_t at, uint32_t primitive, const vec3& p) const {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return;
    Box corner;
    corner.lo = corner.hi = p;
    if (!inside(corner, nodes[at].box())) fail("leaf {}: triangle {} is not inside its box", at, primitive);
  }

  /// The children of a node that is no joint, those below its joints included. Its links are sound: it has been checked
  /// as part of the tree.
  void checkArity(uint32_t at) const {
    uint32_t children = 0;
    for (std::vector<uint32_t> open{nodes[at].left, nodes[at].right}; !open.empty();) {
      const uint32_t child = open.back();
      open.pop_back();
      if (!joints[child])
        ++children;
      else if (nodes[child].isLeaf())
        fail("leaf {}: marked as a joint", child);
      else
        open.insert(open.end(), {nodes[child].left, nodes[child].right});
    }
    if (children > arity) fail("node {}: {} children, at most {} are allowed", at, children, arity);
  }

  void checkJoints() const {
    if (arity < 2 || arity > maxArity) fail("an arity of {}", arity);
    if (joints.empty()) return;
    if (joints[0]) fail("node 0: the root is marked as a joint");
    for (uint32_t i = 0; i < nodes.size(); ++i)
      if (!nodes[i].isLeaf() && !joints[i]) checkArity(i);
  }

  void run() {
    if (order.size() != triangles.indices.size())
      fail("{} triangles in its order, {} in the scene", order.size(), triangles.indices.size());
    if (nodes.empty() != triangles.indices.empty())
      fail("{} nodes for {} triangles", nodes.size(), triangles.indices.size());
    if (nodes.empty()) return;
    nodeSeen.assign(nodes.size(), false);
    primitiveSeen.assign(triangles.indices.size(), false);
    nodeSeen[0] = true;
    for (std::vector<uint32_t> waiting{0}; !waiting.empty();) {
      const uint32_t at = waiting.back();
      waiting.pop_back();
      if (nodes[at].isLeaf()) {
        checkLeaf(at);
        continue;
      }
      for (const uint32_t child : {nodes[at].right, nodes[at].left}) {
        reach(child, at);
        waiting.push_back(child);
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!nodeSeen[i]) fail("node {}: not reached from the root", i);
    for (std::size_t i = 0; i < primitiveSeen.size(); ++i)
      if (!primitiveSeen[i]) fail("triangle {}: in no leaf", i);
    checkJoints();
  }
};

}  // namespace

void validate(const Device& device, const Bvh& bvh, const TrianglesView& triangles, uint32_t maxLeaf) {
  if (bvh.nodes.size() < bvh.nodeCount || bvh.order.size() < bvh.primitiveCount)
    Checker::fail("{} nodes and {} triangles are more than its memory holds", bvh.nodeCount, bvh.primitiveCount);
  if (!bvh.joints.empty() && bvh.joints.size() != bvh.nodeCount)
    Checker::fail("{} marks for {} nodes", bvh.joints.size(), bvh.nodeCount);
  Checker checker{bvh.nodes.toHost(bvh.nodeCount),
                  bvh.order.toHost(bvh.primitiveCount),
                  HostTriangles(device, triangles),
                  bvh.joints.toHost(),
                  bvh.arity,
                  maxLeaf,
                  {},
                  {}};
  checker.run();
}

}  // namespace copse
