// The last two stages of every build: which subtrees become leaves, and where nodes and triangles lie in memory.
// Boxes are fitted and leaves chosen in one bottom-up pass, which notes the inner nodes that stay. A scan gives each
// its rank among them in the order of the builder's nodes, and the children of the one of rank r become nodes 1 + 2r
// and 2 + 2r: what was near stays near, siblings stand side by side, and no level waits for the one above it. The
// result does not depend on threads. O(n) in all; the host waits once, while the scan runs.
#include "builder/bottom_up.h"
#include "builder/build.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/pending_read.h"
#include "builder/parallel/primitives.h"

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

/// Leaves behind, in the words of the parents, which nobody needs once both children have been there: 1 for an inner
/// node that stays one, and 0 for any other node.
struct ChooseLeaves {
  BvhNode* nodes;
  uint32_t* order;
  ParentLinks parents;
  const uint8_t* joints;  ///< Null where there are none.
  Subtree* subtrees;
  uint32_t innerEnd;  ///< No inner node stands from there on.
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
    if (i < innerEnd) parents.words[i] = 0;
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
    const bool becomesLeaf = !isJoint && primitives <= leafMax && (byCount || asLeaf < asTree);
    parents.words[at] = !becomesLeaf;
    if (becomesLeaf) {
      if (!left.isLeaf()) drop(nodes, parents.words, node.left);
      if (!right.isLeaf()) drop(nodes, parents.words, node.right);
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

  /// The inner nodes from `at` down are part of a leaf now. Each has a primitive below it that the others waiting have
  /// not, so they are never more than a leaf has.
  COPSE_RARE HD static void drop(const BvhNode* nodes, uint32_t* stays, uint32_t at) {
    uint32_t waiting[maxLeafSize];
    uint32_t waitingCount = 0;
    for (;;) {
      const BvhNode& node = nodes[at];
      if (!node.isLeaf()) {
        stays[at] = 0;
        waiting[waitingCount++] = Marks::right(node);
        at = Marks::left(node);
        continue;
      }
      if (waitingCount == 0) return;
      at = waiting[--waitingCount];
    }
  }

  /// The first `sorted` ascend, and so does the rest.
  HD static void merge(uint32_t* primitives, uint32_t sorted, uint32_t count) {
    for (; sorted < count && primitives[sorted] < primitives[sorted - 1]; ++sorted)
      insertSorted(primitives, sorted, primitives[sorted]);
  }
};

/// The new tree. Index: a node of the old one, which writes its two children where it stays an inner node.
struct WriteChildren {
  const BvhNode* nodes;
  uint32_t count;         ///< Where inner nodes end.
  const uint32_t* ranks;  ///< Inner nodes that stay before each node, and in all.
  BvhNode* newNodes;
  const Subtree* subtrees;
  uint32_t* counts;  ///< Of new nodes: a leaf's primitives, otherwise 0. Null where all primitives stay where they are.
  const uint8_t* joints;
  uint8_t* newJoints;  ///< Null where there are no joints.

  static constexpr uint32_t ahead = 16, farAhead = 64;  ///< Nodes between a request for memory and its use.

  HD void operator()(uint32_t i) const {
    prefetch(ranks + i + farAhead);
    prefetch(nodes + i + farAhead);
    if (i + ahead < count) {  // A leaf has no links; prefetching some other address for it does no harm.
      prefetch(nodes + Marks::left(nodes[i + ahead]));
      prefetch(nodes + Marks::right(nodes[i + ahead]));
    }
    const uint32_t rank = ranks[i];
    const bool isInner = ranks[i + 1] != rank;
    if (i == 0) write(0, 0, !isInner);
    if (!isInner) return;
    const BvhNode node = nodes[i];  // Copies, here and below, for loads of 16 bytes.
    prefetchForStore(newNodes + 1 + 2 * (rank + ahead));
    write(1 + 2 * rank, Marks::left(node), node.left & Marks::leftIsLeaf);
    write(2 + 2 * rank, Marks::right(node), node.right & Marks::rightIsLeaf);
  }

  /// Where the order stays, without a branch on what the node is, which cannot be foreseen.
  HD void write(uint32_t at, uint32_t source, bool isLeaf) const {
    const BvhNode node = nodes[source];
    const uint32_t firstChild = 1 + 2 * ranks[isLeaf ? 0 : source];
    uint32_t first = node.left, primitives = Marks::count(node);
    if (counts) {
      if (isLeaf && !node.isLeaf()) primitives = subtrees[source].primitives;
      counts[at] = isLeaf ? primitives : 0;
      first = source;  // Until its primitives are gathered.
    }
    newNodes[at] = {node.lo, isLeaf ? first : firstChild, node.hi,
                    isLeaf ? primitives | BvhNode::leafBit : firstChild + 1};
    if (newJoints) newJoints[at] = joints[source];
  }
};

/// Index: a new node. The primitives of leaves, in the order of these.
struct GatherLeaves {
  const BvhNode* nodes;
  const uint32_t* order;
  const uint32_t* places;  ///< Primitives in leaves before each new node.
  BvhNode* newNodes;
  uint32_t* newOrder;

