// The choice of wide nodes and their leaves: a whole tree, and none that costs less.
#include "builder/collapse/wide.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

/// A binary tree and the wide one over it, on the host.
struct Widened {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  std::vector<std::vector<WideChildren>> levels;
  uint64_t blocks = 0;

  Widened(const Device& device, const Bvh& bvh, const WideRule& rule)
      : nodes(bvh.nodes.toHost(bvh.nodeCount)), order(bvh.order.toHost(bvh.referenceCount)) {
    for (const WideLevel& level : widen(device, bvh, rule)) {
      levels.push_back(level.children.toHost(level.children.size()));
      blocks += level.blocks;
    }
  }

  uint32_t trianglesBelow(uint32_t at, std::vector<uint32_t>& found) const {
    if (!nodes[at].isLeaf()) return trianglesBelow(nodes[at].left, found) + trianglesBelow(nodes[at].right, found);
    for (uint32_t k = 0; k < nodes[at].count(); ++k) found.push_back(order[nodes[at].first() + k]);
    return nodes[at].count();
  }
};

double areaOf(const BvhNode& node) { return node.box().area(); }

/// The minimum cost of a subtree as up to `slots` children, each computed once.
struct LeastCosts {
  const std::vector<BvhNode>& nodes;
  const std::vector<uint32_t>& counts;
  WideRule rule;
  std::map<std::pair<uint32_t, uint32_t>, double> known = {};

  double of(uint32_t at, uint32_t slots) {
    const auto [entry, isNew] = known.try_emplace({at, slots}, INFINITY);
    if (!isNew) return entry->second;
    const BvhNode& node = nodes[at];
    const double asLeaf = areaOf(node) * (rule.leaf + double{rule.block} * blocksOf(counts[at]));
    double best = node.isLeaf() || counts[at] <= rule.leafMax ? asLeaf : INFINITY;
    if (!node.isLeaf()) {
      best = std::min(best, areaOf(node) * rule.node + split(node, wideWidth));
      for (uint32_t among = 2; among <= slots; ++among) best = std::min(best, split(node, among));
    }
    return known[{at, slots}] = best;
  }

  double split(const BvhNode& node, uint32_t among) {
    double best = INFINITY;
    for (uint32_t k = 1; k < among; ++k) best = std::min(best, of(node.left, k) + of(node.right, among - k));
    return best;
  }
};

uint32_t countBelow(const std::vector<BvhNode>& nodes, uint32_t at, std::vector<uint32_t>& counts) {
  const BvhNode& node = nodes[at];
  return counts[at] = node.isLeaf() ? node.count()
                                    : countBelow(nodes, node.left, counts) + countBelow(nodes, node.right, counts);
}

}  // namespace

TEST_CASE("a wide tree has each triangle in one leaf, eight children per node at most, and leaves of leafMax") {
  for (const Device& device : test::devices())
    for (const std::string& name : test::inputNames())
      for (const uint32_t size : {1u, 2u, 3u, 9u, 100u, 3000u})
        for (const uint32_t leafMax : {1u, 4u, 8u, 64u}) {
          INFO(name << ", " << size << " triangles, leaves of " << leafMax << ", " << device.name);
          const test::TestMesh mesh = test::makeInput(name, size);
          const test::DeviceMesh there(device, mesh);
          const Bvh bvh = buildBvh(device, there.view(), findBuilder("lbvh"), Parameters{});
          WideRule rule;
          rule.leafMax = leafMax;
          const Widened wide(device, bvh, rule);
          std::vector<uint32_t> triangles;
          uint64_t blocks = 0;
          std::size_t listed = 1;
          bool allFit = true, ascending = true;
          for (const std::vector<WideChildren>& level : wide.levels) {
            REQUIRE(level.size() == listed);
            listed = 0;
            for (const WideChildren& all : level) {
              float area = 0;
              for (const uint32_t child : all.child) {
                if (child == WideChildren::absent) continue;
                const uint32_t at = child & ~WideChildren::leafBit;
                ascending = ascending && !(wide.nodes[at].box().area() < area);
                area = wide.nodes[at].box().area();
                if (!(child & WideChildren::leafBit)) {
                  ++listed;
                  continue;
                }
                const uint32_t count = wide.trianglesBelow(at, triangles);
                allFit = allFit && (count <= leafMax || wide.nodes[at].isLeaf());
                blocks += blocksOf(count);
              }
            }
          }
          REQUIRE(listed == 0);
          REQUIRE(allFit);
          REQUIRE(ascending);
          REQUIRE(blocks == wide.blocks);
          std::ranges::sort(triangles);
          REQUIRE(triangles.size() == size);
          REQUIRE(triangles.back() == size - 1);
          REQUIRE(std::ranges::adjacent_find(triangles) == triangles.end());
        }
}

TEST_CASE("no wide tree over a binary one costs less than the one that is chosen") {
  const Device device = openDevice("cpu");
  for (const char* name : {"random", "two-clusters", "shrinking", "one-huge"})
    for (const auto& [node, leaf, block] : {std::tuple{1.0f, 0.0f, 0.7f}, {1, 0.5f, 0.5f}, {1, 0, 3}, {2, 1, 0}}) {
      INFO(name << ", costs " << node << ", " << leaf << ", " << block);
      const test::TestMesh mesh = test::makeInput(name, 300);
      const test::DeviceMesh there(device, mesh);
      Parameters parameters;
      parameters.set("leaf.max=1");
      const Bvh bvh = buildBvh(device, there.view(), findBuilder("sah"), parameters);
      WideRule rule;
      rule.node = node, rule.leaf = leaf, rule.block = block;
      const Widened wide(device, bvh, rule);
      std::vector<uint32_t> counts(wide.nodes.size());
      countBelow(wide.nodes, 0, counts);
      const double least = LeastCosts{wide.nodes, counts, rule}.of(0, 1);
      double cost = 0;
      std::vector<uint32_t> level{0};
      for (const std::vector<WideChildren>& nodes : wide.levels) {
        std::vector<uint32_t> next;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          const bool rootIsLeaf = nodes[i].child[0] == WideChildren::leafBit;
          if (!rootIsLeaf) cost += node * areaOf(wide.nodes[level[i]]);
          for (const uint32_t child : nodes[i].child) {
            if (child == WideChildren::absent) continue;
            const uint32_t at = child & ~WideChildren::leafBit;
            if (child & WideChildren::leafBit)
              cost += areaOf(wide.nodes[at]) * (leaf + double{block} * blocksOf(counts[at]));
            else
              next.push_back(at);
          }
        }
        level = std::move(next);
      }
      CHECK(cost == Approx(least).epsilon(1e-4));
    }
}

TEST_CASE("wide trees are the same on any number of threads") {
  const test::TestMesh mesh = test::makeInput("random", test::many(30000));
  const Device one = openDevice("cpu", 1);
  const test::DeviceMesh there(one, mesh);
  const Bvh bvh = buildBvh(one, there.view(), findBuilder("hploc"), Parameters{});
  const auto bitsOf = [&](const Device& device) {
    std::vector<uint32_t> bits;
    for (const auto& level : Widened(device, bvh, WideRule()).levels)
      for (const WideChildren& children : level) bits.insert(bits.end(), children.child, children.child + wideWidth);
    return bits;
  };
  const std::vector<uint32_t> expected = bitsOf(one);
  for (int round = 0; round < 5; ++round) {
    const bool same = bitsOf(test::withThreads(one, 8)) == expected;
    REQUIRE(same);
  }
}
