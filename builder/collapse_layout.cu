// The last two stages of every build: which subtrees become leaves, and where nodes and triangles lie in memory.
// Boxes are fitted and leaves chosen in one bottom-up pass; then the tree is written level by level, siblings side by
// side, so that each level is one scan and one launch and the result does not depend on threads. O(n) in all.
#include "builder/bottom_up.h"
#include "builder/build.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace {

/// What is below a node of the tree that came in.
struct Subtree {
  static constexpr uint32_t scattered = 0xffffffffu;

  float cost;  ///< SAH cost of the best way to store it, times the root's area.
  uint32_t primitives;
  uint32_t leaves;  ///< Leaves that it keeps: 1 where it becomes one.
  /// Of what becomes a leaf: where its primitives stand in the order, ascending; or `scattered` where they are not side
  /// by side. Otherwise the primitives below the left child.
  uint32_t place;

  HD bool isLeaf() const { return leaves == 1; }
};

/// What layout must know of the nodes that stay stands in the nodes themselves, so that it reads one place a node,
/// which lies anywhere: links to children that become leaves are marked, and what becomes a leaf is one already, but
/// where its primitives are scattered. Node indices leave the bits free: buildBvh() takes no more triangles.
struct Marks {
  static constexpr uint32_t leftIsLeaf = 0x80000000u, rightIsLeaf = 0x40000000u;
  static constexpr uint32_t became = 0x40000000u;  ///< Of a leaf's `right`: the node was none before.

  HD static uint32_t left(const BvhNode& node) { return node.left & ~leftIsLeaf; }
  HD static uint32_t right(const BvhNode& node) { return node.right & ~rightIsLeaf; }
  HD static uint32_t count(const BvhNode& leaf) { return leaf.count() & ~became; }
  HD static bool isLeafFromTheStart(uint32_t right) {
    return (right & (BvhNode::leafBit | became)) == BvhNode::leafBit;
  }
};

/// Where the primitives of two neighbouring leaves stand that become one.
HD inline uint32_t joinedPlace(const Subtree& left, const Subtree& right) {
  const bool known =
      left.isLeaf() && right.isLeaf() && left.place != Subtree::scattered && right.place != Subtree::scattered;
  if (known && left.place + left.primitives == right.place) return left.place;
  if (known && right.place + right.primitives == left.place) return right.place;
  return Subtree::scattered;
}

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

/// Puts `primitive` into the `count` ascending ones at `to`.
HD inline void insertSorted(uint32_t* to, uint32_t count, uint32_t primitive) {
  uint32_t at = count;
  for (; at > 0 && to[at - 1] > primitive; --at) to[at] = to[at - 1];
  to[at] = primitive;
}

struct ChooseLeaves {
  BvhNode* nodes;
  uint32_t* order;
  ParentLinks parents;
  const uint8_t* joints;  ///< Null where there are none.
  Subtree* subtrees;
  uint32_t* anyScattered;
  float traversal, intersection;
  uint32_t leafMax;
  bool byCount;  ///< leaf.rule = count
  uint32_t firstLeaf;

  static constexpr uint32_t ahead = 16;  ///< Leaves between a request for memory and its use.

