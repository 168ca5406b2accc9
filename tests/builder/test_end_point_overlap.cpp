// The end-point overlap: cases computed by hand, none where boxes keep apart, and every node against every triangle.
#include <cmath>
#include <limits>

#include "builder/metrics/end_point_overlap.h"
#include "tests/support/builder_checks.h"
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

double overlapOf(const Device& device, const Bvh& bvh, const TestMesh& mesh, const Parameters& parameters = {}) {
  return endPointOverlap(device, bvh, DeviceMesh(device, mesh).view(), parameters);
}

using Polygon = std::vector<glm::dvec3>;

double areaOf(const Polygon& polygon) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return glm::length(sum) / 2;
}

Polygon triangleOf(const TestMesh& mesh, uint32_t triangle) {
  Polygon polygon;
  for (int c = 0; c < 3; ++c) polygon.emplace_back(mesh.positions[mesh.indices[triangle][c]]);
  return polygon;
}

/// By half-spaces, normal · p <= distance.
double areaInside(Polygon polygon, const Box& box) {
  for (int side = 0; side < 6; ++side) {
    glm::dvec3 normal(0);
    normal[side / 2] = side % 2 ? 1 : -1;
    const double distance = side % 2 ? box.hi[side / 2] : -box.lo[side / 2];
    Polygon inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double a = glm::dot(normal, p) - distance, b = glm::dot(normal, q) - distance;
      if (a <= 0) inside.push_back(p);
      if (a * b < 0) inside.push_back(p + (q - p) * (a / (a - b)));  // Keeps what p and q have in common.
    }
    polygon = inside;
  }
  return areaOf(polygon);
}

/// O(n · nodes): every node, and every triangle that is not below it.
double bruteOverlap(const Bvh& bvh, const TestMesh& mesh, const Parameters& parameters) {
  const std::vector<BvhNode> nodes = bvh.nodes.toHost();
  const std::vector<uint32_t> order = bvh.order.toHost();
  const std::vector<uint8_t> joints = bvh.joints.toHost();
  double overlap = 0, all = 0;
  for (uint32_t t = 0; t < mesh.count(); ++t) all += areaOf(triangleOf(mesh, t));
  for (uint32_t n = 0; n < nodes.size(); ++n) {
    if (!joints.empty() && joints[n]) continue;
    std::vector<bool> below(mesh.count(), false);
    for (std::vector<uint32_t> waiting{n}; !waiting.empty();) {
      const BvhNode node = nodes[waiting.back()];
      waiting.pop_back();
      if (!node.isLeaf()) {
        waiting.push_back(node.left);
        waiting.push_back(node.right);
        continue;
      }
      for (uint32_t k = 0; k < node.count(); ++k) below[order[node.first() + k]] = true;
    }
    const double cost =
        nodes[n].isLeaf() ? parameters.real("sah.intersection") * nodes[n].count() : parameters.real("sah.traversal");
    for (uint32_t t = 0; t < mesh.count(); ++t)
      if (!below[t]) overlap += cost * areaInside(triangleOf(mesh, t), nodes[n].box());
  }
  return all > 0 ? overlap / all : 0;
}

}  // namespace

TEST_CASE("the overlap of two leaves is what was computed by hand") {
  // A floor of area 2, and a wall of area sqrt(2) in a box that holds the floor's square from (0, 0) to (1, 1). Of the
  // wall the floor's flat box holds a line.
  const TestMesh mesh =
      meshOf({vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 2, 0), vec3(0, 0, -1), vec3(1, 1, -1), vec3(0, 0, 1)});
  for (const Device& device : devices()) {
    const Bvh apart = medianTree(device, mesh, 1);
    CHECK(overlapOf(device, apart, mesh) == Approx(2 * 1 / (2 + std::sqrt(2.0))).epsilon(1e-12));
    Parameters costs;
    costs.set("sah.intersection=5");
    CHECK(overlapOf(device, apart, mesh, costs) == Approx(5 / (2 + std::sqrt(2.0))).epsilon(1e-12));
    CHECK(overlapOf(device, medianTree(device, mesh, 2), mesh) == 0);  // One leaf has both.
  }
}

