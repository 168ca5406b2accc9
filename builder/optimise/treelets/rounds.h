// The walk that the treelet methods share: bottom-up, so that both children of a node are done before it, and each node
// of enough triangles is the root of one treelet per round. What becomes of a node depends on its subtree alone, on no
// order of threads. Karras and Aila: Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (2013).
// A round is O(n / gamma) treelets and two streaming passes over the nodes. Only .cu files include this.
#pragma once

#include "builder/open_tree.h"
#include "builder/optimise/treelets/treelet.h"
#include "builder/parallel/one_lane.h"
#include "builder/parallel/primitives.h"
#include "builder/phases.h"

namespace copse::treelets {

/// Boxes, costs and counts of all nodes, from a leaf up. fit() alone would leave costs and counts to a second pass.
struct FitNodes {
  Tree tree;

  HD void operator()(uint32_t index) const {
    const uint32_t i = tree.firstLeaf + index;
    const BvhNode& leaf = tree.nodes[i];  // Not a copy: an inner node's box may be written just now.
    if (!leaf.isLeaf()) return;
    const uint32_t leafCount = leaf.count();
    tree.subtrees[i] = {tree.costs.ofLeaf(leaf.box().area(), leafCount), leafCount};
    uint32_t at = tree.parents.ofLeaf(i), parent;
    for (; at != ParentLinks::none && tree.parents.secondAt(at, parent); at = parent) {
      BvhNode& node = tree.nodes[at];
      const BvhNode leftNode = tree.nodes[node.left], rightNode = tree.nodes[node.right];
      const Subtree left = tree.subtrees[node.left], right = tree.subtrees[node.right];
      const Box box = unite(leftNode.box(), rightNode.box());
      const uint32_t count = left.count + right.count;
      node.lo = box.lo;
      node.hi = box.hi;
      tree.subtrees[at] = {tree.costs.ofSubtree(box.area(), count, left.cost + right.cost), count};
    }
  }
};

/// The walk of a round starts at nodes that are too small for a treelet, or leaves, while their parents are not. Places
/// are nodes, but where all inner nodes stand first leaf i and inner node i have the places 2i and 2i + 1, near each
/// other as they mostly are in space.
struct MarkStarts {
  Tree tree;
  uint32_t gamma;
  uint32_t* flags;

  HD static uint32_t nodeAt(const Tree& tree, uint32_t place) {
    if (!tree.isInnerFirst) return place;
    return place % 2 ? place / 2 : tree.firstLeaf + place / 2;
  }
  HD void operator()(uint32_t place) const {
    const uint32_t at = nodeAt(tree, place);
    const uint32_t parent = tree.parents.words[at];
    flags[place] = parent != ParentLinks::none && tree.subtrees[parent].count >= gamma &&
                   (tree.subtrees[at].count < gamma || (tree.hasLargeLeaves && tree.nodes[at].isLeaf()));
  }
};

/// A lane takes a start, and where there are more starts than lanes another one after it. Where two meet at a node the
/// second goes on, and all lanes restructure its treelet.
template <class Method>
struct RestructureAbove {
  Tree tree;
  const uint32_t* starts;
  const uint32_t* startCount;
  uint32_t laneCount;  ///< In the launch.
  Method method;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    const uint32_t count = *startCount;
    for (uint32_t first = index * Lanes::size; first < count; first += laneCount) {
      const uint32_t i = first + lanes.lane();
      walk(lanes, i < count ? tree.parents.words[MarkStarts::nodeAt(tree, starts[i])] : ParentLinks::none);
    }
  }

  template <class Lanes>
  HD void walk(Lanes& lanes, uint32_t at) const {
    bool walking = at != ParentLinks::none;
    while (lanes.any(walking)) {
      uint32_t parent = ParentLinks::none;
      walking = walking && tree.parents.secondAt(at, parent);
      if (walking) tree.subtrees[at].cost = tree.costFromChildren(at);
      for (uint32_t due = lanes.ballot(walking); due; due &= due - 1)
        method.restructure(lanes, tree, lanes.shfl(at, lowestBit(due)));
      lanes.sync();  // What other lanes wrote comes before this lane's next arrival.
      at = parent;
      walking = walking && at != ParentLinks::none;
    }
  }
};

/// `rounds` rounds; gamma, the references that a treelet's root must have below it, starts at `gamma` and doubles. What
/// will be one leaf, whatever is below, is left alone. Leaves the tree with its parents linked and all boxes fitted.
/// `onWarps`: 32 lanes on the CPU too, for tests. It does not wait for the device.
template <class Method>
void restructure(const Device& device, OpenTree& open, const LeafRule& costs, const Method& method, int rounds,
                 uint32_t gamma, bool onWarps = false) {
  const uint32_t n = open.referenceCount, places = open.nodeCount;
  if (places < 5) return;  // Fewer than three leaves.
  linkParents(device, open);
  Buffer<Subtree> subtrees(device, places);
  const Tree tree{open.nodes.data(), {open.parents.data()}, subtrees.data(),    places,
                  open.firstLeaf,    open.isInnerFirst(),   places / 2 + 1 < n, costs};
  {
    Phase phase(device, phases::fit);
    launch(device, "fit nodes", places - open.firstLeaf, FitNodes{tree});
  }
  Phase phase(device, phases::treelets);
  Buffer<uint32_t> flags(device, places), starts(device, n), startCount(device, 1);
  for (int round = 0; round < rounds && gamma <= n; ++round, gamma *= 2) {
    const uint32_t minCount = costs.byCount && gamma <= costs.leafMax ? costs.leafMax + 1 : gamma;
    launch(device, "mark starts", places, MarkStarts{tree, minCount, flags.data()});
    compact(device, "gather starts", places, flags.data(), starts.data(), startCount.data());
    // Lanes enough for most trees, so that the host need not wait for the count: it is 1.6 to 1.8 n / minCount there.
    const auto expected = static_cast<uint32_t>(uint64_t{n} * 2 / minCount) + 1;
    const uint32_t warps = (expected - 1) / Warp::size + 1;
    const RestructureAbove<Method> kernel{tree, starts.data(), startCount.data(), warps * Warp::size, method};
    if (onWarps)
      launchWarps(device, "restructure treelets", warps, kernel, method.sharedBytes(false));
    else
      launchLanes(device, "restructure treelets", kernel.laneCount, kernel, method.sharedBytes(!device.isCuda()));
  }
}

}  // namespace copse::treelets
