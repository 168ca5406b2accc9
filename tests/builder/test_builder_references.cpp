// Triangles that are in several leaves: what validator, statistics, overlap and rays make of a tree made by hand, and
// that all stages of a build go on with more references than triangles.
#include <cmath>
#include <cstring>
#include <functional>

#include "builder/base/error.h"
#include "builder/metrics/end_point_overlap.h"
#include "tests/support/builder_checks.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"

using namespace copse;
using namespace copse::test;

namespace {

TestMesh meshOf(const std::vector<vec3>& corners) {
  TestMesh mesh;
  mesh.positions = corners;
  for (uint32_t i = 0; 3 * i < corners.size(); ++i) mesh.indices.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  return mesh;
}

Box box(const vec3& lo, const vec3& hi) { return {lo, 0, hi, 0}; }

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

/// A triangle in the plane z = 0 from x = -1 to x = 1, cut at x = 0, and on either side a wall with a corner above it.
TestMesh cutMesh() {
  return meshOf({vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0),    //
                 vec3(-1, 0, 0), vec3(-1, 1, 0), vec3(-1, 0, 1),  //
                 vec3(1, 0, 0), vec3(1, 1, 0), vec3(1, 0, 1)});
}
const Box all = box({-1, 0, 0}, {1, 1, 1}), left = box({-1, 0, 0}, {0, 1, 1}), right = box({0, 0, 0}, {1, 1, 1});
Tree cutTree() {
  return {{BvhNode::inner(all, 1, 2), BvhNode::leaf(left, 0, 2), BvhNode::leaf(right, 2, 2)}, {0, 1, 0, 2}, 3};
}

