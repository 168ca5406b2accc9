// Parents and boxes of a tree whose topology is known: a launch each. Boxes are fitted bottom-up, one thread per leaf.
#include "builder/bottom_up.h"
#include "builder/open_tree.h"
#include "builder/parallel/launch.h"
#include "builder/phases.h"

namespace copse {

namespace {

struct LinkParents {
  const BvhNode* nodes;
  uint32_t* parents;

  HD void operator()(uint32_t i) const {
    if (i == 0) parents[0] = ParentLinks::none;
    if (nodes[i].isLeaf()) return;
    parents[nodes[i].left] = i;
    parents[nodes[i].right] = i;
  }
};

struct FitBoxes {
  BvhNode* nodes;
  ParentLinks parents;
  const uint32_t* order;
  const Box* boxes;  ///< Null where leaves keep theirs.
  uint32_t firstLeaf;

  static constexpr uint32_t prefetchDistance = 16;  ///< In leaves.

  HD void operator()(uint32_t index) const {
    const uint32_t i = firstLeaf + index;
    prefetch(nodes + i + prefetchDistance);
    prefetch(parents.words + i + 4 * prefetchDistance);
    prefetchForStore(nodes + index + prefetchDistance);  // Inner nodes often stand as their leaves do.
    if (!nodes[i].isLeaf()) return;
    if (boxes) set(nodes[i], boxOf(nodes[i]));
    uint32_t at = parents.ofLeaf(i), parent;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent)
      set(nodes[at], unite(nodes[nodes[at].left].box(), nodes[nodes[at].right].box()));
  }

  HD Box boxOf(const BvhNode& leaf) const {
    Box all;
    for (uint32_t k = 0; k < leaf.count(); ++k) all.grow(boxes[order[leaf.first() + k]]);
    return all;
  }
  /// Links are left alone: other threads may be reading them.
  HD static void set(BvhNode& node, const Box& box) {
    node.lo = box.lo;
    node.hi = box.hi;
  }
};

Buffer<uint32_t> parentsOf(const Device& device, const Buffer<BvhNode>& nodes, uint32_t count, std::size_t room) {
  Buffer<uint32_t> parents(device, room);
  launch(device, "link parents", count, LinkParents{nodes.data(), parents.data()});
  return parents;
}

}  // namespace

void linkParents(const Device& device, OpenTree& tree) {
  if (tree.nodeCount == 0 || tree.parents.size() > tree.innerEnd()) return;
  tree.parents = parentsOf(device, tree.nodes, tree.nodeCount, std::size_t{tree.nodeCount} + 1);
}

void linkParents(const Device& device, Bvh& bvh) {
  if (bvh.nodeCount == 0 || !bvh.parents.empty()) return;
  bvh.parents = parentsOf(device, bvh);
}

Buffer<uint32_t> parentsOf(const Device& device, const Bvh& bvh) {
  return parentsOf(device, bvh.nodes, bvh.nodeCount, bvh.nodeCount);
}

void fit(const Device& device, OpenTree& tree, const Box* boxes) {
  Phase phase(device, phases::fit);
  linkParents(device, tree);
  launch(device, "fit boxes", tree.nodeCount - tree.firstLeaf,
         FitBoxes{tree.nodes.data(), {tree.parents.data()}, tree.order.data(), boxes, tree.firstLeaf});
}

void fit(const Device& device, Bvh& bvh, const Box* boxes) {
  Phase phase(device, phases::fit);
  linkParents(device, bvh);
  launch(device, "fit boxes", bvh.nodeCount,
         FitBoxes{bvh.nodes.data(), {bvh.parents.data()}, bvh.order.data(), boxes, 0});
}

}  // namespace copse
