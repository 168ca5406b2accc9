// The validator finds every kind of defect, and statistics say what they should of a tree made by hand.
#include <algorithm>
#include <cmath>
#include <functional>

#include "builder/base/error.h"
#include "tests/support/builder_checks.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

struct Tree {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  uint32_t triangles;
};

Bvh upload(const Device& device, const Tree& tree) {
  Bvh bvh;
  bvh.nodes = Buffer<BvhNode>(device, tree.nodes);
  bvh.order = Buffer<uint32_t>(device, tree.order);
  bvh.nodeCount = static_cast<uint32_t>(tree.nodes.size());
  bvh.referenceCount = static_cast<uint32_t>(tree.order.size());
  bvh.triangleCount = tree.triangles;
  return bvh;
}

/// What validate says of `builder`'s good tree after `damage`; empty where it finds nothing.
std::string complaintAbout(const std::string& builder, const std::function<void(Tree&)>& damage, const char* input) {
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput(input, 200);
  const Bvh good = test::treeOf(device, mesh, builder);
  Tree tree{good.nodes.toHost(good.nodeCount), good.order.toHost(good.referenceCount), good.triangleCount};
  damage(tree);
  try {
    test::requireValid(device, upload(device, tree), mesh, 8);
  } catch (const ValidationError& error) {
    return error.what();
  }
  return {};
}

uint32_t firstLeaf(const Tree& tree) {
  for (uint32_t i = 0;; ++i)
    if (tree.nodes[i].isLeaf()) return i;
}
/// One of several triangles.
BvhNode& largeLeaf(Tree& tree) {
  return *std::find_if(tree.nodes.begin(), tree.nodes.end(),
                       [](const BvhNode& n) { return n.isLeaf() && n.count() > 1; });
}
uint32_t lastInner(const Tree& tree) {
  for (auto i = static_cast<uint32_t>(tree.nodes.size() - 1);; --i)
    if (!tree.nodes[i].isLeaf()) return i;
}

}  // namespace

TEST_CASE("the validator finds each planted defect") {
  using copse::test::Contains;
  for (const std::string& builder : test::builderNames()) {
    if (!test::isTriedInFull(builder)) continue;
    INFO(builder);
    const auto complaint = [&](const std::function<void(Tree&)>& damage, const char* input = "random") {
      return complaintAbout(builder, damage, input);
    };
    CHECK(complaint([](Tree&) {}) == "");
    CHECK_THAT(complaint([](Tree& t) { t.order[5] = t.order[6]; }, "identical"), Contains("already in another leaf"));
    CHECK_THAT(complaint([](Tree& t) { t.order[5] = 200; }), Contains("triangle 200 exceeds the scene's 200"));
    CHECK_THAT(complaint([](Tree& t) { t.order.pop_back(); }), Contains("199 references for"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes.clear(); }), Contains("0 nodes"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[0].left = 100000; }), Contains("past the last node"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[0].right = t.nodes[0].left; }), Contains("another parent"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[lastInner(t)].left = 0; }), Contains("is above it"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[lastInner(t)].left = lastInner(t); }), Contains("is above it"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes.push_back(t.nodes.back()); }), Contains("not reached"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[0].hi.y -= 0.01f; }), Contains("not inside its own"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[0].lo.x = NAN; }), Contains("not inside its own"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[firstLeaf(t)].hi.z -= 1e-4f; }), Contains("not inside its box"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[firstLeaf(t)].right = BvhNode::leafBit; }), Contains("no triangle"));
    CHECK_THAT(complaint([](Tree& t) { t.nodes[firstLeaf(t)].right = BvhNode::leafBit | 9; }), Contains("9 triangles"));
    CHECK_THAT(complaint([](Tree& t) { largeLeaf(t).left = 199; }), Contains("exceed the number of references, 200"));
    CHECK_THAT(complaint([](Tree& t) { --largeLeaf(t).right; }), Contains("in no leaf"));
  }
}

TEST_CASE("the validator finds marks of joints that cannot be") {
  using copse::test::Contains;
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput("random", 200);
  Parameters parameters;
  parameters.set("kmeans.arity=4");
  parameters.set("kmeans.m=1");
  Bvh bvh = test::treeOf(device, mesh, "kmeans", parameters);
  const std::vector<uint8_t> good = bvh.joints.toHost();
  const std::vector<BvhNode> nodes = bvh.nodes.toHost(bvh.nodeCount);
  const auto complaintOf = [&](const std::vector<uint8_t>& joints) -> std::string {
    bvh.joints = Buffer<uint8_t>(device, joints);
    try {
      test::requireValid(device, bvh, mesh, 8);
    } catch (const ValidationError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(complaintOf(good) == "");
  std::vector<uint8_t> joints = good;
  joints[0] = 1;
  CHECK_THAT(complaintOf(joints), Contains("the root is marked"));
  joints = good;
  joints[static_cast<std::size_t>(
      std::find_if(nodes.begin(), nodes.end(), [](const BvhNode& n) { return n.isLeaf(); }) - nodes.begin())] = 1;
  CHECK_THAT(complaintOf(joints), Contains("marked as a collapsed inner node"));
  joints = good;
  for (uint32_t i = 1; i < nodes.size(); ++i) joints[i] = !nodes[i].isLeaf();
  CHECK_THAT(complaintOf(joints), Contains("maximum of 4"));
  joints = good;
  joints.pop_back();
  CHECK_THAT(complaintOf(joints), Contains("marks for"));
  bvh.arity = 9;
  CHECK_THAT(complaintOf(good), Contains("an arity from 2 to 8, got 9"));
}

TEST_CASE("the validator looks at the device's counts before its memory") {
  const Device device = test::chosenDevice();
  const test::TestMesh mesh = test::makeInput("random", 20);
  Bvh bvh = test::treeOf(device, mesh, "lbvh");
  bvh.nodeCount += 1;
  CHECK_THROWS_AS(test::requireValid(device, bvh, mesh, 8), ValidationError);
}

TEST_CASE("statistics of a tree made by hand") {
  // A cube of side 2 over a leaf of three triangles in a cube of side 1 and a leaf of one in a plate of 2 by 2.
  const auto box = [](const vec3& lo, const vec3& hi) {
    Box b;
    b.lo = lo;
    b.hi = hi;
    return b;
  };
  const Box root = box(vec3(0), vec3(2)), cube = box(vec3(1), vec3(2)), plate = box(vec3(0), vec3(2, 2, 0));
  const Device device = test::chosenDevice();
  const Tree tree{{BvhNode::inner(root, 1, 2), BvhNode::leaf(cube, 0, 3), BvhNode::leaf(plate, 3, 1)}, {0, 1, 2, 3}, 4};
  const TreeStatistics found = statistics(device, upload(device, tree), {});
  CHECK(found.sahCost == Approx(3 + 2 * 3 * 6.0 / 24 + 2 * 1 * 8.0 / 24));
  CHECK(found.nodes == 3);
  CHECK(found.leaves == 2);
  CHECK(found.depth == 1);
  CHECK(found.maxLeafTriangles == 3);

  Parameters costs;
  costs.set("sah.traversal=1");
  costs.set("sah.intersection=4");
  CHECK(statistics(device, upload(device, tree), costs).sahCost == Approx(1 + 4 * 3 * 6.0 / 24 + 4 * 8.0 / 24));
}

TEST_CASE("a tree of no triangle and one without area have no cost") {
  const Device device = test::chosenDevice();
  CHECK(statistics(device, Bvh{}, {}).sahCost == 0);
  CHECK(statistics(device, test::treeOf(device, test::makeInput("collinear", 50), "sah"), {}).sahCost == 0);
}
