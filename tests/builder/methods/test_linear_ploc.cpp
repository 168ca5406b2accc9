// Locally-ordered clustering against plain loops over all pairs within the radius.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "builder/methods/lbvh.h"
#include "builder/primitives/morton_order.h"
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

using Places = std::vector<uint32_t>;  ///< Of leaves in Morton order, ascending.

struct Cluster {
  Box box;
  Places places;
};

/// What has become of a list, and every subtree that was made on the way.
struct Plain {
  std::vector<Box> boxes;
  RadixTree tree;
  uint32_t radius;
  std::set<Places> subtrees = {};

  static float joinedArea(const Box& a, const Box& b) {
    const vec3 d = maxOf(a.hi, b.hi) - minOf(a.lo, b.lo);
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }

  std::size_t nearest(const std::vector<Cluster>& list, std::size_t i) const {
    std::tuple<float, std::size_t, std::size_t, std::size_t, std::size_t> best{INFINITY, 0, 0, 0, i ^ 1};
    for (std::size_t j = i < radius ? 0 : i - radius; j <= i + radius && j < list.size(); ++j) {
      if (j == i) continue;
      const std::size_t low = std::min(i, j);
      best = std::min(best, {joinedArea(list[i].box, list[j].box), std::max(i, j) - low, low % 2, low, j});
    }
    return std::get<4>(best);
  }

  void round(std::vector<Cluster>& list) {
    std::vector<std::size_t> partner(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) partner[i] = nearest(list, i);
    std::vector<Cluster> left;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::size_t j = partner[i];
      const bool mutual = j < list.size() && partner[j] == i;
      if (mutual && j < i) continue;
      left.push_back(list[i]);
      if (!mutual) continue;
      Cluster& joined = left.back();
      joined.box.grow(list[j].box);
      joined.places.insert(joined.places.end(), list[j].places.begin(), list[j].places.end());
      std::ranges::sort(joined.places);
      subtrees.insert(joined.places);
    }
    list = std::move(left);
  }

  std::vector<Cluster> leaves(uint32_t begin, uint32_t end) const {
    std::vector<Cluster> list;
    for (uint32_t i = begin; i < end; ++i) list.push_back({boxes[i], {i}});
    return list;
  }

  /// hploc's list for a node of the radix tree: those of its children, shortened.
  std::vector<Cluster> along(uint32_t node) {
    if (node + 1 >= tree.count) return leaves(node + 1 - tree.count, node + 2 - tree.count);
    const RadixTree::Children children = tree.childrenOf(node);
    std::vector<Cluster> list = along(children.left);
    for (Cluster& cluster : along(children.right)) list.push_back(std::move(cluster));
    while (list.size() > (node == 0 ? 1 : 16)) round(list);
    return list;
  }
};

std::set<Places> subtreesOf(const OpenTree& tree) {
  const std::vector<BvhNode> nodes = tree.nodes.toHost(tree.nodeCount);
  std::set<Places> subtrees;
  const auto walk = [&](const auto& self, uint32_t at) -> Places {
    if (nodes[at].isLeaf()) return {nodes[at].first()};
    Places places = self(self, nodes[at].left);
    const Places right = self(self, nodes[at].right);
    places.insert(places.end(), right.begin(), right.end());
    std::ranges::sort(places);
    subtrees.insert(places);
    return places;
  };
  walk(walk, 0);
  return subtrees;
}

Plain plainOf(const Device& device, const test::TestMesh& mesh, std::vector<uint64_t>& keys, uint32_t radius) {
  const test::DeviceMesh onDevice(device, mesh);
  const OwnedPrimitives primitives = primitivesOf(device, onDevice.view());
  const MortonOrder sorted = mortonOrder(device, primitives.view(), Parameters{});
  const std::vector<uint32_t> order = sorted.order.toHost(sorted.order.size());
  keys = sorted.keys.toHost(sorted.keys.size());
  Plain plain{{}, {keys.data(), static_cast<uint32_t>(keys.size())}, radius};
  std::vector<Box> boxes(keys.size());
  copyToHost(device, boxes.data(), primitives.view().boxes, boxes.size() * sizeof(Box));
  for (const uint32_t i : order) plain.boxes.push_back(boxes[i]);
  return plain;
}

}  // namespace

TEST_CASE("ploc joins who is each other's nearest within the radius, round by round") {
  for (const Device& device : test::devices())
    for (const std::string& name : test::inputNames())
      for (const auto& [size, radius] : {std::pair{2u, 25u}, {3, 1}, {40, 3}, {700, 8}, {1500, 25}}) {
        INFO(name << ", " << size << " triangles, radius " << radius << ", " << device.name);
        const test::TestMesh mesh = test::makeInput(name, size);
        std::vector<uint64_t> keys;
        Plain plain = plainOf(device, mesh, keys, radius);
        std::vector<Cluster> list = plain.leaves(0, static_cast<uint32_t>(keys.size()));
        while (list.size() > 1) plain.round(list);
        Parameters parameters;
        parameters.set("ploc.radius", int64_t{radius});
        const bool same = subtreesOf(test::rawTreeOf(device, mesh, "ploc", parameters)) == plain.subtrees;
        REQUIRE(same);
      }
}

TEST_CASE("ploc with a growing radius begins with neighbours alone") {
  const Device device = openDevice("cpu");
  const test::TestMesh mesh = test::makeInput("random", 900);
  std::vector<uint64_t> keys;
  Plain plain = plainOf(device, mesh, keys, 0);
  std::vector<Cluster> list = plain.leaves(0, 900);
  for (; list.size() > 1; plain.round(list)) plain.radius = std::min(plain.radius + 1, 5u);
  Parameters parameters;
  parameters.set("ploc.radius=5");
  parameters.set("ploc.radius_by_round=growing");
  const bool same = subtreesOf(test::rawTreeOf(device, mesh, "ploc", parameters)) == plain.subtrees;
  REQUIRE(same);
}

TEST_CASE("hploc joins what two ranges of the radix tree have left until sixteen are left of both") {
  for (const Device& device : test::devices())
    for (const std::string& name : test::inputNames())
      for (const auto& [size, radius] : {std::pair{2u, 8u}, {16, 8}, {17, 1}, {40, 16}, {700, 8}}) {
        INFO(name << ", " << size << " triangles, radius " << radius << ", " << device.name);
        const test::TestMesh mesh = test::makeInput(name, size);
        std::vector<uint64_t> keys;
        Plain plain = plainOf(device, mesh, keys, radius);
        plain.along(0);
        Parameters parameters;
        parameters.set("hploc.radius", int64_t{radius});
        const bool same = subtreesOf(test::rawTreeOf(device, mesh, "hploc", parameters)) == plain.subtrees;
        REQUIRE(same);
      }
}
