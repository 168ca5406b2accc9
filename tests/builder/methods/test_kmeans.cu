// k-means trees beside a plain version of the method, one triangle after the other, that follows the paper's sections 4
// and 5; and beside themselves on other lanes and threads.
#include <algorithm>
#include <cmath>
#include <memory>

#include <sys/mman.h>

#include "builder/base/error.h"
#include "builder/methods/kmeans/build.h"
#include "tests/support/builder_checks.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/plain_kmeans.h"

using namespace copse;
using kmeans::Metric;
using kmeans::Settings;
using test::Plain;
using test::PlainNode;
using test::PlainTree;

namespace {

/// Not a lambda: nvcc takes those for the host alone.
struct DownFrom {
  uint32_t first;
  HD uint32_t operator()(uint32_t j) const { return first - j; }
};

OpenTree build(const Device& device, const test::TestMesh& mesh, const Settings& settings) {
  const test::DeviceMesh onDevice(device, mesh);
  const OwnedPrimitives primitives = primitivesOf(device, onDevice.view());
  return kmeans::build(device, primitives.view(), settings);
}

/// A tree on the host.
struct Tree {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  std::vector<uint8_t> joints;
  explicit Tree(const auto& bvh)
      : nodes(bvh.nodes.toHost(bvh.nodeCount)),
        order(bvh.order.toHost(bvh.referenceCount)),
        joints(bvh.joints.toHost()) {}
};

/// Where two trees first differ, from node `at` of the one; "" where they do not.
std::string difference(const Tree& tree, uint32_t at, const PlainNode& plain) {
  const BvhNode& node = tree.nodes[at];
  if (!tree.joints.empty() && tree.joints[at] != plain.joint) return "one is a joint";
  if (node.isLeaf() != !plain.left) return "one is a leaf";
  if (node.isLeaf()) return tree.order[node.first()] == plain.triangle ? "" : "other triangles";
  const std::string left = difference(tree, node.left, *plain.left);
  return left.empty() ? difference(tree, node.right, *plain.right) : left;
}

/// The cost of a tree of wide nodes by its definition, times the root's area, with cT = 3 and cI = 2; and the most
/// children of a node.
struct WideCost {
  const Tree& tree;
  uint32_t mostChildren = 0;

