// Counts of a heat map against those of an independent traversal, on trees small enough to count by hand as well.
#include <algorithm>
#include <cmath>

#include "builder/build.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"
#include "tracer/accel/tracers.h"
#include "tracer/integrators/heatmap/heatmap.h"

using namespace copse;
using namespace copse::test;

namespace {

/// A tree of a scene by itself.
struct Tree {
  std::unique_ptr<SceneOnDevice> scene;
  Bvh bvh;
  std::unique_ptr<TreeTracer> tracer;

  Tree(const Device& device, const Scene& from, const std::vector<std::string>& set = {}) {
    scene = uploadScene(device, from);
    Parameters parameters;
    for (const std::string& setting : set) parameters.set(setting);
    const BuilderEntry& builder = findBuilder("sah");
    bvh = buildBvh(device, trianglesOf(*scene), builder, withPreset(builder, parameters));
    tracer = makeTracer(device, bvh, trianglesOf(*scene), "binary");
  }
};

/// Where the ray enters the box, infinity where it does not before `limit`.
double enters(const Box& box, const Ray& ray, double limit) {
  double from = 0, to = limit;
  for (int d = 0; d < 3; ++d) {
    const double a = (double{box.lo[d]} - ray.origin[d]) / ray.direction[d];
    const double b = (double{box.hi[d]} - ray.origin[d]) / ray.direction[d];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to ? from : INFINITY;
}

/// The textbook's traversal of a builder's tree: nearer child first, nothing behind the hit so far.
struct Textbook {
  const Tree& tree;
  const Ray& ray;
  double nearest = INFINITY;
  uint64_t nodes = 0, triangles = 0;

  void test(uint32_t index) {
    using dvec3 = glm::dvec3;
    const TrianglesView& t = trianglesOf(*tree.scene);
    const uvec3 corners = t.indices[index];
    const dvec3 a(t.positions[corners.x]), edge1 = dvec3(t.positions[corners.y]) - a,
                                           edge2 = dvec3(t.positions[corners.z]) - a, direction(ray.direction);
    const dvec3 across = glm::cross(direction, edge2), from = dvec3(ray.origin) - a;
    const double determinant = glm::dot(edge1, across), u = glm::dot(from, across) / determinant;
    const dvec3 along = glm::cross(from, edge1);
    const double v = glm::dot(direction, along) / determinant, at = glm::dot(edge2, along) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && at > 0) nearest = std::min(nearest, at);
    ++triangles;
  }
  void leaf(const BvhNode& node) {
    for (uint32_t i = 0; i < node.count(); ++i) test(tree.bvh.order.data()[node.first() + i]);
  }
  void visit(uint32_t index) {
    const BvhNode* const all = tree.bvh.nodes.data();
    const BvhNode& node = all[index];
    if (node.isLeaf()) return leaf(node);
    ++nodes;
    uint32_t children[2] = {node.left, node.right};
    double at[2] = {enters(all[children[0]].box(), ray, nearest), enters(all[children[1]].box(), ray, nearest)};
    if (at[1] < at[0]) {
      std::swap(children[0], children[1]);
      std::swap(at[0], at[1]);
    }
    for (int c = 0; c < 2; ++c)
      if (at[c] < INFINITY && at[c] <= nearest) visit(children[c]);
  }
};

}  // namespace

TEST_CASE("A tree of one triangle costs one node, and one triangle where its box is entered") {
  SceneMaker maker;
  maker.triangle({-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, maker.material(vec3(0.5f)));
  for (const Device& device : devices()) {
    const Tree tree(device, maker.scene);
    const StepBuffers steps =
        countSteps(device, *tree.tracer->stepTracer(), lookAt({0, 0, 5}, {0, 0, 0}, 40), settings(21, 21, 3, 1));
    CHECK(steps.samples == 3 * 21 * 21);
    CHECK(steps.meanNodes == 1);
    for (const float nodes : steps.nodes) REQUIRE(nodes == 1);
    CHECK(steps.triangles[10 * 21 + 10] == 1);
    CHECK(steps.triangles[6 * 21 + 14] == 1);  // In the box, beside the triangle.
    CHECK(steps.triangles[0] == 0);
  }
}

TEST_CASE("Nothing costs nothing") {
  const Device device = chosenDevice();
  const Tree tree(device, Scene{});
  const StepBuffers steps =
      countSteps(device, *tree.tracer->stepTracer(), lookAt({0, 0, 5}, {0, 0, 0}), settings(4, 3, 2, 1));
  CHECK(steps.meanNodes == 0);
  CHECK(steps.meanTriangles == 0);
  CHECK(steps.triangles == std::vector<float>(12, 0.0f));
}

TEST_CASE("Counts are those of an independent traversal") {
  SceneMaker maker;
  const uint32_t grey = maker.material(vec3(0.5f));
  maker.sphere({-1.2f, 1, 0}, 1, 2, grey);
  maker.sphere({1.2f, 0.7f, 1}, 0.7f, 2, grey);
  maker.parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, grey);
  const Camera camera = lookAt({1, 3, 6}, {0, 0.6f, 0}, 50);
  const RenderSettings wanted = settings(40, 30, 1, 1, 4);
  const Device cpu = openDevice("cpu");
  for (const std::string leaves : {"leaf.max=1", "leaf.max=8"}) {
    const Tree onHost(cpu, maker.scene, {leaves});
    const Pinhole pinhole = makePinhole(camera, 40, 30);
    for (const Device& device : devices()) {
      const Tree tree(device, maker.scene, {leaves});
      const StepBuffers steps = countSteps(device, *tree.tracer->stepTracer(), camera, wanted);
      int differing = 0;
      double nodes = 0;
      for (uint32_t i = 0; i < 40 * 30; ++i) {
        const Ray ray = cameraRay(pinhole, 40, i, randomKey(wanted.seed, i, 0));
        Textbook textbook{onHost, ray};
        textbook.visit(0);
        nodes += static_cast<double>(textbook.nodes);
        differing += steps.nodes[i] != textbook.nodes || steps.triangles[i] != textbook.triangles;
      }
      // Two children that are entered at the same point, such as halves of the floor, may be taken either way.
      CHECK(differing < 12);
      CHECK(steps.meanNodes == Approx(nodes / (40 * 30)).epsilon(0.002));
      CHECK(nodes / (40 * 30) > 2);
    }
  }
}

TEST_CASE("A heat map does not depend on threads or on the size of the queue") {
  SceneMaker maker;
  maker.sphere({0, 1, 0}, 1, 3, maker.material(vec3(0.5f)));
  const RenderSettings wanted = settings(33, 21, 4, 1);
  StepBuffers expected;
  for (const int threads : {1, 2, 5}) {
    const Device device = openDevice("cpu", threads);
    const Tree tree(device, maker.scene);
    for (const uint32_t queue : {0u, 100u, 33u * 21u, 1000u}) {
      const StepBuffers steps =
          countSteps(device, *tree.tracer->stepTracer(), lookAt({1, 2, 4}, {0, 1, 0}), wanted, {}, queue);
      if (expected.nodes.empty()) expected = steps;
      CHECK(steps.nodes == expected.nodes);
      CHECK(steps.triangles == expected.triangles);
      CHECK(steps.meanNodes == expected.meanNodes);
    }
  }
}
