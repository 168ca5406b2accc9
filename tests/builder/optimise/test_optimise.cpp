// Every optimiser over every builder's tree, whatever its nodes' order and however large its leaves: valid trees that
// cost no more than before, and the same ones whatever the numbering, the device or its threads.
#include <algorithm>
#include <random>

#include "builder/base/error.h"
#include "tests/support/builder_checks.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;
using namespace copse::test;

namespace {

double costOf(const Device& device, OpenTree tree, const Parameters& parameters = {}) {
  return statistics(device, collapseAndLayout(device, std::move(tree), parameters), parameters).sahCost;
}

/// From the root down: which references each leaf has, and how subtrees are joined; whatever the nodes' numbers.
template <class Tree>
std::vector<uint32_t> shapeOf(const Tree& tree) {
  const auto nodes = tree.nodes.toHost(tree.nodeCount);
  const auto order = tree.order.toHost(tree.referenceCount);
  std::vector<uint32_t> shape;
  for (std::vector<uint32_t> waiting{0}; !waiting.empty();) {
    const BvhNode node = nodes[waiting.back()];
    waiting.pop_back();
    if (!node.isLeaf()) {
      shape.push_back(~0u);
      waiting.insert(waiting.end(), {node.right, node.left});
      continue;
    }
    shape.insert(shape.end(), order.begin() + node.first(), order.begin() + node.first() + node.count());
  }
  return shape;
}

/// The same tree with its nodes in another order, the root first.
OpenTree renumbered(const Device& device, const OpenTree& tree, uint32_t seed) {
  const auto nodes = tree.nodes.toHost(tree.nodeCount);
  std::vector<uint32_t> place(nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) place[i] = i;
  std::shuffle(place.begin() + 1, place.end(), std::mt19937(seed));
  std::vector<BvhNode> shuffled(nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    BvhNode node = nodes[i];
    if (!node.isLeaf()) node = BvhNode::inner(node.box(), place[node.left], place[node.right]);
    shuffled[place[i]] = node;
  }
  OpenTree other;
  other.nodes = Buffer<BvhNode>(device, shuffled);
  other.order = Buffer<uint32_t>(device, tree.order.toHost());
  other.nodeCount = tree.nodeCount;
  other.referenceCount = tree.referenceCount;
  other.triangleCount = tree.triangleCount;
  return other;
}

/// A laid-out tree as an open one, with the leaves that it has.
OpenTree opened(Bvh bvh) {
  OpenTree tree;
  tree.nodes = std::move(bvh.nodes);
  tree.order = std::move(bvh.order);
  tree.nodeCount = bvh.nodeCount;
  tree.referenceCount = bvh.referenceCount;
  tree.triangleCount = bvh.triangleCount;
  return tree;
}

void requireParents(const OpenTree& tree) {
  const auto nodes = tree.nodes.toHost(tree.nodeCount);
  const auto parents = tree.parents.toHost(tree.nodeCount);
  for (uint32_t i = 0; i < nodes.size(); ++i)
    if (!nodes[i].isLeaf() && (parents[nodes[i].left] != i || parents[nodes[i].right] != i))
      FAIL("node " << i << " is not the parent of its children");
}

void requireOptimised(const std::string& builder) {
  for (const Device& device : devices())
    for (const Optimiser& optimiser : optimisers::all())
      for (const char* input : {"random", "identical", "grid", "one-huge"})
        for (const uint32_t size : {0u, 1u, 2u, 3u, 4u, 40u, isEmulated(device) ? 200u : 1500u}) {
          INFO(optimiser.name << " over " << builder << " on " << input << ", " << size << " triangles, "
                              << device.name);
          const TestMesh mesh = makeInput(input, size);
          const Bvh before = treeOf(device, mesh, builder);
          const Bvh after = treeOf(device, mesh, builder, {}, {{optimiser.name}});
          requireValid(device, after, mesh, 8);
          const double cost = statistics(device, before, {}).sahCost;
          REQUIRE(statistics(device, after, {}).sahCost <= cost * (1 + 1e-6));
          if (size == 0) continue;
          requireParents(rawTreeOf(device, mesh, builder, {}, {optimiser.name}));
        }
}
const Cases optimised("optimisers take any builder's tree and leave one that costs no more", "", builderNames(),
                      requireOptimised);

}  // namespace

TEST_CASE("trbvh and atrbvh are lbvh and an optimiser, to the bit") {
  for (const Device& device : devices()) {
    const TestMesh mesh = makeInput("random", isEmulated(device) ? 300 : 5000);
    for (const auto& [preset, optimiser] :
         {std::pair{"trbvh", "treelets-exact"}, std::pair{"atrbvh", "treelets-agglomerative"}}) {
      INFO(preset);
      const auto expected = bitsOf(treeOf(device, mesh, preset));
      const bool same = bitsOf(treeOf(device, mesh, "lbvh", {}, {{optimiser}})) == expected;
      CHECK(same);
      const bool changed = bitsOf(treeOf(device, mesh, "lbvh")) != expected;
      CHECK(changed);
    }
  }
}

