// Every builder of the registry on every kind and size of input: valid trees of bounded depth, laid out in pairs of
// siblings, the same on any number of threads. A new row in the registry is tested here with no line of code.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "builder/parallel/timeline.h"
#include "builder/phases.h"
#include "tests/support/builder_checks.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/real_meshes.h"
#include "tests/support/trees.h"

using namespace copse;

namespace {

/// Each two nodes behind the root are the children of one node; each leaf's triangles ascend. That the pairs stand in
/// the order of their parents in the builder's tree is a test of its own, in test_builder_methods.cpp.
void requireSiblingsInPairs(const Bvh& bvh) {
  const auto nodes = bvh.nodes.toHost(bvh.nodeCount);
  const auto order = bvh.order.toHost(bvh.referenceCount);
  std::vector<bool> named(nodes.size() / 2);
  for (const BvhNode& node : nodes) {
    if (node.isLeaf()) {
      for (uint32_t k = 1; k < node.count(); ++k)
        if (order[node.first() + k - 1] >= order[node.first() + k]) FAIL("a leaf's triangles do not ascend");
    } else {
      if (node.left % 2 == 0 || node.right != node.left + 1 || node.right >= nodes.size() || named[node.left / 2])
        FAIL("children " << node.left << ", " << node.right << " are no pair, or another node's too");
      named[node.left / 2] = true;
    }
  }
}

/// Rays per input of the largest size. Where triangles lie in one place or rays run in their planes, a ray has to try
/// very many of them, whatever the tree: of those kinds few rays are traced here, and more at smaller sizes, in
/// test_accel.
uint32_t raysThrough(const std::string& input) {
  for (const char* cheap : {"random", "two-clusters", "one-huge", "negative", "large", "tiny"})
    if (input == cheap) return 300;
  return 10;
}

/// Rays through a large mesh and what they hit, by a tree that no builder made. Some of
/// the rays try every triangle.
struct Shots {
  std::vector<Ray> rays;
  std::vector<Hit> hits;

  Shots(const test::TestMesh& mesh, uint32_t count) : rays(test::raysAround(mesh, count, 5)) {
    const Device cpu = openDevice("cpu");
    hits = hitsOf(cpu, test::medianTree(cpu, mesh, 4), mesh);
  }
  std::vector<Hit> hitsOf(const Device& device, const Bvh& tree, const test::TestMesh& mesh) const {
    return test::hitsOf(device, tree, mesh, rays);
  }
  /// The first `count` rays against one leaf of all triangles.
  void requireBruteForce(const test::TestMesh& mesh, std::size_t count) {
    const Device cpu = openDevice("cpu");
    Shots few = *this;
    few.rays.resize(count);
    few.hits.resize(count);
    few.requireSame(few.hitsOf(cpu, test::leafTree(cpu, mesh), mesh));
  }
  void requireSame(const std::vector<Hit>& found) const {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (std::memcmp(&found[i], &hits[i], sizeof(Hit)) == 0) continue;
      FAIL("ray " << i << ": triangle " << found[i].triangle << " at " << found[i].t << ", and " << hits[i].triangle
                  << " at " << hits[i].t);
    }
  }
};

/// What a radix tree of 64 bits and 30-bit places can reach. The other methods stay below it too, but for clusters of
/// ever smaller triangles: what is joined by area nests them all, and each adds to the depth.
uint32_t deepest(const std::string& input) { return input == "shrinking" ? 192 : 96; }

/// The sizes that `builder` is tried at: all of them once a function, a sample for its other presets.
std::vector<uint32_t> sizesFor(const std::string& builder) {
  if (!test::isTriedInFull(builder)) return {0, 1, 2, 33, 1025, 5000};
  return test::inputSizes();
}

/// Checks trees of every kind and size, and hits at the largest size beside those of a tree that no builder made.
void requireValidTrees(const std::string& builder) {
  for (const std::string& name : test::inputNames()) {
    const std::vector<uint32_t> sizes = sizesFor(builder);
    const test::TestMesh largest = test::makeInput(name, sizes.back());
    Shots shots(largest, raysThrough(name));
    shots.requireBruteForce(largest, 10);
    for (const Device& device : test::devices())
      for (const uint32_t size : sizes) {
        INFO(builder << " on " << name << ", " << size << " triangles, " << device.name);
        const test::TestMesh mesh = test::makeInput(name, size);
        const Bvh bvh = test::treeOf(device, mesh, builder);
        test::requireValid(device, bvh, mesh, 8);
        requireSiblingsInPairs(bvh);
        const TreeStatistics tree = statistics(device, bvh, {});
        REQUIRE(tree.depth <= deepest(name));
        REQUIRE(tree.nodes == (size ? 2 * tree.leaves - 1 : 0));
        if (size == sizes.back()) shots.requireSame(shots.hitsOf(device, bvh, mesh));
      }
  }
}
const test::Cases validTrees("trees are valid on all inputs, and the largest have the hits of brute force", "[medium]",
                             test::builderNames(), requireValidTrees);

