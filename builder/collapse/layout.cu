// Where nodes and references lie in memory. A scan gives each inner node that stays its rank among them in the order of
// the open tree, and the children of the one of rank r become nodes 1 + 2r and 2 + 2r: what was near stays near,
// siblings stand side by side, and no level waits for the one above it. The result does not depend on threads. O(n).
#include "builder/collapse/chosen_leaves.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/pending_read.h"
#include "builder/parallel/primitives.h"
#include "builder/phases.h"

namespace copse {

namespace {

/// The new tree. Index: a node of the old one, which writes its two children where it stays an inner node.
struct WriteChildren {
  const BvhNode* nodes;
  uint32_t count;         ///< Where inner nodes end.
  const uint32_t* ranks;  ///< Inner nodes that stay before each node, and in all.
  BvhNode* newNodes;
  const ChosenSubtree* subtrees;
  uint32_t* counts;  ///< Per new node: a leaf's references, otherwise 0. Null where all references stay where they are.
  const uint8_t* joints;
  uint8_t* newJoints;  ///< Null where there are no joints.

  static constexpr uint32_t prefetchDistance = 16, farPrefetchDistance = 64;  ///< In nodes.

  HD void operator()(uint32_t i) const {
    prefetch(ranks + i + farPrefetchDistance);
    prefetch(nodes + i + farPrefetchDistance);
    if (i + prefetchDistance < count) {  // A leaf has no links; prefetching some other address for it does no harm.
      prefetch(nodes + LeafMarks::left(nodes[i + prefetchDistance]));
      prefetch(nodes + LeafMarks::right(nodes[i + prefetchDistance]));
    }
    const uint32_t rank = ranks[i];
    const bool isInner = ranks[i + 1] != rank;
    if (i == 0) write(0, 0, !isInner);
    if (!isInner) return;
    const BvhNode node = nodes[i];  // Copies, here and below, for loads of 16 bytes.
    prefetchForStore(newNodes + 1 + 2 * (rank + prefetchDistance));
    write(1 + 2 * rank, LeafMarks::left(node), node.left & LeafMarks::leftIsLeaf);
    write(2 + 2 * rank, LeafMarks::right(node), node.right & LeafMarks::rightIsLeaf);
  }

  /// Where the order stays, without a branch on what the node is, which cannot be foreseen.
  HD void write(uint32_t at, uint32_t source, bool isLeaf) const {
    const BvhNode node = nodes[source];
    const uint32_t firstChild = 1 + 2 * ranks[isLeaf ? 0 : source];
    uint32_t first = node.left, references = LeafMarks::count(node);
    if (counts) {
      if (isLeaf && !node.isLeaf()) references = subtrees[source].references;
      counts[at] = isLeaf ? references : 0;
      first = source;  // Until its references are gathered.
    }
    newNodes[at] = {node.lo, isLeaf ? first : firstChild, node.hi,
                    isLeaf ? references | BvhNode::leafBit : firstChild + 1};
    if (newJoints) newJoints[at] = joints[source];
  }
};

/// Index: a new node. The references of leaves, in the order of these.
struct GatherLeaves {
  const BvhNode* nodes;
  const uint32_t* order;
  const uint32_t* places;  ///< References in leaves before each new node.
  BvhNode* newNodes;
  uint32_t* newOrder;

  HD void operator()(uint32_t at) const {
    if (!newNodes[at].isLeaf()) return;
    gather(nodes[newNodes[at].left], newOrder + places[at]);
    newNodes[at].left = places[at];
  }

  /// The references below `node`, ascending.
  HD void gather(BvhNode node, uint32_t* to) const {
    uint32_t waiting[maxLeafSize];  // One of them has a reference at least, so they are never more than that.
    uint32_t waitingCount = 0, found = 0;
    for (;;) {
      if (!node.isLeaf()) {
        waiting[waitingCount++] = LeafMarks::right(node);
        node = nodes[LeafMarks::left(node)];
        continue;
      }
      for (uint32_t k = 0; k < LeafMarks::count(node); ++k) insertSorted(to, found++, order[node.first() + k]);
      if (waitingCount == 0) return;
      node = nodes[waiting[--waitingCount]];
    }
  }
};

}  // namespace

Bvh layOut(const Device& device, OpenTree tree, const ChosenLeaves& chosen) {
  Phase phase(device, phases::layout);
  const uint32_t innerEnd = tree.innerEnd();
  PendingRead read(device);
  read.start(chosen.summary.data());
  uint32_t* const ranks = tree.parents.data();  // Which nodes stay, until they are scanned.
  exclusiveScan(device, "rank nodes", innerEnd, ranks, ranks, ranks + innerEnd);
  const auto summary = read.wait<ChosenLeaves::Summary>();

  Bvh bvh;
  bvh.referenceCount = tree.referenceCount;
  bvh.triangleCount = tree.triangleCount;
  bvh.arity = tree.arity;
  bvh.nodeCount = 2 * summary.leaves - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  if (!tree.joints.empty()) bvh.joints = Buffer<uint8_t>(device, bvh.nodeCount);
  Buffer<uint32_t> places;
  if (summary.anyScattered) places = Buffer<uint32_t>(device, bvh.nodeCount);
  launch(device, "write nodes", innerEnd,
         WriteChildren{tree.nodes.data(), innerEnd, ranks, bvh.nodes.data(), chosen.subtrees.data(), places.data(),
                       tree.joints.data(), bvh.joints.data()});
  if (!summary.anyScattered) {
    bvh.order = std::move(tree.order);
    return bvh;
  }
  bvh.order = Buffer<uint32_t>(device, tree.referenceCount);
  exclusiveScan(device, "place leaves", bvh.nodeCount, places.data(), places.data(), nullptr);
  launch(device, "gather leaves", bvh.nodeCount,
         GatherLeaves{tree.nodes.data(), tree.order.data(), places.data(), bvh.nodes.data(), bvh.order.data()});
  return bvh;
}

}  // namespace copse