  HD void operator()(uint32_t index) const {
    const uint32_t i = firstLeaf + index;
    prefetch(nodes + i + ahead);
    prefetch(parents.words + i + 4 * ahead);
    prefetchForStore(subtrees + i + 2 * ahead);
    // Where leaf i is the i-th of the order, the walk soon comes to inner nodes beside the i-th.
    prefetchForStore(nodes + index + ahead);
    prefetchForStore(parents.words + index + 4 * ahead);
    prefetchForStore(subtrees + index + 2 * ahead);
    const BvhNode& leaf = nodes[i];  // Not a copy: an inner node may be written just now.
    if (!Marks::isLeafFromTheStart(atomicLoadRelaxed(&nodes[i].right))) return;
    const float cost = intersection * leaf.box().area() * static_cast<float>(leaf.count());
    for (uint32_t k = 1; k < leaf.count(); ++k) insertSorted(order + leaf.first(), k, order[leaf.first() + k]);
    subtrees[i] = {cost, leaf.count(), 1, leaf.first()};
    uint32_t at = parents.ofLeaf(i), parent;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent) join(at);
  }

  HD void join(uint32_t at) const {
    BvhNode& node = nodes[at];
    const Box box = unite(nodes[node.left].box(), nodes[node.right].box());
    const Subtree left = subtrees[node.left], right = subtrees[node.right];
    node.lo = box.lo;
    node.hi = box.hi;
    const uint32_t primitives = left.primitives + right.primitives;
    const float area = box.area();
    const bool isJoint = joints && joints[at];
    const float asTree = (isJoint ? 0 : traversal * area) + left.cost + right.cost;
    const float asLeaf = intersection * area * static_cast<float>(primitives);
    if (!isJoint && primitives <= leafMax && (byCount || asLeaf < asTree)) {
      const uint32_t place = joinedPlace(left, right);
      subtrees[at] = {asLeaf, primitives, 1, place};
      if (place == Subtree::scattered) return atomicStoreRelease(anyScattered, 1u);
      merge(order + place, place == left.place ? left.primitives : right.primitives, primitives);
      node.left = place;
      atomicStoreRelaxed(&node.right, primitives | Marks::became | BvhNode::leafBit);
    } else {
      subtrees[at] = {asTree, primitives, left.leaves + right.leaves, left.primitives};
      if (left.isLeaf()) node.left |= Marks::leftIsLeaf;
      if (right.isLeaf()) atomicStoreRelaxed(&node.right, node.right | Marks::rightIsLeaf);
    }
  }

  /// The first `sorted` ascend, and so does the rest.
  HD static void merge(uint32_t* primitives, uint32_t sorted, uint32_t count) {
    for (; sorted < count && primitives[sorted] < primitives[sorted - 1]; ++sorted)
      insertSorted(primitives, sorted, primitives[sorted]);
  }
};

/// The nodes of the new tree, level by level.
struct Origins {
  static constexpr uint32_t leafBit = 0x80000000u;

  uint32_t* sources;  ///< The node that each comes from, marked where it becomes a leaf.
  uint32_t* inner;    ///< Of the level at hand: inner nodes before it on the level. Of the next: 1 for an inner node.
  uint32_t* firsts;   ///< Its first triangle's place in the new order; null where the order stays.

  HD void start(uint32_t at, uint32_t source, bool isLeaf) const {
    sources[at] = isLeaf ? source | leafBit : source;
    inner[at] = !isLeaf;
  }
};

struct StartAtRoot {
  const Subtree* subtrees;
  Origins origins;

  HD void operator()(uint32_t) const {
    origins.start(0, 0, subtrees[0].isLeaf());
    if (origins.firsts) origins.firsts[0] = 0;
  }
};

struct WriteLevel {
  const BvhNode* nodes;
  const uint32_t* order;
  const Subtree* subtrees;
  Origins origins;
  BvhNode* newNodes;
  uint32_t* newOrder;  ///< Null where no leaf's primitives are scattered: then they stay where they are.
  const uint8_t* joints;
  uint8_t* newJoints;   ///< Null where there are no joints.
  uint32_t begin, end;  ///< The level's nodes.

  static constexpr uint32_t ahead = 16;  ///< Nodes between a request for memory, which may lie anywhere, and its use.

  HD void operator()(uint32_t i) const {
    const uint32_t at = begin + i;
    if (at + ahead < end) prefetch(nodes + (origins.sources[at + ahead] & ~Origins::leafBit));
    const uint32_t source = origins.sources[at] & ~Origins::leafBit;
    const bool isLeaf = origins.sources[at] & Origins::leafBit;
    const BvhNode node = nodes[source];
    if (newJoints) newJoints[at] = joints[source];
    const uint32_t left = end + 2 * origins.inner[at], right = left + 1;
    if (newOrder) {
      const Subtree subtree = subtrees[source];
      const uint32_t first = origins.firsts[at];
      if (isLeaf) {
        newNodes[at] = BvhNode::leaf(node.box(), first, subtree.primitives);
        return gather(node, newOrder + first);
      }
      origins.firsts[left] = first;
      origins.firsts[right] = first + subtree.place;
    } else if (isLeaf) {
      newNodes[at] = BvhNode::leaf(node.box(), node.first(), Marks::count(node));
      return;
    }
    newNodes[at] = BvhNode::inner(node.box(), left, right);
    origins.start(left, Marks::left(node), node.left & Marks::leftIsLeaf);
    origins.start(right, Marks::right(node), node.right & Marks::rightIsLeaf);
  }