  std::vector<uint32_t> children(uint32_t at) const {
    std::vector<uint32_t> all;
    for (const uint32_t child : {tree.nodes[at].left, tree.nodes[at].right}) {
      const std::vector<uint32_t> below = tree.joints[child] ? children(child) : std::vector<uint32_t>{child};
      all.insert(all.end(), below.begin(), below.end());
    }
    return all;
  }
  double of(uint32_t at) {
    const BvhNode& node = tree.nodes[at];
    if (node.isLeaf()) return 2.0 * node.count() * node.box().area();
    double cost = 3.0 * node.box().area();
    const std::vector<uint32_t> below = children(at);
    mostChildren = std::max(mostChildren, static_cast<uint32_t>(below.size()));
    for (const uint32_t child : below) cost += of(child);
    return cost;
  }
};

/// The builder's arity of `arity`, and m.
Parameters wide(int64_t arity, int64_t m) {
  Parameters parameters;
  parameters.set("kmeans.arity", arity);
  parameters.set("kmeans.m", m);
  return parameters;
}

Settings settings(uint32_t k, uint32_t draws, uint32_t iterations, Metric metric = Metric::euclid) {
  Settings s{};
  s.k = k;
  s.draws = draws;
  s.iterations = iterations;
  s.seed = 7;
  s.leafQueueBelow = 8 * k;
  s.metric = metric;
  return s;
}

Settings plusPlus(Settings s) {
  s.plusPlus = true;
  return s;
}

/// Tries all metrics and ways of drawing, with k, p and i from the smallest to large ones.
void requirePlainTrees(const std::string& input) {
  const Settings all[] = {settings(2, 1, 0),
                          settings(3, 5, 2),
                          settings(8, 5, 0),
                          settings(8, 5, 2),
                          settings(9, 7, 4),
                          settings(16, 20, 30),
                          settings(64, 5, 3),
                          settings(64, 64, 0),
                          settings(8, 5, 2, Metric::manhattan),
                          settings(8, 5, 2, Metric::chebyshev),
                          settings(8, 5, 2, Metric::unionArea),
                          plusPlus(settings(8, 5, 2)),
                          plusPlus(settings(8, 5, 2, Metric::manhattan)),
                          plusPlus(settings(8, 5, 2, Metric::chebyshev)),
                          plusPlus(settings(8, 5, 2, Metric::unionArea))};
  for (const Device& device : test::devices())
    for (const uint32_t count : {1u, 2u, 3u, 15u, 17u, 600u, 2500u}) {
      if (count > test::many(6000)) continue;  // With a sanitizer, which makes it ten times as long.
      const test::TestMesh mesh = test::makeInput(input, count);
      for (Settings s : all)
        for (const uint32_t m : {1u, 8u}) {
          s.leafQueueBelow = m * s.k;
          s.arity = s.k <= maxArity ? s.k : 2;
          INFO(input << ", " << count << " triangles, k " << s.k << ", p " << s.draws << ", i " << s.iterations
                     << ", m " << m << ", metric " << static_cast<uint32_t>(s.metric) << ", " << device.name);
          const OpenTree bvh = build(device, mesh, s);
          REQUIRE(bvh.joints.empty() == (s.arity == 2));
          REQUIRE(difference(Tree(bvh), 0, *Plain(mesh, s).tree()) == "");
        }
    }
}
const test::Cases plainTrees("k-means trees are those of a plain version of the method", "[medium]",
                             {"random", "identical", "collinear", "grid", "one-huge", "shrinking", "tiny"},
                             requirePlainTrees);

void requireSameOnFibers(const std::string& input) {
  const Device device = openDevice("cpu");
  for (Settings s : {settings(8, 5, 0), settings(8, 5, 2), settings(33, 40, 5), settings(8, 5, 2, Metric::unionArea),
                     plusPlus(settings(8, 5, 2))}) {
    INFO(input << ", k " << s.k);
    const test::TestMesh mesh = test::makeInput(input, 3000);
    const auto expected = test::bitsOf(build(device, mesh, s));
    s.onFibers = true;
    const bool same = test::bitsOf(build(device, mesh, s)) == expected;
    REQUIRE(same);
  }
}
const test::Cases sameOnFibers("lanes that are fibers and threads that have whole groups build one k-means tree",
                               "[medium]", {"random", "grid", "identical", "one-huge"}, requireSameOnFibers);

void requireWideNodes(const std::string& input) {
  for (const Device& device : test::devices())
    for (const uint32_t count : {1u, 2u, 3u, 9u, 33u, 65u, 1025u, 20000u})
      for (const int64_t arity : {3, 4, 8})
        for (const char* rule : {"sah", "count"}) {
          INFO(input << ", " << count << " triangles, arity " << arity << ", leaf.rule " << rule);
          const test::TestMesh mesh = test::makeInput(input, count);
          Parameters parameters = wide(arity, count % 2 ? 1 : 4);
          parameters.set("leaf.rule", std::string(rule));
          const Bvh bvh = test::treeOf(device, mesh, "kmeans", parameters);
          REQUIRE(bvh.arity == arity);
          test::requireValid(device, bvh, mesh, 8);
          const Tree tree(bvh);
          WideCost cost{tree};
          const double area = tree.nodes[0].box().area(), whole = cost.of(0);
          const TreeStatistics found = statistics(device, bvh, parameters);
          REQUIRE(found.sahCost == Approx(area > 0 ? whole / area : 0).epsilon(1e-5));
          REQUIRE(found.nodes + std::count(tree.joints.begin(), tree.joints.end(), 1) == bvh.nodeCount);
          REQUIRE(found.arity == arity);
          REQUIRE(cost.mostChildren <= arity);
          if (input == "random" && count > 1000) REQUIRE(cost.mostChildren == arity);
        }
}
const test::Cases wideNodes(
    "k-means trees of wide nodes are valid, as wide as they may be and cost what their nodes and leaves do", "",
    test::inputNames(), requireWideNodes);

}  // namespace

