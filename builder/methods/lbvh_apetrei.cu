// The tree of lbvh, made from the leaves up in one pass: each leaf walks towards the root, and where two walks meet
// the second has both ends of the node's range and goes on.
// Apetrei: Fast and Simple Agglomerative LBVH Construction (CGVC 2014). O(n) and the radix sort.
#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/methods/lbvh.h"
#include "builder/parallel/launch.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace {

/// Node and parent numbers are Karras': the range [first, last] is node `last` where it is a left child, `first` where
/// it is a right one, and 0 as the root. So both ways give the same words, whoever comes first.
struct WalkUp {
  static constexpr uint32_t nobody = ~0u;
  static constexpr uint32_t prefetchDistance = 8;  ///< As in lbvh.

  RadixTree tree;
  const Box* boxes;
  const uint32_t* order;
  BvhNode* nodes;
  uint32_t* parents;
  /// Per split between leaves k and k+1: the other end of the half that was here first, or nobody.
  uint32_t* otherEnd;

  HD void operator()(uint32_t i) const {
    const uint32_t n = tree.count;
    if (i + prefetchDistance < n) prefetch(boxes + order[i + prefetchDistance]);
    const Box box = boxes[order[i]];  // As in lbvh.
    nodes[n - 1 + i] = BvhNode::leaf(box, i, 1);
    if (i == 0) parents[0] = ParentLinks::none;
    uint32_t first = i, last = i;
    while (!isRoot(first, last)) {
      const bool left = isLeft(first, last);
      const uint32_t split = left ? last : first - 1;
      // The two exchange nothing but the end of a range, so no other memory need be ordered.
      const uint32_t end = atomicExchangeRelaxed(otherEnd + split, left ? first : last);
      if (end == nobody) return;
      (left ? last : first) = end;
      link(first, split, last);
    }
  }

  HD bool isRoot(uint32_t first, uint32_t last) const { return first == 0 && last == tree.count - 1; }
  /// The parent splits where the range borders on the neighbour with which it has more in common.
  HD bool isLeft(uint32_t first, uint32_t last) const {
    return first == 0 ||
           (last != tree.count - 1 && tree.difference(last, last + 1) < tree.difference(first - 1, first));
  }
  HD void link(uint32_t first, uint32_t split, uint32_t last) const {
    const uint32_t leaves = tree.count - 1;  // Where they start.
    const uint32_t left = first == split ? leaves + split : split;
    const uint32_t right = last == split + 1 ? leaves + last : split + 1;
    const uint32_t at = isRoot(first, last) ? 0 : isLeft(first, last) ? last : first;
    nodes[at] = BvhNode::inner(Box{}, left, right);
    parents[left] = at;
    parents[right] = at;
  }
};

OpenTree buildLbvhApetrei(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  if (n == 0) return {};
  MortonOrder sorted = mortonOrder(device, input, parameters);
  Phase phase(device, phases::hierarchy);
  OpenTree bvh = treeOver(device, sorted);
  Buffer<uint32_t> otherEnd(device, n);
  otherEnd.fill(0xff);
  launch(device, "walk up", n,
         WalkUp{{sorted.keys.data(), n},
                input.boxes,
                bvh.order.data(),
                bvh.nodes.data(),
                bvh.parents.data(),
                otherEnd.data()});
  return bvh;
}

}  // namespace

namespace methods {

Method lbvhApetrei() {
  return {.name = "lbvh-apetrei",
          .source = "Apetrei 2014",
          .meaning = "the tree of lbvh in one bottom-up pass",
          .family = "lbvh",
          .page = "docs/builders/lbvh-apetrei.md",
          .build = buildLbvhApetrei};
}

}  // namespace methods

}  // namespace copse
