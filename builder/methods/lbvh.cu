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

struct LinkNodes {
  RadixTree tree;
  BvhNode* nodes;
  uint32_t* parents;

  HD void operator()(uint32_t i) const {
    const RadixTree::Children children = tree.childrenOf(i);
    nodes[i].left = children.left;
    nodes[i].right = children.right;
    parents[children.left] = i;
    parents[children.right] = i;
    if (i == 0) parents[0] = ParentLinks::none;
  }
};

/// Leaves between a request for a box, which may lie anywhere, and its use.
constexpr uint32_t ahead = 8;

struct FitBoxes {
  const Box* boxes;
  const uint32_t* order;
  ParentLinks parents;
  BvhNode* nodes;
  uint32_t count;

  HD void operator()(uint32_t i) const {
    if (i + ahead < count) prefetch(boxes + order[i + ahead]);
    const uint32_t leaf = count - 1 + i;
    nodes[leaf] = BvhNode::leaf(boxes[order[i]], i, 1);
    uint32_t at = parents.ofLeaf(leaf), parent;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent) {
      BvhNode& node = nodes[at];
      const Box box = unite(nodes[node.left].box(), nodes[node.right].box());
      node.lo = box.lo;
      node.hi = box.hi;
    }
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
  {
    Phase phase(device, "hierarchy");
    bvh.parents = Buffer<uint32_t>(device, bvh.nodeCount);
    if (n == 1) bvh.parents.upload({{ParentLinks::none}});
    launch(device, "link nodes", n - 1, LinkNodes{{keys.data(), n}, bvh.nodes.data(), bvh.parents.data()});
  }
  {
    Phase phase(device, "refit");
    launch(device, "fit boxes", n, FitBoxes{input.boxes, bvh.order.data(), {bvh.parents.data()}, bvh.nodes.data(), n});
  }
  return bvh;
}

}  // namespace copse