TEST_CASE("k-means trees do not depend on how many triangles a team takes at a time") {
  const test::TestMesh mesh = test::makeInput("random", 5000);
  for (const Device& device : test::devices())
    for (const char* seeding : {"candidates", "plusplus"})
      for (const char* builder : {"kmeans-q1", "kmeans-q3"}) {
        Parameters parameters;
        parameters.set("kmeans.seeding", std::string(seeding));
        const auto expected = test::bitsOf(test::treeOf(device, mesh, builder, parameters));
        for (const int64_t size : {1, 96, 256, 1024, 65536}) {
          INFO(builder << ", " << seeding << ", " << size << " at a time, " << device.name);
          parameters.set("kmeans.chunk", size);
          const bool same = test::bitsOf(test::treeOf(device, mesh, builder, parameters)) == expected;
          REQUIRE(same);
        }
      }
}

TEST_CASE("marks of joints change nothing else in a k-means tree, and do not depend on threads or lanes") {
  const Device device = openDevice("cpu", 1);
  const test::TestMesh mesh = test::makeInput("random", 30000);
  Parameters binary;
  binary.set("kmeans.arity=2");
  binary.set("kmeans.k=8");
  const OpenTree marked = test::rawTreeOf(device, mesh, "kmeans", wide(8, 4));
  REQUIRE(test::bitsOf(marked) == test::bitsOf(test::rawTreeOf(device, mesh, "kmeans", binary)));
  const auto joints = marked.joints.toHost();
  for (const int threads : {2, 7})
    REQUIRE(test::rawTreeOf(test::withThreads(device, threads), mesh, "kmeans", wide(8, 4)).joints.toHost() == joints);
  Settings s = settings(8, 5, 2);
  s.arity = 8;
  const test::TestMesh small = test::makeInput("random", 3000);
  const auto expected = build(device, small, s).joints.toHost();
  s.onFibers = true;
  REQUIRE(build(device, small, s).joints.toHost() == expected);
}

TEST_CASE("an arity above two is the number of clusters, and another number is refused") {
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput("random", 3000);
  Parameters four = wide(4, 4), both = wide(4, 4);
  both.set("kmeans.k=4");
  CHECK(test::bitsOf(test::treeOf(device, mesh, "kmeans", four)) ==
        test::bitsOf(test::treeOf(device, mesh, "kmeans", both)));
  both.set("kmeans.k=8");
  CHECK_THROWS_AS(test::treeOf(device, mesh, "kmeans", both), InputError);
  CHECK_THROWS_WITH(test::treeOf(device, mesh, "kmeans-q3", both),
                    copse::test::Contains("expected the same kmeans.k, got "));
  CHECK(test::treeOf(device, mesh, "kmeans-q3", four).arity == 4);
  CHECK(withPreset(findBuilder("kmeans-q3"), four).integer("kmeans.k") == 4);
  CHECK(kmeans::settingsOf(four).k == 4);
  CHECK(test::treeOf(device, mesh, "kmeans-q1", wide(8, 4)).arity == 8);
}

TEST_CASE("k-means trees do not depend on the number of threads") {
  const test::TestMesh mesh = test::makeInput("random", 30000);
  for (const char* builder : {"kmeans-q1", "kmeans-q3", "kmeans-q5"}) {
    const Device device = openDevice("cpu", 1);
    const auto expected = test::bitsOf(test::treeOf(device, mesh, builder));
    for (const int threads : {2, 7}) {
      INFO(builder << ", " << threads << " threads");
      const bool same = test::bitsOf(test::treeOf(test::withThreads(device, threads), mesh, builder)) == expected;
      REQUIRE(same);
    }
  }
}