  /// The primitives below `node`, ascending.
  HD void gather(BvhNode node, uint32_t* to) const {
    uint32_t waiting[maxLeafSize];  // One of them has a primitive at least, so they are never more than that.
    uint32_t waitingCount = 0, found = 0;
    for (;;) {
      if (!node.isLeaf()) {
        waiting[waitingCount++] = Marks::right(node);
        node = nodes[Marks::left(node)];
        continue;
      }
      for (uint32_t k = 0; k < Marks::count(node); ++k) insertSorted(to, found++, order[node.first() + k]);
      if (waitingCount == 0) return;
      node = nodes[waiting[--waitingCount]];
    }
  }
};

struct Choice {
  Buffer<Subtree> subtrees;
  bool anyScattered;  ///< A leaf's primitives are not side by side in the order.
};

Choice chooseLeaves(const Device& device, Bvh& tree, const Parameters& parameters) {
  Phase phase(device, "collapse");
  if (tree.parents.empty()) {
    tree.parents = Buffer<uint32_t>(device, tree.nodeCount);
    launch(device, "link parents", tree.nodeCount, LinkParents{tree.nodes.data(), tree.parents.data()});
  }
  Buffer<Subtree> subtrees(device, tree.nodeCount);
  Buffer<uint32_t> anyScattered(device, 1);
  anyScattered.fill(0);
  launch(device, "choose leaves", tree.nodeCount - tree.firstLeaf,
         ChooseLeaves{tree.nodes.data(),
                      tree.order.data(),
                      {tree.parents.data()},
                      tree.joints.data(),
                      subtrees.data(),
                      anyScattered.data(),
                      static_cast<float>(parameters.real("sah.traversal")),
                      static_cast<float>(parameters.real("sah.intersection")),
                      static_cast<uint32_t>(parameters.integer("leaf.max")),
                      parameters.text("leaf.rule") == "count",
                      tree.firstLeaf});
  return {std::move(subtrees), anyScattered.read(0) != 0};
}

}  // namespace

Bvh collapseAndLayout(const Device& device, Bvh tree, const Parameters& parameters) {
  if (tree.nodeCount == 0) return tree;
  const auto [subtrees, anyScattered] = chooseLeaves(device, tree, parameters);

  Phase phase(device, "layout");
  Bvh bvh;
  bvh.primitiveCount = tree.primitiveCount;
  bvh.arity = tree.arity;
  bvh.nodeCount = 2 * subtrees.read(0).leaves - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  if (anyScattered) bvh.order = Buffer<uint32_t>(device, tree.primitiveCount);
  if (!tree.joints.empty()) bvh.joints = Buffer<uint8_t>(device, bvh.nodeCount);
  Buffer<uint32_t> sources(device, bvh.nodeCount), inner(device, bvh.nodeCount), innerOfLevel(device, 1);
  Buffer<uint32_t> firsts(device, anyScattered ? bvh.nodeCount : 0);
  const Origins origins{sources.data(), inner.data(), firsts.data()};
  launch(device, "start at root", 1, StartAtRoot{subtrees.data(), origins});
  for (uint32_t begin = 0, end = 1; begin < end;) {
    uint32_t* const level = inner.data() + begin;
    exclusiveScan(device, "rank level", end - begin, level, level, innerOfLevel.data());
    launch(device, "write level", end - begin,
           WriteLevel{tree.nodes.data(), tree.order.data(), subtrees.data(), origins, bvh.nodes.data(),
                      bvh.order.data(), tree.joints.data(), bvh.joints.data(), begin, end});
    begin = end;
    end += 2 * innerOfLevel.read(0);
  }
  if (!anyScattered) bvh.order = std::move(tree.order);
  return bvh;
}

}  // namespace copse
