// Linear BVH: a binary radix tree over Morton codes, all inner nodes at once.
// Karras: Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees (HPG 2012).
// Inner nodes are 0 … n-2 with the root first, leaf i of the sorted order is node n-1+i. O(n) and the radix sort.
#include "builder/methods/lbvh.h"

#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/parallel/launch.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace {

/// Leaf i, and inner node i where there is one.
struct LinkNodes {
  RadixTree tree;
  const Box* boxes;
  const uint32_t* order;
  BvhNode* nodes;
  uint32_t* parents;

  static constexpr uint32_t prefetchDistance = 16;     ///< In leaves, whose boxes may lie anywhere.
  static constexpr uint32_t farPrefetchDistance = 64;  ///< The same for what is read and written in order.

  HD void operator()(uint32_t i) const {
    if (i + prefetchDistance < tree.count) prefetch(boxes + order[i + prefetchDistance]);
    prefetch(order + i + farPrefetchDistance);
    prefetch(tree.keys + i + farPrefetchDistance);
    prefetchForStore(nodes + i + prefetchDistance);
    prefetchForStore(nodes + tree.count - 1 + i + prefetchDistance);
    prefetchForStore(parents + i + farPrefetchDistance);
    prefetchForStore(parents + tree.count - 1 + i + farPrefetchDistance);
    const Box box = boxes[order[i]];  // A copy, for two loads of 16 bytes.
    nodes[tree.count - 1 + i] = BvhNode::leaf(box, i, 1);
    if (i == 0) parents[0] = ParentLinks::none;
    if (i + 1 == tree.count) return;
    const RadixTree::Children children = tree.childrenOf(i);
    nodes[i] = BvhNode::inner(Box{}, children.left, children.right);
    parents[children.left] = i;
    parents[children.right] = i;
  }
};

}  // namespace

OpenTree buildLbvh(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  if (n == 0) return {};
  MortonOrder sorted = mortonOrder(device, input, parameters);
  Phase phase(device, phases::hierarchy);
  OpenTree bvh = treeOver(device, sorted);
  launch(device, "link nodes", n,
         LinkNodes{{sorted.keys.data(), n}, input.boxes, bvh.order.data(), bvh.nodes.data(), bvh.parents.data()});
  return bvh;
}

namespace methods {

Method lbvh() {
  return {.name = "lbvh",
          .source = "Karras 2012",
          .meaning = "linear BVH: radix tree over sorted Morton codes",
          .page = "docs/builders/lbvh.md",
          .build = buildLbvh};
}

}  // namespace methods

}  // namespace copse
