// From a binary tree with joints to wide nodes: those above a joint are numbered by a scan, and each gathers the
// children below its joints. O(n); the same on both devices.
#include "tracer/traversal/wide_nodes.h"

#include "builder/parallel/error.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"
#include "tracer/traversal/traversal_bvh.h"

namespace copse {

namespace {

struct MarkWide {
  const BvhNode* nodes;
  const uint8_t* joints;
  uint32_t* isWide;
  HD void operator()(uint32_t i) const {
    const BvhNode& node = nodes[i];
    isWide[i] = !node.isLeaf() && !joints[i] && (i == 0 || joints[node.left] || joints[node.right]);
  }
};

struct GatherChildren {
  const BvhNode* from;
  const uint8_t* joints;
  const uint32_t* number;      ///< Inner nodes before each node,
  const uint32_t* wideNumber;  ///< and wide ones.
  uint32_t nodeCount, wideCount;
  WideNode* nodes;

  HD void operator()(uint32_t i) const {
    if (!isWide(i)) return;
    uint32_t children[WideNode::width] = {from[i].left, from[i].right};
    uint32_t count = 2;
    for (uint32_t k = 0; k < count;) {
      const uint32_t child = children[k];
      if (joints[child]) {
        children[k] = from[child].left;
        children[count++] = from[child].right;
      } else {
        ++k;
      }
    }
    sortByArea(children, count);
    WideNode& node = nodes[wideNumber[i]];
    for (uint32_t k = 0; k < WideNode::width; ++k) set(node, k, k < count ? children[k] : TraversalNode::leafBit);
  }

 private:
  HD bool isWide(uint32_t i) const { return wideNumber[i] != (i + 1 < nodeCount ? wideNumber[i + 1] : wideCount); }

  /// Any-hit traversal tries the largest first, as it stops more rays, and takes children from the end.
  HD void sortByArea(uint32_t* children, uint32_t count) const {
    for (uint32_t k = 1; k < count; ++k) {
      const uint32_t child = children[k];
      const float area = from[child].box().area();
      uint32_t at = k;
      for (; at > 0 && from[children[at - 1]].box().area() > area; --at) children[at] = children[at - 1];
      children[at] = child;
    }
  }

  /// `child` is a node of the builder's tree, or leafBit for none.
  HD void set(WideNode& node, uint32_t k, uint32_t child) const {
    const bool absent = child == TraversalNode::leafBit;
    const Box box = absent ? Box{} : from[child].box();
    for (int axis = 0; axis < 3; ++axis) {
      node.planes[axis][k] = box.lo[axis];
      node.planes[3 + axis][k] = box.hi[axis];
    }
    node.child[k] = absent                 ? child
                    : from[child].isLeaf() ? TraversalNode::leafBit | from[child].first()
                    : isWide(child)        ? WideNode::bit | wideNumber[child]
                                           : number[child];
  }
};

}  // namespace

Buffer<WideNode> wideNodes(const Device& device, const Bvh& bvh, const uint32_t* number) {
  if (bvh.joints.empty() || bvh.nodeCount < 2) return {};
  if (bvh.arity > WideNode::width)
    throw InputError("a tree whose nodes have more than eight children cannot be traversed");
  if (bvh.nodeCount / 2 >= WideNode::bit) throw InputError("a tree of 2^29 wide nodes or more cannot be traversed");
  Buffer<uint32_t> wideNumber(device, bvh.nodeCount), count(device, 1);
  launch(device, "mark wide nodes", bvh.nodeCount, MarkWide{bvh.nodes.data(), bvh.joints.data(), wideNumber.data()});
  exclusiveScan(device, "number wide nodes", bvh.nodeCount, wideNumber.data(), wideNumber.data(), count.data());
  const uint32_t wideCount = count.read(0);
  Buffer<WideNode> nodes(device, wideCount);
  launch(device, "gather children", bvh.nodeCount,
         GatherChildren{bvh.nodes.data(), bvh.joints.data(), number, wideNumber.data(), bvh.nodeCount, wideCount,
                        nodes.data()});
  return nodes;
}

}  // namespace copse
