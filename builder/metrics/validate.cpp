// Checks a tree against the triangles that it was built from. On the host, O(n); nothing in the tree is trusted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "builder/base/error.h"
#include "builder/build.h"
#include "builder/metrics/polygon.h"

namespace copse {

namespace {

struct Checker {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  HostTriangles triangles;
  std::vector<uint8_t> joints;
  uint32_t arity;
  uint32_t maxLeaf;
  uint32_t triangleCount;
  std::vector<bool> nodeSeen{}, triangleSeen{};
  std::vector<std::pair<uint32_t, uint32_t>> references{};  ///< Triangle and leaf; where triangles may have several.

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
    if (leaf.count() > maxLeaf) fail("leaf {}: {} triangles exceed the maximum of {}", at, leaf.count(), maxLeaf);
    if (leaf.first() >= order.size() || leaf.count() > order.size() - leaf.first())
      fail("leaf {}: references {} to {} exceed the number of references, {}", at, leaf.first(),
           uint64_t{leaf.first()} + leaf.count() - 1, order.size());
    for (uint32_t k = leaf.first(); k < leaf.first() + leaf.count(); ++k) {
      const uint32_t triangle = order[k];
      if (triangle >= triangles.indices.size())
        fail("leaf {}: triangle {} exceeds the scene's {} triangles", at, triangle, triangles.indices.size());
      if (mayRepeat())
        references.emplace_back(triangle, at);
      else if (triangleSeen[triangle])
        fail("leaf {}: triangle {} is already in another leaf", at, triangle);
      else
        checkWhole(triangle, at);
      triangleSeen[triangle] = true;
    }
  }

  /// Whether a triangle may be in several leaves.
  bool mayRepeat() const { return order.size() > triangleCount; }

  /// Calls check(box) with each corner of `triangle` as a box. A corner that is not finite is in no box; no ray hits
  /// its triangle.
  template <class Check>
  void forCorners(uint32_t triangle, const Check& check) const {
    for (int c = 0; c < 3; ++c) {
      const vec3& p = triangles.positions[triangles.indices[triangle][c]];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      Box corner;
      corner.lo = corner.hi = p;
      check(corner);
    }
  }

  void checkWhole(uint32_t triangle, uint32_t leaf) const {
    forCorners(triangle, [&](const Box& corner) {
      if (!inside(corner, nodes[leaf].box())) fail("leaf {}: triangle {} is not inside its box", leaf, triangle);
    });
  }

  /// What each leaf's box holds of a triangle, together, must be all of it.
  void checkReferences() {
    std::sort(references.begin(), references.end());
    for (std::size_t begin = 0, end; begin < references.size(); begin = end) {
      const uint32_t triangle = references[begin].first;
      for (end = begin; end < references.size() && references[end].first == triangle;) ++end;
      if (end - begin == 1)
        checkWhole(triangle, references[begin].second);
      else
        checkParts(triangle, begin, end);
    }
  }

  void checkParts(uint32_t triangle, std::size_t begin, std::size_t end) const {
    const metrics::Triangle whole = metrics::triangleOf(triangles, triangle);
    for (std::size_t i = begin; i < end; ++i)
      if (const uint32_t leaf = references[i].second; whole.area > 0 && !metrics::overlap(whole.box, nodes[leaf].box()))
        fail("leaf {}: triangle {} is outside its box", leaf, triangle);
    const auto lost = [&] {
      fail("triangle {}: a part of it is outside the boxes of all its {} leaves", triangle, end - begin);
    };
    forCorners(triangle, [&](const Box& corner) {
      const auto holds = [&](const auto& reference) { return inside(corner, nodes[reference.second].box()); };
      if (std::none_of(references.begin() + static_cast<std::ptrdiff_t>(begin),
                       references.begin() + static_cast<std::ptrdiff_t>(end), holds))
        lost();
    });
    // What is left of it as each box is cut out. Boxes of parts are rounded, so slivers may be left between them.
    constexpr double sliver = 1e-5;
    if (whole.area <= 0) return;
    std::vector<metrics::Polygon> left{metrics::Polygon(whole.corners)};
    for (std::size_t i = begin; i < end; ++i) left = without(left, nodes[references[i].second].box());
    double area = 0;
    for (const metrics::Polygon& part : left) area += part.area();
    if (area > sliver * whole.area) lost();
  }

  static std::vector<metrics::Polygon> without(const std::vector<metrics::Polygon>& parts, const Box& box) {
    std::vector<metrics::Polygon> left;
    const auto cut = [&](metrics::Polygon& part, int axis, double plane, double sign) {
      if (!part.reaches(axis, plane, -sign)) return;
      left.push_back(part);
      left.back().clip(axis, plane, -sign);
      part.clip(axis, plane, sign);
    };
    for (metrics::Polygon part : parts)
      for (int axis = 0; axis < 3; ++axis) {
        cut(part, axis, box.lo[axis], 1);
        cut(part, axis, box.hi[axis], -1);
      }
    return left;
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
        fail("leaf {}: marked as a collapsed inner node (joint)", child);
      else
        open.insert(open.end(), {nodes[child].left, nodes[child].right});
    }
    if (children > arity) fail("node {}: {} children exceed the maximum of {}", at, children, arity);
  }

  void checkJoints() const {
    if (arity < 2 || arity > maxArity) fail("expected an arity from 2 to {}, got {}", maxArity, arity);
    if (joints.empty()) return;
    if (joints[0]) fail("node 0: the root is marked as a collapsed inner node (joint)");
    for (uint32_t i = 0; i < nodes.size(); ++i)
      if (!nodes[i].isLeaf() && !joints[i]) checkArity(i);
  }

  void run() {
    if (order.size() < triangles.indices.size())
      fail("{} references for {} triangles", order.size(), triangles.indices.size());
    if (triangleCount != triangles.indices.size())
      fail("{} triangles, but the scene has {}", triangleCount, triangles.indices.size());
    if (nodes.empty() != triangles.indices.empty())
      fail("{} nodes for {} triangles", nodes.size(), triangles.indices.size());
    if (nodes.empty()) return;
    nodeSeen.assign(nodes.size(), false);
    triangleSeen.assign(triangles.indices.size(), false);
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
    for (std::size_t i = 0; i < triangleSeen.size(); ++i)
      if (!triangleSeen[i]) fail("triangle {}: in no leaf", i);
    checkReferences();
    checkJoints();
  }
};

}  // namespace

void validate(const Device& device, const Bvh& bvh, const TrianglesView& triangles, uint32_t maxLeaf) {
  if (bvh.nodes.size() < bvh.nodeCount || bvh.order.size() < bvh.referenceCount)
    Checker::fail("buffers are too small for {} nodes and {} references", bvh.nodeCount, bvh.referenceCount);
  if (!bvh.joints.empty() && bvh.joints.size() != bvh.nodeCount)
    Checker::fail("{} joint marks for {} nodes", bvh.joints.size(), bvh.nodeCount);
  Checker checker{bvh.nodes.toHost(bvh.nodeCount),
                  bvh.order.toHost(bvh.referenceCount),
                  HostTriangles(device, triangles),
                  bvh.joints.toHost(),
                  bvh.arity,
                  maxLeaf,
                  bvh.triangleCount};
  checker.run();
}

}  // namespace copse