  HD void operator()(uint32_t at) const {
    if (!newNodes[at].isLeaf()) return;
    gather(nodes[newNodes[at].left], newOrder + places[at]);
    newNodes[at].left = places[at];
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

/// The result of collapse. All inner nodes have indices below `innerEnd`.
struct Collapsed {
  Buffer<Subtree> subtrees;
  Buffer<Summary> summary;
  uint32_t innerEnd;
};

Collapsed chooseLeaves(const Device& device, Bvh& tree, const Parameters& parameters) {
  Phase phase(device, "collapse");
  // Where as many nodes stand before the first leaf as there are inner ones, these are all of them.
  const bool innerFirst = tree.firstLeaf > 0 && tree.firstLeaf == tree.nodeCount / 2;
  const uint32_t innerEnd = innerFirst ? tree.firstLeaf : tree.nodeCount;
  if (tree.parents.size() <= innerEnd) {  // There will be one more rank than inner nodes.
    tree.parents = Buffer<uint32_t>(device, std::size_t{tree.nodeCount} + 1);
    launch(device, "link parents", tree.nodeCount, LinkParents{tree.nodes.data(), tree.parents.data()});
  }
  Collapsed found{Buffer<Subtree>(device, innerEnd), Buffer<Summary>(device, 1), innerEnd};
  found.summary.fill(0);
  launch(device, "choose leaves", tree.nodeCount - tree.firstLeaf,
         ChooseLeaves{tree.nodes.data(),
                      tree.order.data(),
                      {tree.parents.data()},
                      tree.joints.data(),
                      found.subtrees.data(),
                      innerEnd,
                      found.summary.data(),
                      static_cast<float>(parameters.real("sah.traversal")),
                      static_cast<float>(parameters.real("sah.intersection")),
                      static_cast<uint32_t>(parameters.integer("leaf.max")),
                      parameters.text("leaf.rule") == "count",
                      tree.firstLeaf});
  return found;
}

}  // namespace

std::vector<ParameterSpec> collapseParameters() {
  return {{.name = "sah.traversal",
           .standard = 3.0,
           .min = 0,
           .max = 1e6,
           .meaning = "cost of a visit to an inner node (cT)"},
          {.name = "sah.intersection",
           .standard = 2.0,
           .min = 0,
           .max = 1e6,
           .meaning = "cost of a ray-triangle test (cI)"},
          {.name = "leaf.max", .standard = 8, .min = 1, .max = maxLeafSize, .meaning = "most triangles in a leaf"},
          {.name = "leaf.rule",
           .standard = "sah",
           .words = {"sah", "count"},
           .meaning = "which subtrees become leaves: sah, where it lowers the cost; count, all of at most leaf.max "
                      "triangles"}};
}

Bvh collapseAndLayout(const Device& device, Bvh tree, const Parameters& parameters) {
  if (tree.nodeCount == 0) return tree;
  const Collapsed collapsed = chooseLeaves(device, tree, parameters);

  Phase phase(device, "layout");
  PendingRead read(device);
  read.start(collapsed.summary.data());
  uint32_t* const ranks = tree.parents.data();  // Marks, until they are scanned.
  exclusiveScan(device, "rank nodes", collapsed.innerEnd, ranks, ranks, ranks + collapsed.innerEnd);
  const auto summary = read.wait<Summary>();

  Bvh bvh;
  bvh.primitiveCount = tree.primitiveCount;
  bvh.arity = tree.arity;
  bvh.nodeCount = 2 * summary.leaves - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  if (!tree.joints.empty()) bvh.joints = Buffer<uint8_t>(device, bvh.nodeCount);
  Buffer<uint32_t> places;
  if (summary.anyScattered) places = Buffer<uint32_t>(device, bvh.nodeCount);
  launch(device, "write nodes", collapsed.innerEnd,
         WriteChildren{tree.nodes.data(), collapsed.innerEnd, ranks, bvh.nodes.data(), collapsed.subtrees.data(),
                       places.data(), tree.joints.data(), bvh.joints.data()});
  if (!summary.anyScattered) {
    bvh.order = std::move(tree.order);
    return bvh;
  }
  bvh.order = Buffer<uint32_t>(device, tree.primitiveCount);
  exclusiveScan(device, "place leaves", bvh.nodeCount, places.data(), places.data(), nullptr);
  launch(device, "gather leaves", bvh.nodeCount,
         GatherLeaves{tree.nodes.data(), tree.order.data(), places.data(), bvh.nodes.data(), bvh.order.data()});
  return bvh;
}

}  // namespace copse
