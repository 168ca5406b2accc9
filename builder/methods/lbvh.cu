// Linear BVH: a binary radix tree over Morton codes, all inner nodes at once.
// Karras: Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees (HPG 2012).
// Inner nodes are 0 … n-2 with the root first, leaf i of the sorted order is node n-1+i. O(n) and the radix sort.
#include "builder/bottom_up.h"
#include "builder/math/morton.h"
#include "builder/methods/lbvh.h"
#include "builder/methods/methods.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace {

struct EncodeCentres {
  const Box* boxes;
  MortonGrid grid;
  uint64_t* keys;
  uint32_t* order;

  HD void operator()(uint32_t i) const {
    keys[i] = grid.code(boxes[i].centre2());
    order[i] = i;
  }
};

/// Leaf i, and inner node i where there is one.
struct LinkNodes {
  RadixTree tree;
  const Box* boxes;
  const uint32_t* order;
  BvhNode* nodes;
  uint32_t* parents;

  static constexpr uint32_t ahead = 8;  ///< Leaves between a request for a box, which may lie anywhere, and its use.

  HD void operator()(uint32_t i) const {
    if (i + ahead < tree.count) prefetch(boxes + order[i + ahead]);
    nodes[tree.count - 1 + i] = BvhNode::leaf(boxes[order[i]], i, 1);
    if (i == 0) parents[0] = ParentLinks::none;
    if (i + 1 == tree.count) return;
    const RadixTree::Children children = tree.childrenOf(i);
    nodes[i] = BvhNode::inner(Box{}, children.left, children.right);
    parents[children.left] = i;
    parents[children.right] = i;
  }
};

}  // namespace

Bvh buildLbvh(const Device& device, const BuildInput& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  Bvh bvh;
  if (n == 0) return bvh;
  bvh.primitiveCount = n;
  bvh.nodeCount = 2 * n - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  bvh.order = Buffer<uint32_t>(device, n);

  const int bits = static_cast<int>(parameters.integer("morton.bits"));
  const bool cube = parameters.text("morton.scale") == "cube";
  Buffer<uint64_t> keys(device, n);
  {
    Phase phase(device, "morton");
    const MortonGrid grid = MortonGrid::over(input.bounds, bits, cube);
    launch(device, "encode centres", n, EncodeCentres{input.boxes, grid, keys.data(), bvh.order.data()});
  }
  {
    Phase phase(device, "sort");
    Buffer<uint64_t> keyScratch(device, n);
    Buffer<uint32_t> orderScratch(device, n);
    radixSort(device, "sort codes", n, 3 * bits, keys, bvh.order, keyScratch, orderScratch);
  }
  Phase phase(device, "hierarchy");
  bvh.parents = Buffer<uint32_t>(device, bvh.nodeCount);
  launch(device, "link nodes", n,
         LinkNodes{{keys.data(), n}, input.boxes, bvh.order.data(), bvh.nodes.data(), bvh.parents.data()});
  return bvh;
}

}  // namespace copse
