// Agglomerative clustering: how many clusters stay, lists shortened beside a plain version of the same, and trees of
// inputs whose codes say nothing.
#include <algorithm>
#include <cmath>

#include "builder/methods/aac/clusters.h"
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

TEST_CASE("as many clusters stay as the paper's function says") {
  const auto hq = [](uint32_t count) { return aac::keptOf(20, 0.1, count); };
  const auto fast = [](uint32_t count) { return aac::keptOf(4, 0.2, count); };
  CHECK(hq(20) == 10);
  CHECK(hq(100) == 20);
  CHECK(hq(1000) == 48);
  CHECK(hq(10000) == 121);
  CHECK(hq(1000000) == 758);
  CHECK(fast(4) == 2);
  CHECK(fast(100) == 6);
  CHECK(fast(1000) == 11);
  CHECK(fast(1000000) == 84);
  // Half of delta stays at delta, whatever rounding does to the power.
  for (uint32_t delta = 2; delta <= 1000; delta += 2)
    for (const double epsilon : {0.0, 0.05, 0.1, 0.2, 0.37, 0.5})
      REQUIRE(aac::keptOf(delta, epsilon, delta) == delta / 2);
  CHECK(aac::keptOf(2, 0.5, 1000000) == 1);
}

namespace {

std::vector<Box> randomBoxes(uint32_t count, uint32_t seed) {
  const test::TestMesh mesh = test::makeInput("random", count, seed);
  std::vector<Box> boxes(count);
  for (uint32_t i = 0; i < 3 * count; ++i) boxes[i / 3].grow(mesh.positions[i]);
  return boxes;
}

/// The boxes that are left when the closest two are joined until `target` are left; every pair anew each time.
std::vector<float> plainAreas(std::vector<Box> boxes, std::size_t target) {
  while (boxes.size() > target) {
    std::size_t a = 0, b = 1;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t j = i + 1; j < boxes.size(); ++j)
        if (unite(boxes[i], boxes[j]).area() < unite(boxes[a], boxes[b]).area()) a = i, b = j;
    boxes[a] = unite(boxes[a], boxes[b]);
    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
  }
  std::vector<float> areas;
  for (const Box& box : boxes) areas.push_back(box.area());
  std::sort(areas.begin(), areas.end());
  return areas;
}

/// Lists of clusters over one set of boxes, with room for all the joins there can be.
struct Lists {
  std::vector<Box> boxes;
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> parents;
  aac::Shortener shortener;

  explicit Lists(const std::vector<Box>& from) : boxes(from), nodes(2 * from.size()), parents(2 * from.size()) {}

  std::vector<aac::Cluster> of(uint32_t begin, uint32_t end) const {
    std::vector<aac::Cluster> list(end - begin);
    for (uint32_t i = begin; i < end; ++i) {
      list[i - begin].box = boxes[i];
      list[i - begin].node = static_cast<uint32_t>(boxes.size()) - 1 + i;
      list[i - begin].spare = i;
      list[i - begin].size = 1;
    }
    return list;
  }
  void shorten(std::vector<aac::Cluster>& list, uint32_t half, uint32_t target) {
    shortener.shorten(list, half, target, {nodes.data(), parents.data()});
  }
};

std::vector<float> areasOf(const std::vector<aac::Cluster>& list) {
  std::vector<float> areas;
  for (const aac::Cluster& cluster : list) areas.push_back(cluster.box.area());
  std::sort(areas.begin(), areas.end());
  return areas;
}

/// Every cluster's nearest is the nearest there is.
void requireNearest(const std::vector<aac::Cluster>& list) {
  for (uint32_t i = 0; i < list.size(); ++i) {
    float least = INFINITY;
    for (uint32_t j = 0; j < list.size(); ++j)
      if (j != i) least = std::min(least, unite(list[i].box, list[j].box).area() / 2);
    REQUIRE(list[i].distance == Approx(least));
    if (list.size() > 1) {
      REQUIRE(list[i].nearest != i);
      REQUIRE(unite(list[i].box, list[list[i].nearest].box).area() / 2 == Approx(least));
    }
  }
}

}  // namespace

