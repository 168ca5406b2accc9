// The last two stages of every build: which subtrees become leaves, and where nodes and triangles lie in memory.
// Leaves are chosen bottom-up; then the tree is written level by level, siblings side by side, so that each level is
// one scan and one launch and the result does not depend on threads. O(n) in all.
#include "builder/bottom_up.h"
#include "builder/build.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace {

/// What the layout must know of an inner node, in one word: the primitives below its left child, and which of its
/// children become leaves.
struct Split {
  static constexpr uint32_t leftIsLeaf = 0x80000000u, rightIsLeaf = 0x40000000u;

  uint32_t word;

  HD uint32_t leftPrimitives() const { return word & ~(leftIsLeaf | rightIsLeaf); }
};

/// What is below a node of the tree that came in.
struct Subtree {
  float cost;  ///< SAH cost of the best way to store it, times the root's area.
  uint32_t primitives;
  uint32_t leaves;  ///< Leaves that it keeps: 1 where it becomes one.
  Split split;      ///< Of an inner node.
};

/// A leaf of the new tree: its node and its first triangle. They stand at the index of the node that it comes from.
struct LeafPlace {
  uint32_t node, first;
};
constexpr uint32_t nowhere = 0xffffffffu;

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

struct ChooseLeaves {
  const BvhNode* nodes;
  ParentLinks parents;
  Subtree* subtrees;
  float traversal, intersection;
  uint32_t leafMax;
  bool byCount;  ///< leaf.rule = count

  HD void operator()(uint32_t i) const {
    const BvhNode leaf = nodes[i];
    if (!leaf.isLeaf()) return;
    subtrees[i] = {intersection * leaf.box().area() * static_cast<float>(leaf.count()), leaf.count(), 1, {0}};
    uint32_t at = parents.ofLeaf(i), parent;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent) {
      const BvhNode node = nodes[at];
      const Subtree left = subtrees[node.left], right = subtrees[node.right];
      const uint32_t primitives = left.primitives + right.primitives;
      const float area = node.box().area();
      const float asTree = traversal * area + left.cost + right.cost;
      const float asLeaf = intersection * area * static_cast<float>(primitives);
      const bool becomesLeaf = primitives <= leafMax && (byCount || asLeaf < asTree);
      const Split split{left.primitives | (left.leaves == 1 ? Split::leftIsLeaf : 0) |
                        (right.leaves == 1 ? Split::rightIsLeaf : 0)};
      subtrees[at] = {becomesLeaf ? asLeaf : asTree, primitives, becomesLeaf ? 1 : left.leaves + right.leaves, split};
    }
  }
};

/// Where a node of the new tree comes from, and the place of its first triangle in the new order.
struct Place {
  static constexpr uint32_t leafBit = 0x80000000u;

  uint32_t source, first;
};

/// Gives the new tree's node `at` its origin, one level after the other. Leaves are only noted here: to write them in
/// the order of the tree that came in, where what is below them lies close together, is several times faster.
struct PlaceNode {
  LeafPlace* leaves;
  Place* places;
  uint32_t* inner;  ///< 1 for an inner node.

  HD void operator()(uint32_t at, uint32_t source, uint32_t first, bool isLeaf) const {
    if (isLeaf) leaves[source] = {at, first};
    places[at] = {isLeaf ? source | Place::leafBit : source, first};
    inner[at] = !isLeaf;
  }
};

struct PlaceRoot {
  const Subtree* subtrees;
  PlaceNode place;

  HD void operator()(uint32_t) const { place(0, 0, 0, subtrees[0].leaves == 1); }
};

struct WriteLevel {
  const BvhNode* nodes;
  const Subtree* subtrees;
  PlaceNode place;
  const uint32_t* innerBefore;  ///< Inner nodes before each of the level's nodes, on that level.
  BvhNode* newNodes;
  uint32_t begin, end;  ///< The level's nodes.

  HD void operator()(uint32_t i) const {
    const uint32_t at = begin + i;
    if (at + ahead < end) {
      const uint32_t later = place.places[at + ahead].source & ~Place::leafBit;
      prefetch(nodes + later);
      prefetch(subtrees + later);
    }
    const Place here = place.places[at];
    if (here.source & Place::leafBit) return;
    const BvhNode node = nodes[here.source];
    const Split split = subtrees[here.source].split;
    const uint32_t left = end + 2 * innerBefore[i], right = left + 1;
    newNodes[at] = BvhNode::inner(node.box(), left, right);
    place(left, node.left, here.first, split.word & Split::leftIsLeaf);
    place(right, node.right, here.first + split.leftPrimitives(), split.word & Split::rightIsLeaf);
  }

  static constexpr uint32_t ahead = 8;  ///< Nodes between a request for memory and its use.
};

struct WriteLeaf {
  const BvhNode* nodes;
  const uint32_t* order;
  const Subtree* subtrees;
  const LeafPlace* leaves;
  BvhNode* newNodes;
  uint32_t* newOrder;

  HD void operator()(uint32_t i) const {
    const LeafPlace leaf = leaves[i];
    if (leaf.node == nowhere) return;
    newNodes[leaf.node] = BvhNode::leaf(nodes[i].box(), leaf.first, subtrees[i].primitives);
    gather(nodes[i], newOrder + leaf.first);
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

Buffer<Subtree> chooseLeaves(const Device& device, Bvh& tree, const Parameters& parameters) {
  Phase phase(device, "collapse");
  if (tree.parents.empty()) {
    tree.parents = Buffer<uint32_t>(device, tree.nodeCount);
    launch(device, "link parents", tree.nodeCount, LinkParents{tree.nodes.data(), tree.parents.data()});
  }
  Buffer<Subtree> subtrees(device, tree.nodeCount);
  launch(device, "choose leaves", tree.nodeCount,
         ChooseLeaves{tree.nodes.data(),
                      {tree.parents.data()},
                      subtrees.data(),
                      static_cast<float>(parameters.real("sah.traversal")),
                      static_cast<float>(parameters.real("sah.intersection")),
                      static_cast<uint32_t>(parameters.integer("leaf.max")),
                      parameters.text("leaf.rule") == "count"});
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
  Buffer<LeafPlace> leaves(device, tree.nodeCount);
  leaves.fill(0xff);
  const PlaceNode place{leaves.data(), places.data(), inner.data()};
  launch(device, "place root", 1, PlaceRoot{subtrees.data(), place});
  for (uint32_t begin = 0, end = 1; begin < end;) {
    uint32_t* const level = inner.data() + begin;
    exclusiveScan(device, "rank level", end - begin, level, level, innerOfLevel.data());
    launch(device, "write level", end - begin,
           WriteLevel{tree.nodes.data(), subtrees.data(), place, level, bvh.nodes.data(), begin, end});
    begin = end;
    end += 2 * innerOfLevel.read(0);
  }
  launch(device, "write leaves", tree.nodeCount,
         WriteLeaf{tree.nodes.data(), tree.order.data(), subtrees.data(), leaves.data(), bvh.nodes.data(),
                   bvh.order.data()});
  return bvh;
}

}  // namespace copse