TEST_CASE("by every metric and both ways of drawing, k-means trees do not depend on the number of threads") {
  const test::TestMesh mesh = test::makeInput("random", 20000);
  const Device device = openDevice("cpu", 1);
  std::vector<std::vector<uint32_t>> trees;
  for (const char* metric : {"euclid", "manhattan", "chebyshev", "union-area"})
    for (const char* seeding : {"candidates", "plusplus"}) {
      INFO(metric << ", " << seeding);
      Parameters parameters;
      parameters.set("kmeans.distance", std::string(metric));
      parameters.set("kmeans.seeding", std::string(seeding));
      trees.push_back(test::bitsOf(test::treeOf(device, mesh, "kmeans", parameters)));
      for (const int threads : {2, 7}) {
        const Bvh other = test::treeOf(test::withThreads(device, threads), mesh, "kmeans", parameters);
        const bool same = test::bitsOf(other) == trees.back();
        REQUIRE(same);
      }
    }
  std::sort(trees.begin(), trees.end());
  CHECK(std::unique(trees.begin(), trees.end()) == trees.end());  // Each has its say.
}

TEST_CASE("one exchanged triangle, a turned node or a wrong mark is not the plain version's tree") {
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput("random", 600);
  Settings s = settings(8, 5, 2);
  s.arity = 8;
  const auto plain = Plain(mesh, s).tree();
  const Tree good(build(device, mesh, s));
  REQUIRE(difference(good, 0, *plain) == "");
  Tree bad = good;
  std::swap(bad.order[100], bad.order[101]);
  CHECK(difference(bad, 0, *plain) == "other triangles");
  bad = good;
  for (BvhNode& node : bad.nodes)
    if (!node.isLeaf() && bad.nodes[node.left].isLeaf() != bad.nodes[node.right].isLeaf()) {
      std::swap(node.left, node.right);
      break;
    }
  CHECK(difference(bad, 0, *plain) == "one is a leaf");
  bad = good;
  bad.joints[bad.nodes[0].left] ^= 1;
  CHECK(difference(bad, 0, *plain) == "one is a joint");
}

TEST_CASE("a group is read from beyond the first 2^32 floats of a segment") {
  // Address space alone: of 16 GiB a few pages are touched.
  const std::size_t beyond = (std::size_t{1} << 29) + 1000, bytes = (beyond + 1) * sizeof(kmeans::UnitBox);
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) {
    WARN("no address space of 16 GiB: not tested");
    return;
  }
  auto* const boxes = static_cast<kmeans::UnitBox*>(memory);
  for (uint32_t j = 0; j < 16; ++j)
    for (uint32_t d = 0; d < 6; ++d) boxes[beyond - j][d] = static_cast<float>(10 * j + d);
  OneLane lane(nullptr);
  const auto group = kmeans::Group<OneLane>::load(lane, boxes, 16, DownFrom{uint32_t(beyond)});
  for (uint32_t d = 0; d < 6; ++d) {
    float values[16];
    (d < 3 ? group.lo[d] : group.hi[d - 3]).store(values);
    for (uint32_t j = 0; j < 16; ++j) CHECK(values[j] == static_cast<float>(10 * j + d));
  }
  munmap(memory, bytes);
}

TEST_CASE("seeds give other k-means trees, and the presets have the paper's k, p and i") {
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput("random", 3000);
  Parameters other;
  other.set("kmeans.seed=2");
  CHECK(test::bitsOf(test::treeOf(device, mesh, "kmeans-q2")) !=
        test::bitsOf(test::treeOf(device, mesh, "kmeans-q2", other)));
  const std::tuple<const char*, int, int, int> presets[] = {
      {"kmeans-q1", 8, 5, 0},    {"kmeans-q2", 8, 5, 2},    {"kmeans-q3", 16, 5, 5},
      {"kmeans-q4", 32, 20, 10}, {"kmeans-q5", 64, 30, 15}, {"kmeans-r1", 8, 5, 2},
      {"kmeans-r2", 16, 5, 2},   {"kmeans-r3", 32, 20, 2},  {"kmeans-r4", 64, 30, 2}};
  for (const auto& [name, k, p, i] : presets) {
    INFO(name);
    const Parameters parameters = withPreset(findBuilder(name), {});
    CHECK(parameters.integer("kmeans.k") == k);
    CHECK(parameters.integer("kmeans.p") == p);
    CHECK(parameters.integer("kmeans.i") == i);
    CHECK(parameters.integer("kmeans.m") == 4);
  }
}
