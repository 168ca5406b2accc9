// k-means trees beside a plain version of the method, one triangle after the other, that follows the paper's sections 4
// and 5; and beside themselves on other lanes and threads.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <tuple>

#include <sys/mman.h>

#include "builder/math/morton.h"
#include "builder/methods/kmeans/build.h"
#include "builder/methods/kmeans/plusplus.h"
#include "builder/parallel/error.h"
#include "tests/support/builder_checks.h"
#include "tests/support/devices.h"

using namespace copse;
using kmeans::Metric;
using kmeans::Settings;
using kmeans::UnitBox;

namespace {

/// Not a lambda: nvcc takes those for the host alone.
struct DownFrom {
  uint32_t first;
  HD uint32_t operator()(uint32_t j) const { return first - j; }
};

struct PlainNode {
  uint32_t triangle = 0;
  bool joint = false;  ///< Joins some children of a node of k.
  std::unique_ptr<PlainNode> left, right;
};
using PlainTree = std::unique_ptr<PlainNode>;

/// The method by its definition: recursive, all distances anew in each of i iterations, sums in whole numbers, all
/// pairs tried in each step of the agglomeration.
class Plain {
 public:
  Plain(const test::TestMesh& mesh, const Settings& settings) : settings_(settings) {
    const uint32_t n = mesh.count();
    std::vector<Box> boxes(n);
    Box bounds;
    for (uint32_t i = 0; i < n; ++i) {
      for (int corner = 0; corner < 3; ++corner) boxes[i].grow(mesh.positions[mesh.indices[i][corner]]);
      bounds.grow(boxes[i]);
    }
    const MortonGrid grid = MortonGrid::over(bounds, 10, true);
    std::vector<uint32_t> order(n);
    for (uint32_t i = 0; i < n; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return grid.code(boxes[a].centre2()) < grid.code(boxes[b].centre2());
    });
    const vec3 extent = bounds.hi - bounds.lo;
    const float longest = std::max({extent.x, extent.y, extent.z});
    const float scale = longest > 0 ? 1 / longest : 0;
    for (const uint32_t id : order) {
      UnitBox box{};
      for (int d = 0; d < 3; ++d) {
        box.lo[d] = std::clamp((boxes[id].lo[d] - bounds.lo[d]) * scale, 0.0f, 1.0f);
        box.hi[d] = std::clamp((boxes[id].hi[d] - bounds.lo[d]) * scale, 0.0f, 1.0f);
      }
      box.id = id;
      all_.push_back(box);
    }
  }

  PlainTree tree() const { return all_.empty() ? nullptr : split(all_, 0); }

 private:
  using Boxes = std::vector<UnitBox>;

