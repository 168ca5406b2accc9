// hlbvh beside its definition: each cluster of equal first bits is one subtree, and each node above the clusters parts
// them by the grid plane of least surface area cost, found here by trying all planes anew.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "builder/math/morton.h"
#include "builder/methods/hlbvh/top_tree.h"
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

struct Cluster {
  Box box;
  uint32_t size = 0;
  uint32_t cell[3] = {0, 0, 0};
};

double costOf(const std::vector<Cluster>& clusters) {
  Box box;
  uint32_t size = 0;
  for (const Cluster& cluster : clusters) {
    box.grow(cluster.box);
    size += cluster.size;
  }
  return double{box.area()} * size;
}

double costOfPlane(const std::vector<Cluster>& clusters, int axis, uint32_t last) {
  std::vector<Cluster> side[2];
  for (const Cluster& cluster : clusters) side[cluster.cell[axis] > last].push_back(cluster);
  if (side[0].empty() || side[1].empty()) return INFINITY;
  return costOf(side[0]) + costOf(side[1]);
}

double leastCost(const std::vector<Cluster>& clusters) {
  double least = INFINITY;
  for (int axis = 0; axis < 3; ++axis)
    for (uint32_t last = 0; last < 31; ++last) least = std::min(least, costOfPlane(clusters, axis, last));
  return least;
}

/// The tree as it was built, and the cluster of each triangle.
struct Hierarchy {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  std::vector<Box> boxes;
  std::vector<uint64_t> prefix;
  int bits;
  uint32_t subtrees = 0, topNodes = 0;

  Hierarchy(const test::TestMesh& mesh, int topBits) : boxes(mesh.count()), prefix(mesh.count()), bits(topBits) {
    Parameters parameters;
    parameters.set("hlbvh.bits", int64_t{bits});
    const Device device = test::chosenDevice();
    const OpenTree bvh = test::rawTreeOf(device, mesh, "hlbvh", parameters);
    nodes = bvh.nodes.toHost(bvh.nodeCount);
    order = bvh.order.toHost(bvh.referenceCount);
    Box bounds;
    for (uint32_t i = 0; i < mesh.count(); ++i) {
      for (int corner = 0; corner < 3; ++corner) boxes[i].grow(mesh.positions[mesh.indices[i][corner]]);
      bounds.grow(boxes[i]);
    }
    const MortonGrid grid = MortonGrid::over(bounds, 20, false);
    for (uint32_t i = 0; i < mesh.count(); ++i) prefix[i] = grid.code(boxes[i].centre2()) >> (60 - bits);
  }

  uint32_t clusterCount() const {
    auto all = prefix;
    std::sort(all.begin(), all.end());
    return static_cast<uint32_t>(std::unique(all.begin(), all.end()) - all.begin());
  }

  /// Clusters below `at`, checked on the way.
  std::map<uint64_t, Cluster> check(uint32_t at) {
    std::map<uint64_t, Cluster> below;
    if (nodes[at].isLeaf()) {
      const uint32_t triangle = order[nodes[at].first()];
      Cluster& cluster = below[prefix[triangle]];
      cluster.box = boxes[triangle];
      cluster.size = 1;
      for (int b = 0; b < bits; ++b)
        cluster.cell[b % 3] = cluster.cell[b % 3] << 1 | (prefix[triangle] >> (bits - 1 - b) & 1);
      return below;
    }
    const auto left = check(nodes[at].left), right = check(nodes[at].right);
    below = left;
    for (const auto& [key, cluster] : right) {
      Cluster& same = below[key];
      if (same.size == 0) std::copy(cluster.cell, cluster.cell + 3, same.cell);
      same.box.grow(cluster.box);
      same.size += cluster.size;
    }
    if (below.size() > 1) {
      ++topNodes;
      subtrees += (left.size() == 1) + (right.size() == 1);
      std::vector<Cluster> sides[2], all;
      for (const auto& [key, cluster] : left) sides[0].push_back(cluster);
      for (const auto& [key, cluster] : right) sides[1].push_back(cluster);
      for (const auto& [key, cluster] : below) all.push_back(cluster);
      REQUIRE(costOf(sides[0]) + costOf(sides[1]) <= leastCost(all) * (1 + 1e-5) + 1e-30);
      REQUIRE(all.size() == left.size() + right.size());
    }
    return below;
  }
};

}  // namespace

TEST_CASE("hlbvh keeps each cluster together and parts clusters by the cheapest plane") {
  for (const char* name : {"random", "coplanar", "one-huge", "two-clusters", "negative", "large", "grid"})
    for (const int bits : {15, 9, 4, 1}) {
      INFO(name << ", clusters of " << bits << " bits");
      const test::TestMesh mesh = test::makeInput(name, 2000);
      Hierarchy tree(mesh, bits);
      REQUIRE(tree.check(0).size() == tree.clusterCount());
      REQUIRE(tree.topNodes == tree.clusterCount() - 1);
      if (tree.clusterCount() > 1) REQUIRE(tree.subtrees == tree.clusterCount());
    }
}

