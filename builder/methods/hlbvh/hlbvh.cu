// Hierarchical LBVH: boxes whose Morton codes share their first bits are a cluster with a radix tree of its own; over
// the clusters stands a tree split by the surface area heuristic.
// Garanzha, Pantaleoni, McAllister: Simpler and Faster HLBVH with Work Queues (HPG 2011). O(n) and the radix sort.
// Inner nodes: the top tree's, then those of the clusters in order; leaf i of the sorted order is node n-1+i.
#include <algorithm>

#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/methods/hlbvh/top_tree.h"
#include "builder/methods/lbvh.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace {

constexpr PhaseName clustersPhase{"clusters", &groups::hierarchy}, topTreePhase{"top tree", &groups::hierarchy};

using hlbvh::Cell;
using hlbvh::Clusters;

/// What makes a cluster: the first `bits` bits of a code.
struct Prefix {
  const uint64_t* keys;
  int shift, bits;

  HD uint64_t of(uint32_t i) const { return keys[i] >> shift; }
  HD bool starts(uint32_t i) const { return i == 0 || of(i) != of(i - 1); }
  HD Cell cell(uint32_t i) const {
    const uint64_t prefix = of(i);
    uint32_t at[3] = {0, 0, 0};
    for (int b = 0; b < bits; ++b) at[b % 3] = at[b % 3] << 1 | static_cast<uint32_t>(prefix >> (bits - 1 - b) & 1);
    return {at[0] | at[1] << 8 | at[2] << 16};
  }
};

struct MarkStarts {
  Prefix prefix;
  uint32_t* marks;

  HD void operator()(uint32_t i) const { marks[i] = prefix.starts(i); }
};

/// `rank[i]`: clusters that start before place i.
struct StartClusters {
  Prefix prefix;
  const uint32_t* rank;
  uint32_t* starts;
  Cell* cells;
  Box* boxes;
  const uint32_t* clusterCount;
  uint32_t count;

  HD void operator()(uint32_t i) const {
    if (i == 0) starts[*clusterCount] = count;
    if (!prefix.starts(i)) return;
    const uint32_t c = rank[i];
    starts[c] = i;
    cells[c] = prefix.cell(i);
    boxes[c] = Box{};
  }
};

/// Leaf i, and inner node i of its cluster's radix tree where there is one. Places within the cluster tell equal codes
/// apart.
struct LinkTreelets {
  Prefix prefix;
  Clusters clusters;
  const uint32_t* rank;
  const Box* boxes;
  const uint32_t* order;
  BvhNode* nodes;
  uint32_t* parents;

  static constexpr uint32_t prefetchDistance = 8;  ///< As in lbvh.

  HD void prepare() { clusters.load(); }
  HD void operator()(uint32_t i) const {
    const uint32_t n = clusters.primitives;
    if (i == 0) parents[0] = ParentLinks::none;
    if (i + prefetchDistance < n) prefetch(boxes + order[i + prefetchDistance]);
    const Box box = boxes[order[i]];  // As in lbvh.
    nodes[n - 1 + i] = BvhNode::leaf(box, i, 1);
    const uint32_t c = rank[i] + prefix.starts(i) - 1;
    const uint32_t start = clusters.starts[c], size = clusters.size(c), base = clusters.innerBase(c);
    const uint32_t own = i - start;
    if (own + 1 == size) return;
    const RadixTree tree{prefix.keys + start, size};
    const RadixTree::Children children = tree.childrenOf(own);
    const auto node = [&](uint32_t k) { return k < size - 1 ? base + k : n - 1 + start + k - (size - 1); };
    const uint32_t left = node(children.left), right = node(children.right);
    nodes[base + own] = BvhNode::inner(Box{}, left, right);
    parents[left] = base + own;
    parents[right] = base + own;
  }
};

/// Boxes of a few neighbouring places, each cluster's part of them at once.
struct UniteClusters {
  static constexpr uint32_t perIndex = 32;

  Prefix prefix;
  const uint32_t* rank;
  const BvhNode* leaves;
  Box* boxes;
  uint32_t count;

  HD void operator()(uint32_t i) const {
    const uint32_t begin = i * perIndex, end = count - begin < perIndex ? count : begin + perIndex;
    Box all;
    uint32_t cluster = rank[begin] + prefix.starts(begin) - 1;
    for (uint32_t at = begin; at < end; ++at) {
      if (at > begin && prefix.starts(at)) {
        grow(boxes[cluster], all);
        all = Box{};
        ++cluster;
      }
      all.grow(leaves[at].box());
    }
    grow(boxes[cluster], all);
  }
  HD static void grow(Box& to, const Box& by) {
    for (int axis = 0; axis < 3; ++axis) {
      atomicMinRelaxed(&to.lo[axis], by.lo[axis]);
      atomicMaxRelaxed(&to.hi[axis], by.hi[axis]);
    }
  }
};

OpenTree buildHlbvh(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  if (n == 0) return {};
  MortonOrder sorted = mortonOrder(device, input, parameters);
  OpenTree bvh = treeOver(device, sorted);
  const int bits = std::min(3 * sorted.bits, static_cast<int>(parameters.integer("hlbvh.bits")));
  const Prefix prefix{sorted.keys.data(), 3 * sorted.bits - bits, bits};

  // Room for as many clusters as there can be, so that the host need not ask how many there are.
  const uint32_t gridCells = 1u << bits, maxClusters = std::min(n, gridCells);
  Buffer<uint32_t> rank(device, n), starts(device, std::size_t{maxClusters} + 1), count(device, 1);
  Buffer<Cell> cells(device, maxClusters);
  Buffer<Box> boxes(device, maxClusters);
  const Clusters clusters{cells.data(), boxes.data(), starts.data(), count.data(), n, maxClusters};
  {
    Phase phase(device, clustersPhase);
    launch(device, "mark starts", n, MarkStarts{prefix, rank.data()});
    exclusiveScan(device, "rank clusters", n, rank.data(), rank.data(), count.data());
    launch(device, "start clusters", n,
           StartClusters{prefix, rank.data(), starts.data(), cells.data(), boxes.data(), count.data(), n});
  }
  {
    Phase phase(device, phases::treelets);
    launch(device, "link treelets", n,
           LinkTreelets{prefix, clusters, rank.data(), input.boxes, bvh.order.data(), bvh.nodes.data(),
                        bvh.parents.data()});
    launch(device, "unite clusters", (n - 1) / UniteClusters::perIndex + 1,
           UniteClusters{prefix, rank.data(), bvh.nodes.data() + (n - 1), boxes.data(), n}, 64);
  }
  Phase phase(device, topTreePhase);
  hlbvh::buildTopTree(device, clusters, gridCells, bvh.nodes.data(), bvh.parents.data());
  return bvh;
}

}  // namespace

namespace methods {

Method hlbvh() {
  return {
      .name = "hlbvh",
      .source = "Garanzha 2011",
      .meaning = "radix trees under a binned surface area tree over their Morton cells",
      .page = "docs/builders/hlbvh.md",
      .build = buildHlbvh,
      .parameters = {{.name = "hlbvh.bits",
                      .standard = 15,
                      .min = 1,
                      .max = 15,
                      .meaning = "leading Morton code bits, over all axes, that define the clusters of the top tree"}},
      .phases = {clustersPhase, topTreePhase}};
}

}  // namespace methods

}  // namespace copse