void requireSameOnAnyThreads(const std::string& builder) {
  const std::vector<const char*> all{"random", "identical", "grid", "one-huge"}, sample{"random"};
  for (const char* name : test::isTriedInFull(builder) ? all : sample) {
    const test::TestMesh mesh = test::makeInput(name, 40000);
    const Device device = openDevice("cpu", 1);
    const auto expected = test::bitsOf(test::treeOf(device, mesh, builder));
    for (const int threads : {2, 3, 7}) {
      INFO(builder << " on " << name << ", " << threads << " threads");
      const bool same = test::bitsOf(test::treeOf(test::withThreads(device, threads), mesh, builder)) == expected;
      REQUIRE(same);
    }
  }
}
const test::Cases sameOnAnyThreads("the same triangles give the same tree on any number of threads", "",
                                   test::builderNames(), requireSameOnAnyThreads);

void requireSameOnEveryDevice(const std::string& builder) {
  const std::vector<Device> devices = test::devices();
  if (devices.size() == 1 && !devices[0].isCuda()) return test::skipTest("the CPU is the only device");
  const Device cpu = openDevice("cpu");  // Also where --device asks for CUDA alone.
  for (const char* name : {"random", "identical", "grid"}) {
    INFO(builder << " on " << name);
    const test::TestMesh mesh = test::makeInput(name, 40000);
    const auto expected = test::bitsOf(test::treeOf(cpu, mesh, builder));
    for (const Device& device : devices) {
      const bool same = test::bitsOf(test::treeOf(device, mesh, builder)) == expected;
      REQUIRE(same);
    }
  }
}
const test::Cases sameOnEveryDevice("every device gives the same tree", "", test::builderNames(),
                                    requireSameOnEveryDevice);

void requireTreesWithoutNumbers(const std::string& builder) {
  for (const Device& device : test::devices())
    for (const float bad : {NAN, INFINITY, -INFINITY, 3e38f}) {
      INFO(builder << " with " << bad);
      test::TestMesh mesh = test::makeInput("random", 300);
      for (uint32_t i = 0; i < 300; i += 7) mesh.positions[3 * i][static_cast<int>(i % 3)] = bad;
      for (int corner = 0; corner < 3; ++corner) mesh.positions[corner] = vec3(bad);
      const Bvh bvh = test::treeOf(device, mesh, builder);
      auto order = bvh.order.toHost(bvh.referenceCount);
      std::sort(order.begin(), order.end());
      for (uint32_t i = 0; i < 300; ++i) REQUIRE(order[i] == i);
      test::requireValid(device, bvh, mesh, 8);
    }
}
const test::Cases treesWithoutNumbers("boxes that are not numbers give a tree all the same", "", test::builderNames(),
                                      requireTreesWithoutNumbers);

void requireBoundedDepth(const std::string& builder) {
  const test::TestMesh mesh =
      test::makeInput("identical", test::many(test::isTriedInFull(builder) ? 1'000'000 : 100'000));
  for (const Device& device : test::devices()) {
    const Bvh bvh = test::treeOf(device, mesh, builder);
    test::requireValid(device, bvh, mesh, 8);
    REQUIRE(statistics(device, bvh, {}).depth <= 30);
  }
}
const test::Cases boundedDepth("very many equal triangles make a tree of bounded depth", "[medium]",
                               test::builderNames(), requireBoundedDepth);

}  // namespace

TEST_CASE("the phases of a build are named and cover it") {
  for (const Device& device : test::devices())
    for (const BuilderEntry& builder : builders()) {
      INFO(builder.name);
      Timeline timeline(device);
      test::treeOf(device.recording(timeline), test::makeInput("random", 20000), builder.name);
      const auto phases = timeline.phases();
      for (const PhaseTime& phase : phases) {
        INFO(phase.name);
        const auto declared = std::ranges::find(phasesOfBuilds(), phase.name, &PhaseName::text);
        REQUIRE(declared != phasesOfBuilds().end());
        CHECK(phase.group == declared->group);
      }
      const auto has = [&](const char* name) {
        return std::any_of(phases.begin(), phases.end(), [&](const PhaseTime& phase) { return phase.name == name; });
      };
      REQUIRE(has("boxes"));
      REQUIRE(has("collapse"));
      REQUIRE(has("layout"));
      REQUIRE(phases.size() > 3);
    }
}
