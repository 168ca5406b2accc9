// Which subtrees become leaves. Boxes are fitted and leaves chosen in one bottom-up pass, which notes the inner nodes
// that stay: fitting by itself, as fit() does, is a second pass over the same memory (docs/build-times.md has what it
// costs). The result does not depend on threads. O(n).
#include "builder/bottom_up.h"
#include "builder/collapse/chosen_leaves.h"
#include "builder/parallel/launch.h"
#include "builder/phases.h"

namespace copse {

namespace {

/// Where the references of two siblings stand together.
HD inline uint32_t joinedPlace(const ChosenSubtree& left, const ChosenSubtree& right) {
  const bool known = left.place != ChosenSubtree::scattered && right.place != ChosenSubtree::scattered;
  if (known && left.place + left.references == right.place) return left.place;
  if (known && right.place + right.references == left.place) return right.place;
  return ChosenSubtree::scattered;
}

/// Leaves behind, in the words of the parents, which nobody needs once both children have been there: 1 for an inner
/// node that stays one, and 0 for any other node.
struct ChooseLeaves {
  BvhNode* nodes;
  uint32_t* order;
  ParentLinks parents;
  const uint8_t* joints;  ///< Null where there are none.
  ChosenSubtree* subtrees;
  uint32_t innerEnd;  ///< No inner node stands from there on.
  ChosenLeaves::Summary* summary;
  LeafRule rule;
  uint32_t firstLeaf;

  static constexpr uint32_t prefetchDistance = 16;  ///< In leaves.

  HD void operator()(uint32_t index) const {
    const uint32_t i = firstLeaf + index;
    prefetch(nodes + i + prefetchDistance);
    prefetch(parents.words + i + 4 * prefetchDistance);
    // Where leaf i is the i-th of the order, the walk soon comes to inner nodes beside the i-th.
    prefetchForStore(nodes + index + prefetchDistance);
    prefetchForStore(parents.words + index + 4 * prefetchDistance);
    prefetchForStore(subtrees + index + 2 * prefetchDistance);
    const BvhNode& leaf = nodes[i];  // Not a copy: an inner node may be written just now.
    if (!LeafMarks::isLeafFromTheStart(atomicLoadRelaxed(&nodes[i].right))) return;
    for (uint32_t k = 1; k < leaf.count(); ++k) insertSorted(order + leaf.first(), k, order[leaf.first() + k]);
    if (i == 0) summary->leaves = 1;
    uint32_t at = parents.ofLeaf(i), parent;
    if (i < innerEnd) parents.words[i] = 0;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent) join(at);
  }

  /// For a leaf what follows from it, for any other node what join() kept.
  HD ChosenSubtree subtree(uint32_t at) const {
    const BvhNode& node = nodes[at];
    if (!node.isLeaf()) return subtrees[at];
    const uint32_t count = LeafMarks::count(node);
    return {rule.ofLeaf(node.box().area(), count), count, 1, node.first()};
  }

  HD void join(uint32_t at) const {
    BvhNode& node = nodes[at];
    const Box box = unite(nodes[node.left].box(), nodes[node.right].box());
    const ChosenSubtree left = subtree(node.left), right = subtree(node.right);
    node.lo = box.lo;
    node.hi = box.hi;
    const uint32_t references = left.references + right.references;
    const float area = box.area();
    const bool isJoint = joints && joints[at];
    const float asTree = (isJoint ? 0 : rule.traversal * area) + left.cost + right.cost;
    const float asLeaf = rule.ofLeaf(area, references);
    const uint32_t place = joinedPlace(left, right);
    const bool becomesLeaf = !isJoint && rule.choosesLeaf(references, asLeaf, asTree);
    parents.words[at] = !becomesLeaf;
    if (becomesLeaf) {
      if (!left.isLeaf()) drop(nodes, parents.words, node.left);
      if (!right.isLeaf()) drop(nodes, parents.words, node.right);
      if (place == ChosenSubtree::scattered) {
        subtrees[at] = {asLeaf, references, 1, place};
        atomicStoreRelaxed(&summary->anyScattered, 1u);
      } else {
        if (left.isLeaf() && right.isLeaf())
          merge(order + place, place == left.place ? left.references : right.references, references);
        else
          for (uint32_t k = 1; k < references; ++k) insertSorted(order + place, k, order[place + k]);
        node.left = place;
        atomicStoreRelaxed(&node.right, references | LeafMarks::became | BvhNode::leafBit);
      }
    } else {
      subtrees[at] = {asTree, references, left.leaves + right.leaves, place};
      if (left.isLeaf()) node.left |= LeafMarks::leftIsLeaf;
      if (right.isLeaf()) atomicStoreRelaxed(&node.right, node.right | LeafMarks::rightIsLeaf);
    }
    if (at == 0) summary->leaves = node.isLeaf() ? 1 : subtrees[0].leaves;
  }

  /// The inner nodes from `at` down are part of a leaf now. Each has a reference below it that the others waiting have
  /// not, so they are never more than a leaf has.
  COPSE_RARE HD static void drop(const BvhNode* nodes, uint32_t* stays, uint32_t at) {
    uint32_t waiting[maxLeafSize];
    uint32_t waitingCount = 0;
    for (;;) {
      const BvhNode& node = nodes[at];
      if (!node.isLeaf()) {
        stays[at] = 0;
        waiting[waitingCount++] = LeafMarks::right(node);
        at = LeafMarks::left(node);
        continue;
      }
      if (waitingCount == 0) return;
      at = waiting[--waitingCount];
    }
  }

  /// The first `sorted` ascend, and so does the rest.
  HD static void merge(uint32_t* references, uint32_t sorted, uint32_t count) {
    for (; sorted < count && references[sorted] < references[sorted - 1]; ++sorted)
      insertSorted(references, sorted, references[sorted]);
  }
};

}  // namespace

ChosenLeaves chooseLeaves(const Device& device, OpenTree& tree, const LeafRule& rule) {
  Phase phase(device, phases::collapse);
  linkParents(device, tree);
  const uint32_t innerEnd = tree.innerEnd();
  ChosenLeaves chosen{Buffer<ChosenSubtree>(device, innerEnd), Buffer<ChosenLeaves::Summary>(device, 1)};
  chosen.summary.fill(0);
  launch(device, "choose leaves", tree.nodeCount - tree.firstLeaf,
         ChooseLeaves{tree.nodes.data(),
                      tree.order.data(),
                      {tree.parents.data()},
                      tree.joints.data(),
                      chosen.subtrees.data(),
                      innerEnd,
                      chosen.summary.data(),
                      rule,
                      tree.firstLeaf});
  return chosen;
}

}  // namespace copse
