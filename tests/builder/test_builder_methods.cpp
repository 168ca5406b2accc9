// The parts of the methods beside plain versions of the same: codes, the radix tree, the sweep, the choice of leaves.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "builder/math/morton.h"
#include "builder/methods/lbvh.h"
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

TEST_CASE("bits of three axes are interleaved with x highest") {
  CHECK(interleave(1, 0, 0) == 4);
  CHECK(interleave(0, 1, 0) == 2);
  CHECK(interleave(0, 0, 1) == 1);
  CHECK(interleave(0x1fffff, 0x1fffff, 0x1fffff) == (1ull << 63) - 1);
  std::mt19937 draw(1);
  for (int round = 0; round < 1000; ++round) {
    const uint32_t x = draw() >> 11, y = draw() >> 11, z = draw() >> 11;
    uint64_t expected = 0;
    for (int bit = 20; bit >= 0; --bit)
      expected = expected << 3 | (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1);
    REQUIRE(interleave(x, y, z) == expected);
  }
}

TEST_CASE("a Morton grid covers its box, keeps its borders and survives what is flat or no number") {
  Box bounds;
  bounds.lo = {-1, 5, 2};
  bounds.hi = {3, 5, 4};
  const MortonGrid grid = MortonGrid::over(bounds, 20, false);
  CHECK(grid.code(bounds.lo * 2.0f) == 0);
  CHECK(grid.code(bounds.hi * 2.0f) == interleave(0xfffff, 0, 0xfffff));  // No extent along y.
  CHECK(grid.code(vec3(1, 5, 3) * 2.0f) == interleave(0x80000, 0, 0x80000));
  CHECK(grid.code(vec3(100, 100, 100)) == interleave(0xfffff, 0, 0xfffff));
  CHECK(grid.code(vec3(NAN)) == 0);
  CHECK(grid.code(vec3(INFINITY)) <= interleave(0xfffff, 0xfffff, 0xfffff));
  const MortonGrid cubes = MortonGrid::over(bounds, 20, true);
  CHECK(cubes.code(bounds.hi * 2.0f) == interleave(0xfffff, 0, 0x80000));
  CHECK(MortonGrid::over(Box{}, 20, false).code(vec3(1, 2, 3)) == 0);
}

namespace {

/// The radix tree by its definition: a range is split where its keys first differ, equal keys by their place.
void radixTreeOf(const std::vector<uint64_t>& keys, uint32_t first, uint32_t last,
                 const std::function<void(uint32_t, uint32_t, uint32_t)>& found) {
  if (first == last) return;
  const auto bit = [&](uint32_t i, int b) { return b < 64 ? keys[i] >> (63 - b) & 1 : uint64_t{i} >> (95 - b) & 1; };
  int at = 0;
  while (bit(first, at) == bit(last, at)) ++at;
  uint32_t split = first;
  while (bit(split + 1, at) == bit(first, at)) ++split;
  found(first, split, last);
  radixTreeOf(keys, first, split, found);
  radixTreeOf(keys, split + 1, last, found);
}

void requireRadixTree(const std::vector<uint64_t>& keys) {
  const auto count = static_cast<uint32_t>(keys.size());
  const RadixTree tree{keys.data(), count};
  std::vector<int> named(2 * count - 1, 0);
  named[0] = 1;
  // A range's node has the number of its first leaf where it is a right child, of its last where it is a left one.
  std::vector<std::pair<uint32_t, uint32_t>> numbers;
  radixTreeOf(keys, 0, count - 1, [&](uint32_t first, uint32_t split, uint32_t last) {
    const auto number = [&](uint32_t from, uint32_t to, bool left) {
      return from == to ? count - 1 + from : left ? to : from;
    };
    const uint32_t left = number(first, split, true), right = number(split + 1, last, false);
    bool seen = false;
    for (const uint32_t node : {first, last}) {
      if (node >= count - 1) continue;
      const auto children = tree.childrenOf(node);
      seen |= children.left == left && children.right == right;
    }
    if (!seen) FAIL("no node for the range " << first << " to " << last);
    ++named[left];
    ++named[right];
  });
  for (const int times : named)
    if (times != 1) FAIL("a node with " << times << " parents");
}

}  // namespace

TEST_CASE("the radix tree is the one that its definition gives") {
  std::mt19937_64 draw(7);
  for (const uint32_t count : {2u, 3u, 4u, 5u, 8u, 9u, 31u, 32u, 33u, 500u, 1000u})
    for (const int bits : {0, 1, 3, 8, 20, 60, 64}) {
      INFO(count << " keys of " << bits << " bits");
      std::vector<uint64_t> keys(count);
      for (uint64_t& key : keys) key = bits ? draw() >> (64 - bits) : 42;
      std::sort(keys.begin(), keys.end());
      requireRadixTree(keys);
    }
  requireRadixTree({0, 1, 2, 4, 8, 16, 32, ~0ull >> 1, 1ull << 63, ~0ull, ~0ull, ~0ull});
}