std::string complaintAbout(const Tree& tree, const TestMesh& mesh) {
  const Device device = chosenDevice();
  try {
    requireValid(device, upload(device, tree), mesh, 8);
  } catch (const ValidationError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a triangle that is in two leaves is sound, and counts as two references") {
  const TestMesh mesh = cutMesh();
  for (const Device& device : devices()) {
    const Bvh bvh = upload(device, cutTree());
    requireValid(device, bvh, mesh);
    const TreeStatistics found = statistics(device, bvh, {});
    CHECK(found.references == 4);
    CHECK(found.leaves == 2);
    CHECK(found.maxLeafTriangles == 2);
    const double root = 2 * (2 + 2 + 1), half = 2 * (1 + 1 + 1);
    CHECK(found.sahCost == Approx(3 + 2 * (2 * 2 * half / root)));
    // In the other half's box lies nothing of a wall, and the cut triangle belongs to both.
    CHECK(endPointOverlap(device, bvh, DeviceMesh(device, mesh).view(), {}) == 0);

    const std::vector<Ray> rays = raysAround(mesh, 500, 9);
    const Device cpu = openDevice("cpu");
    const auto found2 = hitsOf(device, bvh, mesh, rays), expected = hitsOf(cpu, leafTree(cpu, mesh), mesh, rays);
    const bool same = std::memcmp(found2.data(), expected.data(), rays.size() * sizeof(Hit)) == 0;
    CHECK(same);
  }
}

TEST_CASE("the overlap counts a triangle once, and in no node that is above one of its leaves") {
  // A further leaf within both halves: a flap of area 1/2 that is below it alone.
  TestMesh mesh = cutMesh();
  const std::vector<vec3> flap{vec3(-0.5f, 0, 0.5f), vec3(0.5f, 0, 0.5f), vec3(0, 1, 0.5f)};
  mesh.positions.insert(mesh.positions.end(), flap.begin(), flap.end());
  mesh.indices.emplace_back(9, 10, 11);
  Tree tree = cutTree();
  tree.nodes = {BvhNode::inner(all, 1, 2), BvhNode::inner(all, 3, 4),
                BvhNode::leaf(box(flap[0], {0.5f, 1, 0.5f}), 4, 1), tree.nodes[1], tree.nodes[2]};
  tree.order.push_back(3);
  tree.triangles = 4;
  CHECK(complaintAbout(tree, mesh) == "");
  const Device device = chosenDevice();
  const double flapArea = 0.5, whole = 1 + 0.5 + 0.5 + flapArea;
  // The flap lies in the inner node around both halves, cost 3, and half of it in each leaf of two, cost 4.
  CHECK(endPointOverlap(device, upload(device, tree), DeviceMesh(device, mesh).view(), {}) ==
        Approx((3 * flapArea + 4 * flapArea) / whole).epsilon(1e-12));
}

TEST_CASE("the validator finds each defect planted in a tree of split triangles") {
  const TestMesh mesh = cutMesh();
  const auto complaint = [&](const std::function<void(Tree&)>& damage) {
    Tree tree = cutTree();
    damage(tree);
    return complaintAbout(tree, mesh);
  };
  CHECK(complaint([](Tree&) {}) == "");
  CHECK_THAT(complaint([](Tree& t) { t.order[3] = 0; }), Contains("triangle 2: in no leaf"));
  CHECK_THAT(complaint([](Tree& t) { t.order[2] = 3; }), Contains("triangle 3 exceeds the scene's 3"));
  CHECK_THAT(complaint([](Tree& t) { t.order.push_back(1), ++t.nodes[2].right; }),
             Contains("triangle 1 is outside its box"));
  CHECK_THAT(complaint([](Tree& t) { t.order[2] = 2; }), Contains("triangle 0 is not inside its box"));
  CHECK_THAT(complaint([](Tree& t) { t.triangles = 4; }), Contains("4 triangles, but the scene has 3"));
  CHECK_THAT(complaint([](Tree& t) { t.order = {0, 1}; }), Contains("2 references for 3 triangles"));
  // The wall is whole in its box: it has one leaf, and no part of it may be missing.
  CHECK_THAT(complaint([](Tree& t) { t.nodes[1].hi.z = 0.9f; }), Contains("triangle 1 is not inside its box"));
  // The tip of the cut triangle, which is a corner of both parts.
  CHECK_THAT(complaint([](Tree& t) { t.nodes[1].hi.x = t.nodes[2].lo.x = -0.1f, t.nodes[2].hi.y = 0.99f; }),
             Contains("triangle 0: a part of it is outside the boxes of all its 2 leaves"));
  // All corners are in a box, but for a strip between the boxes.
  CHECK_THAT(complaint([](Tree& t) { t.nodes[1].hi.x = -0.001f; }),
             Contains("triangle 0: a part of it is outside the boxes of all its 2 leaves"));
  CHECK(complaint([](Tree& t) { t.nodes[1].hi.x = -1e-7f; }) == "");  // What rounding may leave.
  CHECK_THAT(complaint([](Tree& t) { t.nodes[2].lo.y = 0.0001f; }), Contains("triangle 0: a part of it"));
}

namespace {

/// Two references per triangle, whose boxes are the halves of the triangle's own.
struct Halves {
  Buffer<Box> boxes, bounds;
  Buffer<uint32_t> triangleOf;
  DeviceMesh there;

  Halves(const Device& device, const TestMesh& mesh) : there(device, mesh) {
    std::vector<Box> halves;
    std::vector<uint32_t> triangles;
    Box all;
    for (uint32_t i = 0; i < mesh.count(); ++i) {
      Box whole;
      for (int c = 0; c < 3; ++c) whole.grow(mesh.positions[mesh.indices[i][c]]);
      all.grow(whole);
      const vec3 size = whole.hi - whole.lo;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      Box low = whole, high = whole;
      low.hi[axis] = high.lo[axis] = whole.lo[axis] + size[axis] / 2;
      halves.insert(halves.end(), {low, high});
      triangles.insert(triangles.end(), {i, i});
    }
    boxes = Buffer<Box>(device, halves);
    bounds = Buffer<Box>(device, std::vector<Box>{all});
    triangleOf = Buffer<uint32_t>(device, triangles);
  }
  Primitives view() const {
    return {boxes.data(), bounds.data(), static_cast<uint32_t>(boxes.size()), there.view(), triangleOf.data()};
  }
};

void requireSplit(const std::string& builder) {
  for (const Device& device : devices())
    for (const uint32_t size : {1u, 2u, 300u}) {
      INFO(builder << ", " << size << " triangles, " << device.name);
      const TestMesh mesh = makeInput("random", size);
      const Halves halves(device, mesh);
      const BuilderEntry& entry = findBuilder(builder);
      const Parameters parameters = withPreset(entry, {});
      Bvh bvh = collapseAndLayout(device, buildOpenTree(device, halves.view(), entry, parameters), parameters);
      requireValid(device, bvh, mesh, 8);
      CHECK(bvh.referenceCount == 2 * size);
      CHECK(bvh.triangleCount == size);
      CHECK(statistics(device, bvh, parameters).references == 2 * size);
      const std::vector<Ray> rays = raysAround(mesh, 200, 3);
      const Device cpu = openDevice("cpu");
      const auto expected = hitsOf(cpu, leafTree(cpu, mesh), mesh, rays);
      const auto found = hitsOf(device, bvh, mesh, rays);
      bool same = std::memcmp(found.data(), expected.data(), rays.size() * sizeof(Hit)) == 0;
      CHECK(same);
      // Refitting knows triangles, not parts of them: the boxes are wider, and as right.
      fit(device, bvh, primitivesOf(device, halves.there.view()).view().boxes);
      requireValid(device, bvh, mesh, 8);
      const auto refitted = hitsOf(device, bvh, mesh, rays);
      same = std::memcmp(refitted.data(), expected.data(), rays.size() * sizeof(Hit)) == 0;
      CHECK(same);
    }
}
const Cases split("triangles that come as two references each are built, laid out and hit", "", builderNames(),
                  requireSplit);

}  // namespace
