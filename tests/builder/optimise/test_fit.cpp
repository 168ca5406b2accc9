// Fitting boxes is a stage of its own: over an open tree, and again over a finished one whose triangles have moved.
#include <cmath>
#include <cstring>

#include "tests/support/builder_checks.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"

using namespace copse;
using namespace copse::test;

namespace {

Box boxOf(const TestMesh& mesh, uint32_t triangle) {
  Box box;
  for (int c = 0; c < 3; ++c) box.grow(mesh.positions[mesh.indices[triangle][c]]);
  return box;
}

/// Each box is exactly that around what is below it.
template <class Tree>
void requireTight(const Tree& tree, const TestMesh& mesh) {
  const auto nodes = tree.nodes.toHost(tree.nodeCount);
  const auto order = tree.order.toHost(tree.referenceCount);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Box box;
    if (nodes[i].isLeaf())
      for (uint32_t k = 0; k < nodes[i].count(); ++k) box.grow(boxOf(mesh, order[nodes[i].first() + k]));
    else
      box = unite(nodes[nodes[i].left].box(), nodes[nodes[i].right].box());
    if (box.lo != nodes[i].lo || box.hi != nodes[i].hi) FAIL("the box of node " << i << " is another");
  }
}

/// Every vertex somewhere else.
TestMesh moved(TestMesh mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float x = 0.37f * static_cast<float>(i % 1000);
    mesh.positions[i] += vec3(std::sin(x), std::cos(1.3f * x), std::sin(0.7f * x + 1));
  }
  return mesh;
}

void requireRefitted(const std::string& builder) {
  for (const Device& device : devices())
    for (const bool keepParents : {false, true})
      for (const uint32_t size : {0u, 1u, 2u, 3u, 300u}) {
        INFO(builder << ", " << size << " triangles, parents " << (keepParents ? "kept" : "linked") << ", "
                     << device.name);
        const TestMesh mesh = makeInput("random", size), later = moved(mesh);
        Bvh bvh = treeOf(device, mesh, builder, {}, {.keepParents = keepParents});
        CHECK(bvh.parents.size() == (keepParents ? bvh.nodeCount : 0));
        const auto built = bitsOf(bvh);
        const DeviceMesh there(device, later), here(device, mesh);
        fit(device, bvh, primitivesOf(device, there.view()).view().boxes);
        validate(device, bvh, there.view(), 8);
        requireTight(bvh, later);
        if (size == 0) continue;
        const std::vector<Ray> rays = raysAround(later, 200, 3);
        const Device cpu = openDevice("cpu");
        const auto found = hitsOf(device, bvh, later, rays), right = hitsOf(cpu, leafTree(cpu, later), later, rays);
        const bool same = std::memcmp(found.data(), right.data(), rays.size() * sizeof(Hit)) == 0;
        REQUIRE(same);
        // And back: the parents are there for another time, and the tree is what was built.
        fit(device, bvh, primitivesOf(device, here.view()).view().boxes);
        const bool asBuilt = bitsOf(bvh) == built;
        REQUIRE(asBuilt);
      }
}
const Cases refitted("a tree that is refitted to moved triangles is valid and has the hits of brute force", "",
                     builderNames(), requireRefitted);

void requireFitted(const std::string& builder) {
  for (const Device& device : devices())
    for (const uint32_t size : {1u, 2u, 500u}) {
      INFO(builder << ", " << size << " triangles, " << device.name);
      const TestMesh mesh = makeInput("random", size), later = moved(mesh);
      OpenTree tree = rawTreeOf(device, mesh, builder);
      fit(device, tree);
      requireTight(tree, mesh);
      const DeviceMesh there(device, later);
      fit(device, tree, primitivesOf(device, there.view()).view().boxes);
      requireTight(tree, later);
      requireValid(device, collapseAndLayout(device, std::move(tree), {}), later, 8);
    }
}
const Cases fitted("an open tree's boxes are fitted from its leaves' own boxes, or from others", "", builderNames(),
                   requireFitted);

}  // namespace

TEST_CASE("fitting over wide nodes leaves their marks") {
  const Device device = chosenDevice();
  Parameters wide;
  wide.set("kmeans.arity=8");
  const TestMesh mesh = makeInput("random", 2000), later = moved(mesh);
  Bvh bvh = treeOf(device, mesh, "kmeans", wide);
  const auto joints = bvh.joints.toHost();
  const DeviceMesh there(device, later);
  fit(device, bvh, primitivesOf(device, there.view()).view().boxes);
  validate(device, bvh, there.view(), 8);
  CHECK(bvh.joints.toHost() == joints);
}

TEST_CASE("refitting gives the same boxes on any number of threads") {
  const TestMesh mesh = makeInput("random", many(40000)), later = moved(mesh);
  const Device device = openDevice("cpu", 1);
  Bvh bvh = treeOf(device, mesh, "lbvh");
  const OwnedPrimitives primitives = primitivesOf(device, later.hostView());
  fit(device, bvh, primitives.view().boxes);
  const auto expected = bitsOf(bvh);
  for (const int threads : {2, 3, 7}) {
    fit(withThreads(device, threads), bvh, primitives.view().boxes);
    const bool same = bitsOf(bvh) == expected;
    REQUIRE(same);
  }
}
