// The last two stages of every build: which subtrees become leaves, and where nodes and triangles lie in memory.
// Boxes are fitted and leaves chosen in one bottom-up pass; then the nodes are numbered level by level, siblings side
// by side, and written. The result does not depend on threads. O(n) in all, one launch each and one wait between them.
#include "builder/bottom_up.h"
#include "builder/build.h"
#include "builder/parallel/breadth_first.h"
#include "builder/parallel/launch.h"

namespace copse {

namespace {

/// What is below a node of the tree that came in. Kept for nodes that are no leaves; of a leaf it follows from the
/// node itself, which spares writing and reading as much as the nodes of the leaves have.
struct alignas(16) Subtree {
  static constexpr uint32_t scattered = 0xffffffffu;

  float cost;  ///< SAH cost of the best way to store it, times the root's area.
  uint32_t primitives;
  uint32_t leaves;  ///< Leaves that it keeps: 1 where it becomes one.
  uint32_t place;   ///< Where its primitives stand in the order; or `scattered` where they are not side by side.

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

/// Where the primitives of two siblings stand together.
HD inline uint32_t joinedPlace(const Subtree& left, const Subtree& right) {
  const bool known = left.place != Subtree::scattered && right.place != Subtree::scattered;
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

/// What the host must know before layout: one wait.
struct Summary {
  uint32_t anyScattered;  ///< Not 0: a leaf's primitives are not side by side in the order.
  uint32_t leaves;        ///< Of the whole tree.
};

struct ChooseLeaves {
  BvhNode* nodes;
  uint32_t* order;
  ParentLinks parents;
  const uint8_t* joints;  ///< Null where there are none.
  Subtree* subtrees;
  Summary* summary;
  float traversal, intersection;
  uint32_t leafMax;
  bool byCount;  ///< leaf.rule = count
  uint32_t firstLeaf;

  static constexpr uint32_t ahead = 16;  ///< Leaves between a request for memory and its use.

  HD void operator()(uint32_t index) const {
    const uint32_t i = firstLeaf + index;
    prefetch(nodes + i + ahead);
    prefetch(parents.words + i + 4 * ahead);
    // Where leaf i is the i-th of the order, the walk soon comes to inner nodes beside the i-th.
    prefetchForStore(nodes + index + ahead);
    prefetchForStore(parents.words + index + 4 * ahead);
    prefetchForStore(subtrees + index + 2 * ahead);
    const BvhNode& leaf = nodes[i];  // Not a copy: an inner node may be written just now.
    if (!Marks::isLeafFromTheStart(atomicLoadRelaxed(&nodes[i].right))) return;
    for (uint32_t k = 1; k < leaf.count(); ++k) insertSorted(order + leaf.first(), k, order[leaf.first() + k]);
    if (i == 0) summary->leaves = 1;
    uint32_t at = parents.ofLeaf(i), parent;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent) join(at);
  }

  /// Of a leaf what follows from it, of any other node what join() kept.
  HD Subtree subtree(uint32_t at) const {
    const BvhNode& node = nodes[at];
    if (!node.isLeaf()) return subtrees[at];
    const uint32_t count = Marks::count(node);
    return {intersection * node.box().area() * static_cast<float>(count), count, 1, node.first()};
  }

  HD void join(uint32_t at) const {
    BvhNode& node = nodes[at];
    const Box box = unite(nodes[node.left].box(), nodes[node.right].box());
    const Subtree left = subtree(node.left), right = subtree(node.right);
    node.lo = box.lo;
    node.hi = box.hi;
    const uint32_t primitives = left.primitives + right.primitives;
    const float area = box.area();
    const bool isJoint = joints && joints[at];
    const float asTree = (isJoint ? 0 : traversal * area) + left.cost + right.cost;
    const float asLeaf = intersection * area * static_cast<float>(primitives);
    const uint32_t place = joinedPlace(left, right);
    if (!isJoint && primitives <= leafMax && (byCount || asLeaf < asTree)) {
      if (place == Subtree::scattered) {
        subtrees[at] = {asLeaf, primitives, 1, place};
        atomicStoreRelaxed(&summary->anyScattered, 1u);
      } else {
        if (left.isLeaf() && right.isLeaf())
          merge(order + place, place == left.place ? left.primitives : right.primitives, primitives);
        else
          for (uint32_t k = 1; k < primitives; ++k) insertSorted(order + place, k, order[place + k]);
        node.left = place;
        atomicStoreRelaxed(&node.right, primitives | Marks::became | BvhNode::leafBit);
      }
    } else {
      subtrees[at] = {asTree, primitives, left.leaves + right.leaves, place};
      if (left.isLeaf()) node.left |= Marks::leftIsLeaf;
      if (right.isLeaf()) atomicStoreRelaxed(&node.right, node.right | Marks::rightIsLeaf);
    }
    if (at == 0) summary->leaves = node.isLeaf() ? 1 : subtrees[0].leaves;
  }

  /// The first `sorted` ascend, and so does the rest.
  HD static void merge(uint32_t* primitives, uint32_t sorted, uint32_t count) {
    for (; sorted < count && primitives[sorted] < primitives[sorted - 1]; ++sorted)
      insertSorted(primitives, sorted, primitives[sorted]);
  }
};

/// The new tree, node by node, as breadthFirst() asks for it.
struct NewTree {
  /// A node that stays.
  struct Item {
    static constexpr uint32_t leafBit = 0x80000000u;