TEST_CASE("an inner node and its leaves each count, a leaf by its triangles") {
  // Two small walls in one leaf or two, around a floor whose whole square from 0 to 1 lies in the box of both.
  const TestMesh mesh = meshOf({vec3(0, 0, -1), vec3(1, 0, 1), vec3(0, 0, 1),  //
                                vec3(0, 1, -1), vec3(1, 1, 1), vec3(0, 1, 1),  //
                                vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0)});
  const Device device = chosenDevice();
  const Box low{vec3(0, 0, -1), 0, vec3(1, 0, 1), 0}, high{vec3(0, 1, -1), 0, vec3(1, 1, 1), 0};
  const Box floor{vec3(0, 0, 0), 0, vec3(1, 1, 0), 0}, both = unite(low, high);
  const std::vector<uint32_t> order{0, 1, 2};
  const auto upload = [&](const std::vector<BvhNode>& nodes) {
    Bvh bvh;
    bvh.nodes = Buffer<BvhNode>(device, nodes);
    bvh.order = Buffer<uint32_t>(device, order);
    bvh.nodeCount = static_cast<uint32_t>(nodes.size());
    bvh.referenceCount = bvh.triangleCount = 3;
    return bvh;
  };
  const double walls = 1 + 1, all = walls + 0.5;
  const Bvh two = upload({BvhNode::inner(both, 1, 2), BvhNode::inner(both, 3, 4), BvhNode::leaf(floor, 2, 1),
                          BvhNode::leaf(low, 0, 1), BvhNode::leaf(high, 1, 1)});
  CHECK(overlapOf(device, two, mesh) == Approx(3 * 0.5 / all).epsilon(1e-12));
  const Bvh one = upload({BvhNode::inner(both, 1, 2), BvhNode::leaf(both, 0, 2), BvhNode::leaf(floor, 2, 1)});
  CHECK(overlapOf(device, one, mesh) == Approx(2 * 2 * 0.5 / all).epsilon(1e-12));
}

TEST_CASE("boxes that keep apart have no overlap, and neither has what has no area") {
  for (const Device& device : devices()) {
    TestMesh apart;
    std::vector<vec3> corners;
    for (int i = 0; i < 300; ++i)
      for (const vec3& corner : {vec3(0, 0, 0), vec3(1, 0.5f, 0.2f), vec3(0.1f, 0.9f, 1)})
        corners.push_back(corner + vec3(2.0f * static_cast<float>(i), 0, 0));
    apart = meshOf(corners);
    CHECK(overlapOf(device, medianTree(device, apart, 1), apart) == 0);
    CHECK(overlapOf(device, treeOf(device, apart, "lbvh"), apart) == 0);
    const TestMesh flat = makeInput("zero-area", 50), none = makeInput("random", 0), single = makeInput("random", 1);
    CHECK(overlapOf(device, treeOf(device, flat, "sah"), flat) == 0);
    CHECK(overlapOf(device, Bvh{}, none) == 0);
    CHECK(overlapOf(device, treeOf(device, single, "lbvh"), single) == 0);
  }
}

TEST_CASE("the overlap is that of every node against every triangle") {
  Parameters wide;
  wide.set("kmeans.arity=8");
  for (const Device& device : devices())
    for (const char* kind : {"random", "grid", "one-huge", "coplanar", "two-clusters", "large", "tiny"})
      for (const uint32_t count : {2u, 5u, 120u}) {
        const TestMesh mesh = makeInput(kind, count);
        for (const auto& [builder, parameters] :
             {std::pair{"sah", Parameters{}}, std::pair{"lbvh", Parameters{}}, std::pair{"kmeans", wide}}) {
          CAPTURE(kind, count, builder);
          const Bvh bvh = treeOf(device, mesh, builder, parameters);
          const double expected = bruteOverlap(bvh, mesh, parameters);
          REQUIRE(overlapOf(device, bvh, mesh) == Approx(expected).epsilon(1e-6).margin(1e-9));
        }
        const Bvh median = medianTree(device, mesh, 3);
        REQUIRE(overlapOf(device, median, mesh) == Approx(bruteOverlap(median, mesh, {})).epsilon(1e-6).margin(1e-9));
      }
}

TEST_CASE("no triangle is left out where runs of them are summed apart") {
  const Device device = chosenDevice();
  const TestMesh mesh = makeInput("random", 600);
  const Bvh bvh = treeOf(device, mesh, "lbvh");
  CHECK(overlapOf(device, bvh, mesh) == Approx(bruteOverlap(bvh, mesh, {})).epsilon(1e-6));
}

TEST_CASE("the overlap is the same on any number of threads, and triangles that are not finite add nothing") {
  const Device device = openDevice("cpu");
  TestMesh mesh = makeInput("random", many(20000));
  const Bvh bvh = treeOf(device, mesh, "lbvh");
  const double alone = overlapOf(withThreads(device, 1), bvh, mesh);
  CHECK(alone > 0);
  for (const int threads : {2, 3, 8}) CHECK(overlapOf(withThreads(device, threads), bvh, mesh) == alone);
  mesh.positions[mesh.indices[40][2]].y = std::numeric_limits<float>::quiet_NaN();
  mesh.positions[mesh.indices[41][0]].x = std::numeric_limits<float>::infinity();
  const double without = overlapOf(device, bvh, mesh);
  CHECK(std::isfinite(without));
  CHECK(without == Approx(alone).epsilon(0.01));
}
