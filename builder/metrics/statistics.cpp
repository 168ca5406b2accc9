// What a tree is worth: its cost by the surface area heuristic, its depth and its leaves. On the host, O(n).
#include <algorithm>

#include "builder/build.h"
#include "builder/metrics/sah_costs.h"

namespace copse {

TreeStatistics statistics(const Device&, const Bvh& bvh, const Parameters& parameters) {
  TreeStatistics result;
  result.arity = bvh.arity;
  result.references = bvh.referenceCount;
  if (bvh.nodeCount == 0) return result;
  const std::vector<BvhNode> nodes = bvh.nodes.toHost(bvh.nodeCount);
  const std::vector<uint8_t> joints = bvh.joints.toHost();
  const SahCosts costs = sahCostsOf(parameters);

  struct Visit {
    uint32_t node, depth;
  };
  double innerArea = 0, testedArea = 0;
  for (std::vector<Visit> waiting{{0, 0}}; !waiting.empty();) {
    const auto [at, depth] = waiting.back();
    waiting.pop_back();
    const BvhNode& node = nodes[at];
    const bool isJoint = !joints.empty() && joints[at];
    const double area = node.box().area();
    result.nodes += !isJoint;
    if (node.isLeaf()) {
      testedArea += area * node.count();
      ++result.leaves;
      result.depth = std::max(result.depth, depth);
      result.maxLeafTriangles = std::max(result.maxLeafTriangles, node.count());
    } else {
      if (!isJoint) innerArea += area;
      for (const uint32_t child : {node.right, node.left})
        waiting.push_back({child, joints.empty() || !joints[child] ? depth + 1 : depth});
    }
  }
  // A scene without area, all its triangles on one line, costs nothing: no ray meets it but by chance.
  const double root = nodes[0].box().area();
  if (root > 0) result.sahCost = (costs.traversal * innerArea + costs.intersection * testedArea) / root;
  return result;
}

}  // namespace copse