    uint32_t source;  ///< Where it is in the old tree, marked where it becomes a leaf.
    uint32_t first;   ///< Its first triangle's place in the new order, where the order does not stay.
  };

  const BvhNode* nodes;
  const uint32_t* order;
  const Subtree* subtrees;
  BvhNode* newNodes;
  uint32_t* newOrder;  ///< Null where no leaf's primitives are scattered: then they stay where they are.
  const uint8_t* joints;
  uint8_t* newJoints;  ///< Null where there are no joints.

  HD static Item item(uint32_t source, bool isLeaf, uint32_t first) {
    return {isLeaf ? source | Item::leafBit : source, first};
  }
  HD static uint32_t sourceOf(const Item& item) { return item.source & ~Item::leafBit; }

  HD static bool isInner(const Item& item) { return !(item.source & Item::leafBit); }
  uint32_t leaves(const Item& item) const { return isInner(item) ? subtrees[sourceOf(item)].leaves : 1; }
  HD void prefetchNode(const Item& item) const { prefetch(nodes + sourceOf(item)); }

  HD void children(const Item& item, Item& left, Item& right) const {
    split(nodes[sourceOf(item)], item.first, left, right);
  }

  /// Where the order stays, without a branch on what the item is, which cannot be foreseen. The words are stored one by
  /// one: a node changed on the stack and then copied would make the copy wait for the changes.
  HD void write(const Item& item, uint32_t at, uint32_t firstChild, Item& left, Item& right) const {
    const uint32_t source = sourceOf(item);
    const BvhNode& node = nodes[source];
    const bool inner = isInner(item);
    uint32_t leafFirst = node.left, leafCount = Marks::count(node);
    if (newOrder && !inner) {
      leafFirst = item.first;
      leafCount = primitivesOf(source);
      gather(node, newOrder + item.first);
    }
    split(node, item.first, left, right);
    if (newJoints) newJoints[at] = joints[source];
    prefetchForStore(newNodes + at + ahead);
    newNodes[at] = {node.lo, inner ? firstChild : leafFirst, node.hi,
                    inner ? firstChild + 1 : leafCount | BvhNode::leafBit};
  }

  static constexpr uint32_t ahead = 16;  ///< Nodes between a request for memory and its use.

  /// The children of `node`, whose first triangle's place is `first`; of a leaf, which has none, anything.
  HD void split(const BvhNode& node, uint32_t first, Item& left, Item& right) const {
    left = item(Marks::left(node), node.left & Marks::leftIsLeaf, first);
    const uint32_t toTheLeft = newOrder && !node.isLeaf() ? primitivesOf(sourceOf(left)) : 0;
    right = item(Marks::right(node), node.right & Marks::rightIsLeaf, first + toTheLeft);
  }

  HD uint32_t primitivesOf(uint32_t source) const {
    const BvhNode& node = nodes[source];
    return node.isLeaf() ? Marks::count(node) : subtrees[source].primitives;
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

Buffer<Subtree> chooseLeaves(const Device& device, Bvh& tree, const Parameters& parameters, Summary& summary) {
  Phase phase(device, "collapse");
  if (tree.parents.empty()) {
    tree.parents = Buffer<uint32_t>(device, tree.nodeCount);
    launch(device, "link parents", tree.nodeCount, LinkParents{tree.nodes.data(), tree.parents.data()});
  }
  Buffer<Subtree> subtrees(device, tree.nodeCount);
  Buffer<Summary> found(device, 1);
  found.fill(0);
  launch(device, "choose leaves", tree.nodeCount - tree.firstLeaf,
         ChooseLeaves{tree.nodes.data(),
                      tree.order.data(),
                      {tree.parents.data()},
                      tree.joints.data(),
                      subtrees.data(),
                      found.data(),
                      static_cast<float>(parameters.real("sah.traversal")),
                      static_cast<float>(parameters.real("sah.intersection")),
                      static_cast<uint32_t>(parameters.integer("leaf.max")),
                      parameters.text("leaf.rule") == "count",
                      tree.firstLeaf});
  summary = found.read(0);
  return subtrees;
}

}  // namespace

Bvh collapseAndLayout(const Device& device, Bvh tree, const Parameters& parameters) {
  if (tree.nodeCount == 0) return tree;
  Summary summary;
  const Buffer<Subtree> subtrees = chooseLeaves(device, tree, parameters, summary);

  Phase phase(device, "layout");
  Bvh bvh;
  bvh.primitiveCount = tree.primitiveCount;
  bvh.arity = tree.arity;
  bvh.nodeCount = 2 * summary.leaves - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  if (summary.anyScattered) bvh.order = Buffer<uint32_t>(device, tree.primitiveCount);
  if (!tree.joints.empty()) bvh.joints = Buffer<uint8_t>(device, bvh.nodeCount);
  breadthFirst(device, "write nodes", bvh.nodeCount,
               NewTree{tree.nodes.data(), tree.order.data(), subtrees.data(), bvh.nodes.data(), bvh.order.data(),
                       tree.joints.data(), bvh.joints.data()},
               NewTree::item(0, bvh.nodeCount == 1, 0));
  if (!summary.anyScattered) bvh.order = std::move(tree.order);
  return bvh;
}

}  // namespace copse