namespace {

struct Plain {
  std::vector<Box> boxes;

  double area(const std::vector<uint32_t>& ids) const {
    Box all;
    for (const uint32_t i : ids) all.grow(boxes[i]);
    return all.area();
  }

  /// Σ cT·A + Σ cI·A of the full sweep, each split's cost computed from its boxes anew: O(n²) per node.
  double cost(const std::vector<uint32_t>& ids) const {
    if (ids.size() == 1) return 2 * area(ids);
    double best = INFINITY;
    std::size_t bestUneven = 0;
    std::vector<uint32_t> bestLeft, bestRight;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<uint32_t> sorted = ids;
      std::sort(sorted.begin(), sorted.end(), [&](uint32_t a, uint32_t b) {
        const float x = boxes[a].centre2()[axis], y = boxes[b].centre2()[axis];
        return x != y ? x < y : a < b;
      });
      for (std::size_t at = 1; at < sorted.size(); ++at) {
        const std::vector<uint32_t> left(sorted.begin(), sorted.begin() + at), right(sorted.begin() + at, sorted.end());
        const double sum = area(left) * left.size() + area(right) * right.size();
        const std::size_t uneven = std::max(left.size(), right.size());
        if (sum < best || (sum == best && uneven < bestUneven)) {
          best = sum;
          bestUneven = uneven;
          bestLeft = left;
          bestRight = right;
        }
      }
    }
    return 3 * area(ids) + cost(bestLeft) + cost(bestRight);
  }
};

Plain plainOf(const test::TestMesh& mesh) {
  Plain plain{std::vector<Box>(mesh.count())};
  for (uint32_t i = 0; i < mesh.count(); ++i)
    for (int corner = 0; corner < 3; ++corner) plain.boxes[i].grow(mesh.positions[mesh.indices[i][corner]]);
  return plain;
}

}  // namespace

TEST_CASE("the sweep finds what trying every split anew finds") {
  const Device device = openDevice("cpu");
  Parameters single;
  single.set("leaf.max=1");
  for (const char* name : {"random", "coplanar", "one-huge", "two-clusters", "negative"})
    for (const uint32_t count : {2u, 3u, 5u, 17u, 60u})
      for (uint32_t seed = 1; seed <= 3; ++seed) {
        INFO(name << ", " << count << " triangles, seed " << seed);
        const test::TestMesh mesh = test::makeInput(name, count, seed);
        const Plain plain = plainOf(mesh);
        std::vector<uint32_t> all(count);
        for (uint32_t i = 0; i < count; ++i) all[i] = i;
        const Bvh bvh = test::treeOf(device, mesh, "sah", single);
        REQUIRE(statistics(device, bvh, single).sahCost == Approx(plain.cost(all) / plain.area(all)).epsilon(1e-5));
      }
}

TEST_CASE("sweeping the axes at once or in turn gives one tree") {
  // Over 32768 triangles several threads sweep all axes of a node at the same time; one thread takes turns.
  const test::TestMesh mesh = test::makeInput("random", 70000);
  const Device device = openDevice("cpu", 1);
  const bool same = test::bitsOf(test::treeOf(device, mesh, "sah")) ==
                    test::bitsOf(test::treeOf(test::withThreads(device, 4), mesh, "sah"));
  CHECK(same);
}

TEST_CASE("the sweep halves where all splits cost the same and stays shallow where rounding decides") {
  const Device device = openDevice("cpu");
  Parameters single;
  single.set("leaf.max=1");
  const auto depthOf = [&](const test::TestMesh& mesh) {
    return statistics(device, test::treeOf(device, mesh, "sah", single), single).depth;
  };
  CHECK(depthOf(test::makeInput("collinear", 10000)) == 14);
  CHECK(depthOf(test::makeInput("equal-centres", 10000)) == 14);

  // A pile of sheets so thin that its height adds nothing to an area: rounding alone decides where it is cut.
  test::TestMesh pile;
  for (uint32_t i = 0; i < 3000; ++i) {
    const float x = 1e-12f * static_cast<float>(i);
    pile.positions.insert(pile.positions.end(), {vec3(x, 0, 0), vec3(x, 0.7391f, 0), vec3(x, 0, 1.3337f)});
    pile.indices.push_back(uvec3(3 * i, 3 * i + 1, 3 * i + 2));
  }
  CHECK(depthOf(pile) <= 64 + 12);
}

TEST_CASE("by count, every node of at most leaf.max triangles is a leaf and no other") {
  for (const Device& device : test::devices()) {
    const test::TestMesh mesh = test::makeInput("random", 3000);
    for (const int64_t most : {1, 2, 8, 64}) {
      INFO("leaf.max " << most);
      Parameters parameters;
      parameters.set("leaf.rule=count");
      parameters.set("leaf.max", most);
      const Bvh bvh = test::treeOf(device, mesh, "lbvh", parameters);
      test::requireValid(device, bvh, mesh, static_cast<uint32_t>(most));
      const auto nodes = bvh.nodes.toHost(bvh.nodeCount);
      std::function<uint32_t(uint32_t)> below = [&](uint32_t at) -> uint32_t {
        if (nodes[at].isLeaf()) return nodes[at].count();
        const uint32_t count = below(nodes[at].left) + below(nodes[at].right);
        REQUIRE(count > most);
        return count;
      };
      REQUIRE(below(0) == 3000);
    }
  }
}