TEST_CASE("hlbvh of one cluster is the radix tree") {
  for (const Device& device : test::devices())
    for (const uint32_t size : {1u, 2u, 3u, 64u, 1000u}) {
      INFO(size << " triangles, " << device.name);
      const test::TestMesh mesh = test::makeInput("identical", size);
      const bool same =
          test::bitsOf(test::rawTreeOf(device, mesh, "hlbvh")) == test::bitsOf(test::rawTreeOf(device, mesh, "lbvh"));
      REQUIRE(same);
    }
}

TEST_CASE("hlbvh with a cluster a triangle, few clusters and short codes is valid on any number of threads") {
  for (const Device& device : test::devices())
    for (const char* codes : {"morton.bits=1", "morton.bits=2", "morton.bits=5", "morton.bits=21"})
      for (const char* name : {"random", "grid", "two-clusters", "collinear"}) {
        INFO(codes << " on " << name << ", " << device.name);
        Parameters parameters;
        parameters.set(codes);
        const test::TestMesh mesh = test::makeInput(name, 5000);
        const Bvh bvh = test::treeOf(device, mesh, "hlbvh", parameters);
        test::requireValid(device, bvh, mesh, 8);
        const bool same =
            test::bitsOf(test::treeOf(test::withThreads(device, 5), mesh, "hlbvh", parameters)) == test::bitsOf(bvh);
        REQUIRE(same);
      }
}

namespace {

/// The nodes and parents of a top tree over `count` clusters in cells that are drawn.
std::vector<uint32_t> topTreeOf(const Device& device, uint32_t count, uint32_t cells, bool flat, bool onFibers) {
  std::mt19937 draw(count + cells);
  std::map<uint32_t, Box> drawn;
  while (drawn.size() < count) {
    uint32_t cell[3];
    for (uint32_t& along : cell) along = static_cast<uint32_t>(draw() % cells);
    Box& box = drawn[cell[0] | cell[1] << 8 | cell[2] << 16];
    for (int corner = 0; corner < 2; ++corner)
      box.grow(flat ? vec3(cell[0], 0, 0) : vec3(cell[0], cell[1], cell[2]) + static_cast<float>(draw() % 8) / 4.0f);
  }
  std::vector<hlbvh::Cell> at;
  std::vector<Box> boxes;
  std::vector<uint32_t> starts{0};
  for (const auto& [cell, box] : drawn) {
    at.push_back({cell});
    boxes.push_back(box);
    starts.push_back(starts.back() + 1 + static_cast<uint32_t>(draw() % 5));
  }
  const Buffer<hlbvh::Cell> cellsThere(device, at);
  const Buffer<Box> boxesThere(device, boxes);
  const Buffer<uint32_t> startsThere(device, starts), counted(device, std::vector<uint32_t>{count});
  Buffer<BvhNode> nodes(device, 2 * std::size_t{starts.back()});
  Buffer<uint32_t> parents(device, nodes.size());
  nodes.fill(0);
  parents.fill(0);
  hlbvh::buildTopTree(device,
                      {cellsThere.data(), boxesThere.data(), startsThere.data(), counted.data(), starts.back(), count},
                      32 * 32 * 32, nodes.data(), parents.data(), onFibers);
  std::vector<uint32_t> words = parents.toHost();
  for (const BvhNode& node : nodes.toHost()) words.insert(words.end(), {node.left, node.right});
  return words;
}

}  // namespace

TEST_CASE("a lane a bin and a thread that sweeps choose the same planes") {
  const Device device = openDevice("cpu", 1);
  for (const uint32_t count : {1u, 2u, 3u, 40u, 700u})
    for (const uint32_t cells : {32u, 11u})
      for (const bool flat : {false, true}) {
        INFO(count << " clusters in " << cells << " cells per axis" << (flat ? ", of no area" : ""));
        const auto expected = topTreeOf(device, count, cells, flat, false);
        REQUIRE(topTreeOf(device, count, cells, flat, true) == expected);
        for (const Device& other : test::devices()) REQUIRE(topTreeOf(other, count, cells, flat, false) == expected);
      }
}

TEST_CASE("where all costs are equal hlbvh halves its clusters") {
  // On a line every area is 0; codes of 5 bits an axis leave no radix tree below the clusters' 32 cells.
  const Device device = test::chosenDevice();
  Parameters parameters;
  parameters.set("leaf.max=1");
  parameters.set("morton.bits=5");
  const Bvh bvh = test::treeOf(device, test::makeInput("collinear", 1000), "hlbvh", parameters);
  CHECK(statistics(device, bvh, parameters).depth <= 5 + 7);
}