TEST_CASE("optimisers run in the order in which they are named, after the builder's own") {
  const Device device = chosenDevice();
  const TestMesh mesh = makeInput("random", 2000);
  const OptimiserNames both{"treelets-exact", "treelets-agglomerative"}, reversed{both[1], both[0]};
  const auto expected = bitsOf(treeOf(device, mesh, "lbvh", {}, {both}));
  const bool afterOwn = bitsOf(treeOf(device, mesh, "trbvh", {}, {{both[1]}})) == expected;
  CHECK(afterOwn);
  const bool another = bitsOf(treeOf(device, mesh, "lbvh", {}, {reversed})) != expected;
  CHECK(another);
}

TEST_CASE("what an optimiser makes of a tree does not depend on the numbers of its nodes") {
  for (const Device& device : devices())
    for (const char* builder : {"lbvh", "sah"})
      for (const Optimiser& optimiser : optimisers::all())
        for (const uint32_t size : {3u, 9u, 200u, isEmulated(device) ? 200u : 3000u}) {
          INFO(optimiser.name << " over " << builder << ", " << size << " triangles, " << device.name);
          const TestMesh mesh = makeInput("random", size);
          OpenTree tree = rawTreeOf(device, mesh, builder);
          OpenTree other = renumbered(device, tree, size);
          const auto before = shapeOf(tree);
          REQUIRE(shapeOf(other) == before);
          optimise(device, tree, {}, {optimiser.name}, {});
          optimise(device, other, {}, {optimiser.name}, {});
          const bool same = shapeOf(tree) == shapeOf(other);
          REQUIRE(same);
          if (size >= 200 && builder == std::string("lbvh")) {
            const bool changed = shapeOf(tree) != before;
            REQUIRE(changed);
          }
        }
}

TEST_CASE("optimisers take leaves of several triangles, larger than treelets or than leaf.max too") {
  for (const Device& device : devices())
    for (const char* rule : {"leaf.rule=sah", "leaf.rule=count"})
      for (const Optimiser& optimiser : optimisers::all()) {
        INFO(optimiser.name << ", " << rule << ", " << device.name);
        const TestMesh mesh = makeInput("random", isEmulated(device) ? 400 : 4000);
        Parameters large, parameters;
        large.set("leaf.rule=count");
        large.set("leaf.max=12");
        parameters.set(rule);
        parameters.set("leaf.max=4");
        OpenTree tree = opened(treeOf(device, mesh, "lbvh", large));
        const double before = costOf(device, opened(treeOf(device, mesh, "lbvh", large)), parameters);
        optimise(device, tree, {}, {optimiser.name}, parameters);
        const Bvh after = collapseAndLayout(device, std::move(tree), parameters);
        requireValid(device, after, mesh, 12);
        CHECK(statistics(device, after, parameters).sahCost < 0.998 * before);
      }
}

TEST_CASE("optimised trees are the same on any number of threads and any device") {
  const TestMesh mesh = makeInput("random", many(20000));
  const TestMesh few = makeInput("random", 300);
  const Device cpu = openDevice("cpu", 1);
  for (const char* builder : {"hlbvh", "kmeans-q2", "sah", "aac-hq"})
    for (const Optimiser& optimiser : optimisers::all()) {
      INFO(optimiser.name << " over " << builder);
      const auto expected = bitsOf(treeOf(cpu, mesh, builder, {}, {{optimiser.name}}));
      for (const int threads : {2, 7}) {
        const bool same = bitsOf(treeOf(withThreads(cpu, threads), mesh, builder, {}, {{optimiser.name}})) == expected;
        REQUIRE(same);
      }
      for (const Device& device : devices()) {
        const bool same = bitsOf(treeOf(device, few, builder, {}, {{optimiser.name}})) ==
                          bitsOf(treeOf(cpu, few, builder, {}, {{optimiser.name}}));
        REQUIRE(same);
      }
    }
}

TEST_CASE("optimisers that need a binary tree refuse wide nodes, and unknown names are told the known ones") {
  const Device device = chosenDevice();
  const TestMesh mesh = makeInput("random", 200);
  Parameters wide;
  wide.set("kmeans.arity=4");
  for (const Optimiser& optimiser : optimisers::all()) {
    INFO(optimiser.name);
    CHECK_THROWS_WITH(treeOf(device, mesh, "kmeans", wide, {{optimiser.name}}),
                      Contains("expected a binary tree, got up to 4 children"));
  }
  CHECK_THROWS_WITH(findOptimiser("treelet"), Contains("unknown optimiser 'treelet' (available: treelets-exact, "));
  CHECK(optimiserNames("").empty());
  CHECK(optimiserNames("treelets-exact") == OptimiserNames{"treelets-exact"});
  CHECK(optimiserNames("treelets-agglomerative,treelets-exact") ==
        OptimiserNames{"treelets-agglomerative", "treelets-exact"});
  for (const char* bad : {",", "treelets-exact,", ",treelets-exact", "treelets-exact treelets-exact"})
    CHECK_THROWS_AS(optimiserNames(bad), InputError);
}