TEST_CASE("by cost, leaves are those of the cheapest tree over the same splits") {
  const Device device = test::chosenDevice();
  for (const char* name : {"random", "grid", "one-huge"})
    for (const BuilderEntry& builder : builders()) {
      const test::TestMesh mesh = test::makeInput(name, 2000);
      Parameters single;
      single.set("leaf.max=1");
      const Bvh whole = collapseAndLayout(device, test::rawTreeOf(device, mesh, builder.name), single);
      const auto nodes = whole.nodes.toHost(whole.nodeCount);
      struct Best {
        double cost;
        uint32_t count;
      };
      std::function<Best(uint32_t)> best = [&](uint32_t at) -> Best {
        const double area = nodes[at].box().area();
        if (nodes[at].isLeaf()) return {2 * area, 1};
        const Best left = best(nodes[at].left), right = best(nodes[at].right);
        const uint32_t count = left.count + right.count;
        const double split = 3 * area + left.cost + right.cost;
        return {count <= 8 ? std::min(split, 2 * area * count) : split, count};
      };
      INFO(builder.name << " on " << name);
      const double expected = best(0).cost / nodes[0].box().area();
      const double found = statistics(device, test::treeOf(device, mesh, builder.name), {}).sahCost;
      REQUIRE(found == Approx(expected).epsilon(1e-4));
      REQUIRE(found < statistics(device, whole, {}).sahCost);
    }
}

TEST_CASE("pairs of siblings stand in the order that their parents have in the builder's tree") {
  for (const Device& device : test::devices())
    for (const char* name : {"random", "one-huge"})
      for (const BuilderEntry& builder : builders())
        for (const char* leaves : {"leaf.max=1", "leaf.max=8", "leaf.rule=count"}) {
          INFO(builder.name << " on " << name << ", " << leaves << ", " << device.name);
          Parameters parameters;
          parameters.set(leaves);
          const test::TestMesh mesh = test::makeInput(name, 2000);
          OpenTree raw = test::rawTreeOf(device, mesh, builder.name);
          const auto before = raw.nodes.toHost(raw.nodeCount);
          const Bvh bvh = collapseAndLayout(device, std::move(raw), parameters);
          const auto after = bvh.nodes.toHost(bvh.nodeCount);
          std::vector<std::pair<uint32_t, uint32_t>> staying, waiting{{0, 0}};  // In the old tree, and in the new one.
          while (!waiting.empty()) {
            const auto [from, to] = waiting.back();
            waiting.pop_back();
            if (after[to].isLeaf()) continue;
            staying.emplace_back(from, to);
            waiting.emplace_back(before[from].left, after[to].left);
            waiting.emplace_back(before[from].right, after[to].right);
          }
          std::sort(staying.begin(), staying.end());
          REQUIRE(2 * staying.size() + 1 == after.size());
          for (uint32_t rank = 0; rank < staying.size(); ++rank)
            if (const BvhNode& node = after[staying[rank].second];
                node.left != 1 + 2 * rank || node.right != 2 + 2 * rank)
              FAIL("rank " << rank << " has children " << node.left << ", " << node.right);
        }
}

TEST_CASE("leaves whose triangles are scattered in the order are gathered") {
  // A tree whose leaves stand in the order of their nodes while its splits do not follow it.
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput("identical", 4);
  const Box box = plainOf(mesh).boxes[0];
  const std::vector<BvhNode> nodes{BvhNode::inner(box, 1, 2), BvhNode::inner(box, 3, 5), BvhNode::inner(box, 4, 6),
                                   BvhNode::leaf(box, 0, 1),  BvhNode::leaf(box, 1, 1),  BvhNode::leaf(box, 2, 1),
                                   BvhNode::leaf(box, 3, 1)};
  OpenTree tree;
  tree.nodes = Buffer<BvhNode>(device, nodes);
  tree.order = Buffer<uint32_t>(device, std::vector<uint32_t>{3, 1, 0, 2});
  tree.nodeCount = 7;
  tree.referenceCount = tree.triangleCount = 4;
  Parameters parameters;
  parameters.set("leaf.rule=count");
  parameters.set("leaf.max=2");
  const Bvh bvh = collapseAndLayout(device, std::move(tree), parameters);
  test::requireValid(device, bvh, mesh, 2);
  CHECK(bvh.nodeCount == 3);
  CHECK(bvh.order.toHost() == std::vector<uint32_t>{0, 3, 1, 2});
}