  float distance(const UnitBox& b, const UnitBox& r) const {
    float e[6];
    for (uint32_t d = 0; d < 6; ++d) e[d] = b[d] - r[d];
    if (settings_.metric == Metric::euclid)
      return (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) + (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    for (float& x : e) x = std::fabs(x);
    if (settings_.metric == Metric::manhattan) return (e[0] + e[1] + e[2]) + (e[3] + e[4] + e[5]);
    if (settings_.metric == Metric::chebyshev) return *std::max_element(e, e + 6);
    float side[3];
    for (int d = 0; d < 3; ++d) side[d] = std::max(b.hi[d], r.hi[d]) - std::min(b.lo[d], r.lo[d]);
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }

  Boxes drawPlusPlus(const Boxes& segment, uint32_t first, uint32_t k) const {
    const auto n = static_cast<uint32_t>(segment.size());
    Boxes chosen{segment[kmeans::Draws(settings_.seed, first, n).below(n)]};
    std::vector<float> distances(n, INFINITY);
    float largest = 0;
    for (uint32_t c = 1; c < k; ++c) {
      uint64_t total = 0;
      for (uint32_t i = 0; i < n; ++i) distances[i] = std::min(distances[i], distance(segment[i], chosen.back()));
      if (c == 1) largest = *std::max_element(distances.begin(), distances.end());
      for (const float d : distances) total += kmeans::shareOf(d, largest);
      uint64_t rest = kmeans::drawBelow(settings_, c, first, n, total ? total : n);
      uint32_t at = 0;
      if (total == 0) at = static_cast<uint32_t>(rest);
      for (; total && rest >= kmeans::shareOf(distances[at], largest); ++at)
        rest -= kmeans::shareOf(distances[at], largest);
      chosen.push_back(segment[at]);
    }
    return chosen;
  }

  Boxes draw(const Boxes& segment, uint32_t first, uint32_t k) const {
    if (settings_.plusPlus) return drawPlusPlus(segment, first, k);
    const auto n = static_cast<uint32_t>(segment.size());
    kmeans::Draws draws(settings_.seed, first, n);
    Boxes chosen;
    while (chosen.size() < k) {
      const uint32_t candidates = chosen.empty() ? 1 : settings_.draws;
      UnitBox best{};
      float farthest = -1;
      for (uint32_t j = 0; j < candidates; ++j) {
        const auto bound = [&](uint64_t run) {  // Where one of the equal runs of the segment begins.
          return static_cast<uint32_t>(run * (((uint64_t{n} << 32) + candidates - 1) / candidates) >> 32);
        };
        const UnitBox& box = segment[bound(j) + draws.below(std::min(bound(j + 1), n) - bound(j))];
        float nearest = INFINITY;
        for (const UnitBox& r : chosen) nearest = std::min(nearest, distance(box, r));
        if (nearest > farthest) {
          farthest = nearest;
          best = box;
        }
      }
      chosen.push_back(best);
    }
    return chosen;
  }

  std::vector<uint32_t> assign(const Boxes& segment, const Boxes& reps) const {
    bool same = true;
    for (const UnitBox& r : reps)
      for (uint32_t d = 0; d < 6; ++d) same = same && r[d] == reps[0][d];
    std::vector<uint32_t> clusters;
    std::size_t powerOfTwo = 1;
    while (powerOfTwo < segment.size()) powerOfTwo *= 2;
    for (std::size_t i = 0; i < segment.size(); ++i) {
      uint32_t nearest = 0;
      for (uint32_t c = 1; c < reps.size(); ++c)
        if (distance(segment[i], reps[c]) < distance(segment[i], reps[nearest])) nearest = c;
      clusters.push_back(same ? static_cast<uint32_t>(i * reps.size() / powerOfTwo) : nearest);
    }
    return clusters;
  }

  void moveToMeans(const Boxes& segment, const std::vector<uint32_t>& clusters, Boxes& reps) const {
    const double scale = kmeans::fixedScale(static_cast<uint32_t>(segment.size()));
    for (uint32_t c = 0; c < reps.size(); ++c)
      for (uint32_t d = 0; d < 6; ++d) {
        int64_t sum = 0, count = 0;
        for (std::size_t i = 0; i < segment.size(); ++i)
          if (clusters[i] == c) {
            sum += std::llrint(static_cast<double>(segment[i][d]) * scale);
            ++count;
          }
        if (count) reps[c][d] = static_cast<float>(static_cast<double>(sum) / (static_cast<double>(count) * scale));
      }
  }

  PlainTree split(const Boxes& segment, uint32_t first) const {
    const auto n = static_cast<uint32_t>(segment.size());
    if (n == 1) {
      auto leaf = std::make_unique<PlainNode>();
      leaf->triangle = segment[0].id;
      return leaf;
    }
    const bool refined = n < settings_.leafQueueBelow;
    Boxes reps = draw(segment, first, refined ? 2 : settings_.k);
    std::vector<uint32_t> clusters;
    for (uint32_t t = 0; t < settings_.iterations; ++t) moveToMeans(segment, assign(segment, reps), reps);
    clusters = assign(segment, reps);
    if (n == 2 && refined) clusters = {0, 1};
    if (std::all_of(clusters.begin(), clusters.end(), [&](uint32_t c) { return c == clusters[0]; }))
      for (uint32_t i = 0; i < n; ++i) clusters[i] = i >= n / 2;
    std::vector<Joined> kids;
    for (uint32_t c = 0; c < reps.size(); ++c) {
      Boxes part;
      for (uint32_t i = 0; i < n; ++i)
        if (clusters[i] == c) part.push_back(segment[i]);
      if (part.empty()) continue;
      Joined kid;
      for (const UnitBox& b : part) kid.box.grow(b.box());
      kid.tree = split(part, first);
      first += static_cast<uint32_t>(part.size());
      kids.push_back(std::move(kid));
    }
    return agglomerate(std::move(kids));
  }

  struct Joined {
    PlainTree tree;
    Box box;
    uint32_t members = 1;
  };
  static PlainTree agglomerate(std::vector<Joined> kids) {
    while (kids.size() > 1) {
      std::tuple<float, float, uint32_t> least{INFINITY, 0, 0};
      std::size_t a = 0, b = 1;
      for (std::size_t i = 0; i < kids.size(); ++i)
        for (std::size_t j = i + 1; j < kids.size(); ++j) {
          const Box box = unite(kids[i].box, kids[j].box);
          const vec3 s = box.hi - box.lo;
          const std::tuple<float, float, uint32_t> cost{s.x * s.y + s.y * s.z + s.z * s.x, s.x + s.y + s.z,
                                                        kids[i].members + kids[j].members};
          if (cost < least) {
            least = cost;
            a = i;
            b = j;
          }
        }
      auto node = std::make_unique<PlainNode>();
      node->left = std::move(kids[a].tree);
      node->right = std::move(kids[b].tree);
      node->joint = kids.size() > 2;
      kids[a].tree = std::move(node);
      kids[a].box.grow(kids[b].box);
      kids[a].members += kids[b].members;
      if (b + 1 != kids.size()) kids[b] = std::move(kids.back());
      kids.pop_back();
    }
    return std::move(kids[0].tree);
  }

  Settings settings_;
  Boxes all_;
};

Bvh build(const Device& device, const test::TestMesh& mesh, const Settings& settings) {
  const test::DeviceMesh onDevice(device, mesh);
  BuildInput input{};
  const Buffer<Box> boxes = triangleBoxes(device, onDevice.view(), input.bounds);
  input.boxes = boxes.data();
  input.count = mesh.count();
  return kmeans::build(device, input, settings);
}

/// A tree on the host.
struct Tree {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  std::vector<uint8_t> joints;
  explicit Tree(const Bvh& bvh)
      : nodes(bvh.nodes.toHost(bvh.nodeCount)),
        order(bvh.order.toHost(bvh.primitiveCount)),
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

}  // namespace

TEST_CASE("k-means trees are those of a plain version of the method") {
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
    for (const char* name : {"random", "identical", "collinear", "grid", "one-huge", "shrinking", "tiny"})
      for (const uint32_t count : {1u, 2u, 3u, 15u, 17u, 600u, 2500u})
        for (Settings s : all) {
          for (const uint32_t m : {1u, 8u}) {
            s.leafQueueBelow = m * s.k;
            s.arity = s.k <= maxArity ? s.k : 2;
            INFO(name << ", " << count << " triangles, k " << s.k << ", p " << s.draws << ", i " << s.iterations
                      << ", m " << m << ", metric " << static_cast<uint32_t>(s.metric) << ", " << device.name);
            const test::TestMesh mesh = test::makeInput(name, count);
            const Bvh bvh = build(device, mesh, s);
            REQUIRE(bvh.joints.empty() == (s.arity == 2));
            REQUIRE(difference(Tree(bvh), 0, *Plain(mesh, s).tree()) == "");
          }
        }
}

TEST_CASE("lanes that are fibers and threads that have whole groups build one k-means tree") {
  const Device device = openDevice("cpu");
  for (const char* name : {"random", "grid", "identical", "one-huge"})
    for (Settings s : {settings(8, 5, 0), settings(8, 5, 2), settings(33, 40, 5), settings(8, 5, 2, Metric::unionArea),
                       plusPlus(settings(8, 5, 2))}) {
      INFO(name << ", k " << s.k);
      const test::TestMesh mesh = test::makeInput(name, 3000);
      const auto expected = test::bitsOf(build(device, mesh, s));
      s.onFibers = true;
      const bool same = test::bitsOf(build(device, mesh, s)) == expected;
      REQUIRE(same);
    }
}

TEST_CASE("k-means trees of wide nodes are valid, as wide as they may be and cost what their nodes and leaves do") {
  for (const Device& device : test::devices())
    for (const std::string& name : test::inputNames())
      for (const uint32_t count : {1u, 2u, 3u, 9u, 33u, 65u, 1025u, 20000u})
        for (const int64_t arity : {3, 4, 8})
          for (const char* rule : {"sah", "count"}) {
            INFO(name << ", " << count << " triangles, arity " << arity << ", leaf.rule " << rule);
            const test::TestMesh mesh = test::makeInput(name, count);
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
            if (name == "random" && count > 1000) REQUIRE(cost.mostChildren == arity);
          }
}

TEST_CASE("marks of joints change nothing else in a k-means tree, and do not depend on threads or lanes") {
  const Device device = openDevice("cpu", 1);
  const test::TestMesh mesh = test::makeInput("random", 30000);
  Parameters binary;
  binary.set("kmeans.arity=2");
  binary.set("kmeans.k=8");
  const Bvh marked = test::rawTreeOf(device, mesh, "kmeans", wide(8, 4));
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
  const Device device = openDevice("cpu");
  const test::TestMesh mesh = test::makeInput("random", 3000);
  Parameters four = wide(4, 4), both = wide(4, 4);
  both.set("kmeans.k=4");
  CHECK(test::bitsOf(test::treeOf(device, mesh, "kmeans", four)) ==
        test::bitsOf(test::treeOf(device, mesh, "kmeans", both)));
  both.set("kmeans.k=8");
  CHECK_THROWS_AS(test::treeOf(device, mesh, "kmeans", both), InputError);
  CHECK_THROWS_WITH(test::treeOf(device, mesh, "kmeans-q3", both), Catch::Contains("kmeans.k has to be the same"));
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
  const Device device = openDevice("cpu");
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
  const Device device = openDevice("cpu");
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
