// Every builder of the registry on every kind and size of input: valid trees of bounded depth, laid out breadth-first,
// the same on any number of threads. A new row in the registry is tested here with no line of code.
#include <catch2/catch.hpp>

#include "tests/support/builder_checks.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

/// Children follow their parents, level by level, siblings side by side; each leaf's triangles ascend.
void requireBreadthFirst(const Bvh& bvh) {
  const auto nodes = bvh.nodes.toHost(bvh.nodeCount);
  const auto order = bvh.order.toHost(bvh.primitiveCount);
  uint32_t next = 1;
  for (const BvhNode& node : nodes) {
    if (node.isLeaf()) {
      for (uint32_t k = 1; k < node.count(); ++k)
        if (order[node.first() + k - 1] >= order[node.first() + k]) FAIL("a leaf's triangles do not ascend");
    } else {
      if (node.left != next || node.right != next + 1) FAIL("children " << node.left << ", " << node.right
                                                                        << " where " << next << " is next");
      next += 2;
    }
  }
}

/// What a radix tree of 64 bits and 30-bit places can reach; the other methods stay below it too.
constexpr uint32_t deepest = 96;

}  // namespace

TEST_CASE("every builder makes valid trees of every kind and size of input") {
  for (const Device& device : test::devices())
    for (const BuilderEntry& builder : builders())
      for (const std::string& name : test::inputNames())
        for (const uint32_t size : test::inputSizes()) {
          INFO(builder.name << " on " << name << ", " << size << " triangles, " << device.name);
          const test::TestMesh mesh = test::makeInput(name, size);
          const Bvh bvh = test::treeOf(device, mesh, builder.name);
          test::requireValid(device, bvh, mesh, 8);
          requireBreadthFirst(bvh);
          const TreeStatistics tree = statistics(device, bvh, {});
          REQUIRE(tree.depth <= deepest);
          REQUIRE(tree.nodes == (size ? 2 * tree.leaves - 1 : 0));
        }
}

TEST_CASE("the same triangles give the same tree on any number of threads") {
  for (const BuilderEntry& builder : builders())
    for (const std::string& name : test::inputNames()) {
      const test::TestMesh mesh = test::makeInput(name, 40000);
      const Device device = openDevice("cpu", 1);
      const auto expected = test::bitsOf(test::treeOf(device, mesh, builder.name));
      for (const int threads : {2, 3, 7}) {
        INFO(builder.name << " on " << name << ", " << threads << " threads");
        const bool same = test::bitsOf(test::treeOf(test::withThreads(device, threads), mesh, builder.name)) == expected;
        REQUIRE(same);
      }
    }
}
