// Parallel locally-ordered clustering: in each round every cluster looks for its nearest among those near it in Morton
// order, and those that are each other's nearest join, until one is left.
// Meister and Bittner: Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction (TVCG 2018).
// Search, joins and closing the gaps within a tile are one launch, and the last few clusters are joined in one launch
// without further rounds: Benthin et al.: PLOC++ (2022). About log n rounds, each O(clusters × radius), and the radix
// sort. Waits for the device once per round, for how many clusters are left.
#include <algorithm>

#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/methods/ploc/nearest.h"
#include "builder/parallel/one_lane.h"
#include "builder/parallel/primitives.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace {

constexpr PhaseName clustering{"clustering", &groups::agglomeration};

constexpr uint32_t maxRadius = 100, tileSize = 256, lastClusters = 512;

/// A cluster as it lies between rounds: 32 bytes.
struct StoredCluster {
  vec3 lo;
  uint32_t node;
  vec3 hi;
  uint32_t spare;

  HD static StoredCluster of(const Box& box, const ploc::Cluster& cluster) {
    return {box.lo, cluster.node, box.hi, cluster.spare};
  }
  HD ploc::Cluster cluster() const { return {node, spare}; }
  HD Box box() const {
    Box b;
    b.lo = lo;
    b.hi = hi;
    return b;
  }
};
static_assert(sizeof(StoredCluster) == 32);

struct PutLeaves {
  const Box* boxes;
  const uint32_t* order;
  uint32_t count;
  BvhNode* nodes;
  uint32_t* parents;
  StoredCluster* clusters;

  static constexpr uint32_t prefetchDistance = 16;  ///< In leaves.

  HD void operator()(uint32_t i) const {
    if (i + prefetchDistance < count) prefetch(boxes + order[i + prefetchDistance]);
    const Box box = boxes[order[i]];  // A copy, for two loads of 16 bytes.
    nodes[count - 1 + i] = BvhNode::leaf(box, i, 1);
    clusters[i] = StoredCluster::of(box, {count - 1 + i, i});
    if (count == 1) parents[0] = ParentLinks::none;
  }
};

/// A round within one tile. To know who is whose nearest, it looks at two radii of neighbours on either side.
struct JoinInTile {
  using Clusters = ploc::Clusters<tileSize + 4 * maxRadius, maxRadius>;

  const StoredCluster* from;
  StoredCluster* to;  ///< What stays, from the tile's first place on.
  uint32_t* staying;  ///< Per tile.
  uint32_t count, radius;
  ploc::Joins joins;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t tile) const {
    auto& clusters = *static_cast<Clusters*>(lanes.shared());
    const uint32_t first = tile * tileSize, end = first + tileSize < count ? first + tileSize : count;
    const uint32_t before = first < 2 * radius ? first : 2 * radius;
    const uint32_t after = count - end < 2 * radius ? count - end : 2 * radius;
    const uint32_t begin = first - before, length = end + after - begin;
    for (uint32_t i = lanes.lane(); i < length; i += Lanes::size) {
      const StoredCluster cluster = from[begin + i];
      clusters.put(i, cluster.box(), cluster.cluster());
    }
    lanes.sync();
    clusters.findNearest(lanes, length, radius);
    const uint32_t left = clusters.joinNearest(lanes, before, before + end - first, joins,
                                               [&](uint32_t k, const Box& box, const ploc::Cluster& cluster) {
                                                 to[first + k] = StoredCluster::of(box, cluster);
                                               });
    if (lanes.lane() == 0) staying[tile] = left;
  }
};

/// Closes the gaps between tiles.
struct CloseUp {
  const StoredCluster* from;
  StoredCluster* to;
  const uint32_t *staying, *offsets;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t tile) const {
    for (uint32_t k = lanes.lane(); k < staying[tile]; k += Lanes::size)
      to[offsets[tile] + k] = from[tile * tileSize + k];
  }
};

/// All further rounds, by one warp or thread.
struct JoinLast {
  using Clusters = ploc::Clusters<lastClusters, maxRadius>;

  const StoredCluster* from;
  uint32_t count, radius, maxReach;
  ploc::Joins joins;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t) const {
    auto& clusters = *static_cast<Clusters*>(lanes.shared());
    for (uint32_t i = lanes.lane(); i < count; i += Lanes::size) {
      const StoredCluster cluster = from[i];
      clusters.put(i, cluster.box(), cluster.cluster());
    }
    lanes.sync();
    uint32_t left = count, reach = radius;
    for (; left > 1; reach += reach < maxReach) left = clusters.round(lanes, left, reach, joins);
    if (lanes.lane() == 0) bringToFront(joins.nodes, joins.parents, clusters.cluster[0].node);
  }
};

/// The radius of a round: the same for all, or one more in each up to a maximum.
struct Radius {
  uint32_t max;
  bool grows;

  uint32_t of(uint32_t round) const { return grows ? std::min(round + 1, max) : max; }
};

OpenTree buildPloc(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  if (n == 0) return {};
  MortonOrder sorted = mortonOrder(device, input, parameters);
  Phase phase(device, clustering);
  OpenTree bvh = treeOver(device, sorted);
  const ploc::Joins joins{bvh.nodes.data(), bvh.parents.data()};
  Buffer<StoredCluster> clusters(device, n), apart(device, n);
  launch(device, "put leaves", n,
         PutLeaves{input.boxes, bvh.order.data(), n, bvh.nodes.data(), bvh.parents.data(), clusters.data()});
  const Radius radius{static_cast<uint32_t>(parameters.integer("ploc.radius")),
                      parameters.text("ploc.radius_by_round") == "growing"};
  const uint32_t tiles = n / tileSize + 1;
  Buffer<uint32_t> staying(device, tiles), offsets(device, std::size_t{tiles} + 1);
  uint32_t left = n;
  for (uint32_t round = 0; left > 1; ++round) {
    if (left <= lastClusters) {
      launchTeams(device, "join last", 1, JoinLast{clusters.data(), left, radius.of(round), radius.max, joins},
                  sizeof(JoinLast::Clusters));
      break;
    }
    const uint32_t used = (left - 1) / tileSize + 1;
    launchTeams(device, "join in tiles", used,
                JoinInTile{clusters.data(), apart.data(), staying.data(), left, radius.of(round), joins},
                sizeof(JoinInTile::Clusters), 1);
    exclusiveScan(device, "scan tiles", used, staying.data(), offsets.data(), offsets.data() + tiles);
    launchTeams(device, "close up", used, CloseUp{apart.data(), clusters.data(), staying.data(), offsets.data()}, 0);
    left = offsets.read(tiles);
  }
  return bvh;
}

}  // namespace

namespace methods {

Method ploc() {
  return {
      .name = "ploc",
      .source = "Meister 2018",
      .meaning = "clusters join their nearest within a radius in Morton order, round by round",
      .page = "docs/builders/ploc.md",
      .build = buildPloc,
      .parameters = {{.name = "ploc.radius",
                      .standard = 25,
                      .min = 1,
                      .max = maxRadius,
                      .meaning = "places in Morton order, to either side, in which a cluster looks for its nearest"},
                     {.name = "ploc.radius_by_round",
                      .standard = "fixed",
                      .words = {"fixed", "growing"},
                      .meaning = "the radius in every round, or 1 in the first and one more in each"}},
      .phases = {clustering},
      .presets = {{"plocpp",
                   "clusters join their nearest within a radius in Morton order, round by round, near ones only",
                   {{"ploc.radius", 16}}}}};
}

}  // namespace methods

}  // namespace copse
