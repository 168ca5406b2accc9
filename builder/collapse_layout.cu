// The last two stages of every build: which subtrees become leaves, and where nodes and triangles lie in memory.
// Leaves are chosen bottom-up; then the tree is written level by level, siblings side by side, so that each level is
// one scan and one launch and the result does not depend on threads. O(n) in all.
#include "builder/build.h"
#include "builder/parallel/atomics.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace {

constexpr uint32_t noParent = 0xffffffffu;

/// What is below a node of the tree that came in.
struct Subtree {
  uint32_t parent;
  float cost;           ///< SAH cost of the best way to store it, times the root's area.
  uint32_t primitives;
  uint32_t leaves;      ///< Leaves that it keeps: 1 where it becomes one. On an inner node that waits for its
                        ///< children it counts those that have arrived.
};

struct LinkParents {
  const BvhNode* nodes;
  Subtree* subtrees;

  HD void operator()(uint32_t i) const {
    subtrees[i].leaves = 0;
    if (i == 0) subtrees[0].parent = noParent;
    if (nodes[i].isLeaf()) return;
    subtrees[nodes[i].left].parent = i;
    subtrees[nodes[i].right].parent = i;
  }
};

struct ChooseLeaves {
  const BvhNode* nodes;
  Subtree* subtrees;
  float traversal, intersection;
  uint32_t leafMax;
  bool byCount;  ///< leaf.rule = count

  HD void operator()(uint32_t i) const {
    const BvhNode leaf = nodes[i];
    if (!leaf.isLeaf()) return;
    Subtree* subtree = subtrees + i;
    subtree->cost = intersection * leaf.box().area() * static_cast<float>(leaf.count());
    subtree->primitives = leaf.count();
    subtree->leaves = 1;
    for (uint32_t at = subtree->parent; at != noParent; at = subtree->parent) {
      subtree = subtrees + at;
      if (atomicAddAcqRel(&subtree->leaves, 1u) == 0) return;  // The second to come has both children's results.
      const BvhNode node = nodes[at];
      const Subtree left = subtrees[node.left], right = subtrees[node.right];
      const float area = node.box().area();
      const float asTree = traversal * area + left.cost + right.cost;
      subtree->primitives = left.primitives + right.primitives;
      const float asLeaf = intersection * area * static_cast<float>(subtree->primitives);
      const bool becomesLeaf = subtree->primitives <= leafMax && (byCount || asLeaf < asTree);
      subtree->cost = becomesLeaf ? asLeaf : asTree;
      subtree->leaves = becomesLeaf ? 1 : left.leaves + right.leaves;
    }
  }
};

/// Where a node of the new tree comes from, and the place of its first triangle in the new order.
struct Place {
  uint32_t source, first;
};

struct PlaceRoot {
  const Subtree* subtrees;
  Place* places;
  uint32_t* inner;

  HD void operator()(uint32_t) const {
    places[0] = {0, 0};
    inner[0] = subtrees[0].leaves > 1;
  }
};

struct WriteLevel {
  const BvhNode* nodes;
  const uint32_t* order;
  const Subtree* subtrees;
  Place* places;
  uint32_t* inner;  ///< This level's: inner nodes before it on the level. The next level's: 1 for an inner node.
  BvhNode* newNodes;
  uint32_t* newOrder;
  uint32_t begin, end;  ///< The level's nodes.

  HD void operator()(uint32_t i) const {
    const uint32_t at = begin + i;
    const Place place = places[at];
    const BvhNode node = nodes[place.source];
    const Subtree subtree = subtrees[place.source];
    if (subtree.leaves == 1) {
      newNodes[at] = BvhNode::leaf(node.box(), place.first, subtree.primitives);
      gather(node, newOrder + place.first);
      return;
    }
    const uint32_t left = end + 2 * inner[at], right = left + 1;
    newNodes[at] = BvhNode::inner(node.box(), left, right);
    places[left] = {node.left, place.first};
    places[right] = {node.right, place.first + subtrees[node.left].primitives};
    inner[left] = subtrees[node.left].leaves > 1;
    inner[right] = subtrees[node.right].leaves > 1;
  }

  /// The primitives below `node`, ascending.
  HD void gather(BvhNode node, uint32_t* to) const {
    uint32_t waiting[maxLeafSize];  // One of them has a primitive at least, so they are never more than that.
    uint32_t waitingCount = 0, found = 0;
    for (;;) {
      if (!node.isLeaf()) {
        waiting[waitingCount++] = node.right;
        node = nodes[node.left];
        continue;
      }
      for (uint32_t k = 0; k < node.count(); ++k) {
        const uint32_t primitive = order[node.first() + k];
        uint32_t at = found++;
        for (; at > 0 && to[at - 1] > primitive; --at) to[at] = to[at - 1];
        to[at] = primitive;
      }
      if (waitingCount == 0) return;
      node = nodes[waiting[--waitingCount]];
    }
  }
};

Buffer<Subtree> chooseLeaves(const Device& device, const Bvh& tree, const Parameters& parameters) {
  Phase phase(device, "collapse");
  Buffer<Subtree> subtrees(device, tree.nodeCount);
  launch(device, "link parents", tree.nodeCount, LinkParents{tree.nodes.data(), subtrees.data()});
  launch(device, "choose leaves", tree.nodeCount,
         ChooseLeaves{tree.nodes.data(), subtrees.data(), static_cast<float>(parameters.real("sah.traversal")),
                      static_cast<float>(parameters.real("sah.intersection")),
                      static_cast<uint32_t>(parameters.integer("leaf.max")), parameters.text("leaf.rule") == "count"});
  return subtrees;
}

}  // namespace

Bvh collapseAndLayout(const Device& device, Bvh tree, const Parameters& parameters) {
  if (tree.nodeCount == 0) return tree;
  const Buffer<Subtree> subtrees = chooseLeaves(device, tree, parameters);

  Phase phase(device, "layout");
  Bvh bvh;
  bvh.primitiveCount = tree.primitiveCount;
  bvh.nodeCount = 2 * subtrees.read(0).leaves - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  bvh.order = Buffer<uint32_t>(device, tree.primitiveCount);
  Buffer<Place> places(device, bvh.nodeCount);
  Buffer<uint32_t> inner(device, bvh.nodeCount), innerOfLevel(device, 1);
  launch(device, "place root", 1, PlaceRoot{subtrees.data(), places.data(), inner.data()});
  for (uint32_t begin = 0, end = 1; begin < end;) {
    const uint32_t count = end - begin;
    exclusiveScan(device, "rank level", count, inner.data() + begin, inner.data() + begin, innerOfLevel.data());
    launch(device, "write level", count,
           WriteLevel{tree.nodes.data(), tree.order.data(), subtrees.data(), places.data(), inner.data(),
                      bvh.nodes.data(), bvh.order.data(), begin, end},
           256);
    begin = end;
    end += 2 * innerOfLevel.read(0);
  }
  return bvh;
}

}  // namespace copse