TEST_CASE("a list is shortened as joining the closest pair of all would shorten it") {
  for (const uint32_t count : {2u, 3u, 7u, 8u, 9u, 16u, 17u, 60u})
    for (const uint32_t target : {1u, 2u, 5u, 30u}) {
      if (target > count) continue;
      INFO(count << " clusters to " << target);
      Lists lists(randomBoxes(count, count + target));
      auto list = lists.of(0, count);
      lists.shorten(list, 0, target);
      REQUIRE(list.size() == target);
      REQUIRE(areasOf(list) == plainAreas(lists.boxes, target));
      requireNearest(list);
    }
}

TEST_CASE("two halves that know their own nearest make the list that knows none") {
  for (const uint32_t half : {1u, 5u, 8u, 20u, 39u}) {
    INFO("halves of " << half << " and " << 40 - half);
    Lists lists(randomBoxes(40, half));
    auto list = lists.of(0, half), right = lists.of(half, 40);
    lists.shorten(list, 0, half);
    lists.shorten(right, 0, 40 - half);
    requireNearest(right);
    list.insert(list.end(), right.begin(), right.end());
    lists.shorten(list, half, 12);
    REQUIRE(areasOf(list) == plainAreas(lists.boxes, 12));
    requireNearest(list);
  }
}

TEST_CASE("equal clusters are joined two and two") {
  const uint32_t count = 256;
  Lists lists(std::vector<Box>(count, randomBoxes(1, 1)[0]));
  auto list = lists.of(0, count);
  lists.shorten(list, 0, 1);
  REQUIRE(list.size() == 1);
  uint32_t deepest = 0;
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t depth = 0;
    for (uint32_t at = count - 1 + i; at != list[0].node; at = lists.parents[at]) ++depth;
    deepest = std::max(deepest, depth);
  }
  CHECK(deepest == 8);
}

TEST_CASE("clusters whose boxes reach to infinity or hold no number are joined too") {
  std::vector<Box> boxes = randomBoxes(20, 3);
  for (uint32_t i = 0; i < 20; i += 3) boxes[i].hi = vec3(INFINITY);
  boxes[4] = boxes[5] = boxes[7] = Box{};
  boxes[8].lo.x = boxes[10].lo.x = NAN;
  Lists lists(boxes);
  auto list = lists.of(0, 20);
  lists.shorten(list, 0, 3);
  REQUIRE(list.size() == 3);
  lists.shorten(list, 0, 1);
  REQUIRE(list[0].size == 20);
}

TEST_CASE("clustering of any first size is valid, with codes of few bits and equal boxes too", "[medium]") {
  const Device device = openDevice("cpu");
  for (const char* name : {"random", "identical", "equal-centres", "grid", "shrinking"})
    for (const char* delta : {"aac.delta=2", "aac.delta=3", "aac.delta=7", "aac.delta=64"})
      for (const char* epsilon : {"aac.epsilon=0", "aac.epsilon=0.5"})
        for (const char* bits : {"morton.bits=1", "morton.bits=21"}) {
          INFO(name << ", " << delta << ", " << epsilon << ", " << bits);
          Parameters parameters;
          for (const char* each : {delta, epsilon, bits}) parameters.set(each);
          const test::TestMesh mesh = test::makeInput(name, 5000);
          const Bvh bvh = test::treeOf(device, mesh, "aac-hq", parameters);
          test::requireValid(device, bvh, mesh, 8);
          const bool same =
              test::bitsOf(test::treeOf(test::withThreads(device, 5), mesh, "aac-hq", parameters)) == test::bitsOf(bvh);
          REQUIRE(same);
        }
}

TEST_CASE("clustering leaves parents that fit its nodes") {
  const Device device = openDevice("cpu");
  for (const char* builder : {"aac-fast", "aac-hq"})
    for (const uint32_t size : {1u, 2u, 3u, 100u, 3000u}) {
      INFO(builder << ", " << size << " triangles");
      const OpenTree bvh = test::rawTreeOf(device, test::makeInput("random", size), builder);
      const auto nodes = bvh.nodes.toHost(bvh.nodeCount);
      const auto parents = bvh.parents.toHost(bvh.nodeCount);
      REQUIRE(parents[0] == 0x7fffffffu);
      for (uint32_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].isLeaf()) continue;
        REQUIRE(parents[nodes[i].left] == i);
        REQUIRE(parents[nodes[i].right] == i);
      }
    }
}
