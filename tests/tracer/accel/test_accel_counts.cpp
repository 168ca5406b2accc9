// tracer/accel/counting: steps that can be counted by hand, the same on any number of threads and any device, with
// the hits of the traversal that does not count.

#include <cfloat>
#include <cstring>

#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/counting.h"
#include "tracer/accel/tracers.h"
#include "tracer/integrators/parameters.h"

using namespace copse;
using namespace copse::test;

namespace {

/// Right triangles in the planes x = 0, 1, …, each half of the square from (0, 0) to (1, 1) at the origin.
TestMesh walls(uint32_t count) {
  TestMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(i);
    for (const vec3& corner : {vec3(x, 0, 0), vec3(x, 1, 0), vec3(x, 0, 1)}) mesh.positions.push_back(corner);
    mesh.indices.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

std::unique_ptr<TreeTracer> traced(const Device& device, const Bvh& tree, const TestMesh& mesh,
                                   const char* name = "binary", const char* setting = "wide.leaf_max=1") {
  Parameters parameters(tracerParameters());
  parameters.set(setting);
  return makeTracer(device, tree, DeviceMesh(device, mesh).view(), name, parameters);
}

template <bool any>
TraversalSteps stepsOf(const Device& device, const TreeTracer& of, const std::vector<Ray>& rays) {
  const CountingRayTracer tracer(*of.stepTracer());
  const Buffer<Ray> there(device, rays);
  const uint32_t count = static_cast<uint32_t>(rays.size());
  if (any)
    tracer.any(device, "rays", count, there.data(), Buffer<uint32_t>(device, count).data());
  else
    tracer.closest(device, "rays", count, there.data(), Buffer<Hit>(device, count).data());
  return tracer.steps("rays");
}

void checkSteps(const TraversalSteps& steps, uint64_t rays, uint64_t nodes, uint64_t triangles) {
  CHECK(steps.rays == rays);
  CHECK(steps.nodes == nodes);
  CHECK(steps.triangles == triangles);
}

const Ray through{vec3(-1, 0.2f, 0.2f), 0, vec3(1, 0, 0), FLT_MAX};  ///< Hits every wall.
const Ray past{vec3(-1, 0.8f, 0.8f), 0, vec3(1, 0, 0), FLT_MAX};     ///< Hits every wall's box, and no wall.
const Ray away{vec3(-1, 0.2f, 0.2f), 0, vec3(-1, 0, 0), FLT_MAX};
const Ray nowhere{vec3(0), 0, vec3(0), FLT_MAX};

}  // namespace

TEST_CASE("steps of single rays are those counted by hand") {
  const TestMesh four = walls(4);
  for (const Device& device : devices()) {
    const auto leaf = traced(device, leafTree(device, four), four),
               pairs = traced(device, medianTree(device, four, 1), four),
               chain = traced(device, chainTree(device, four), four),
               wide = traced(device, medianTree(device, four, 1), four, "wide8"),
               block = traced(device, medianTree(device, four, 1), four, "wide8", "wide.leaf_max=4");
    const TreeTracer &one = *leaf, &two = *pairs, &deep = *chain;
    // One leaf below a root of its own: all triangles, or for any hit the first.
    checkSteps(stepsOf<false>(device, one, {through}), 1, 1, 4);
    checkSteps(stepsOf<true>(device, one, {through}), 1, 1, 1);
    checkSteps(stepsOf<false>(device, one, {away}), 1, 1, 0);
    checkSteps(stepsOf<false>(device, one, {nowhere}), 1, 0, 0);
    // The root, the nearer of its children and that one's nearer child; the others lie behind the hit.
    checkSteps(stepsOf<false>(device, two, {through}), 1, 2, 1);
    checkSteps(stepsOf<true>(device, two, {through}), 1, 2, 1);
    checkSteps(stepsOf<false>(device, two, {past}), 1, 3, 4);
    checkSteps(stepsOf<true>(device, two, {past}), 1, 3, 4);
    checkSteps(stepsOf<false>(device, two, {away}), 1, 1, 0);
    checkSteps(stepsOf<false>(device, deep, {through}), 1, 1, 1);
    checkSteps(stepsOf<false>(device, deep, {past}), 1, 3, 4);
    checkSteps(stepsOf<false>(device, deep, {through, past, away, nowhere}), 4, 1 + 3 + 1, 1 + 4);
    checkSteps(stepsOf<false>(device, two, {}), 0, 0, 0);
    // All four are children of one wide node.
    checkSteps(stepsOf<false>(device, *wide, {through}), 1, 1, 1);
    checkSteps(stepsOf<false>(device, *wide, {past}), 1, 1, 4);
    checkSteps(stepsOf<true>(device, *wide, {away}), 1, 1, 0);
    // All four are one leaf of it, which is tested whole.
    checkSteps(stepsOf<false>(device, *block, {through}), 1, 1, 4);
    checkSteps(stepsOf<true>(device, *block, {through}), 1, 1, 4);
  }
}

TEST_CASE("the cost of a wide tree is that of its boxes, and binary nodes have none") {
  const TestMesh four = walls(4);  // Boxes of surface area 2, in one of 14.
  for (const Device& device : devices()) {
    const Bvh tree = medianTree(device, four, 1);
    CHECK(traced(device, tree, four, "wide8")->wideCost(device).value() == Approx(1 + 4 * 0.7 * 2 / 14));
    CHECK(traced(device, tree, four, "wide8", "wide.leaf_max=4")->wideCost(device).value() == Approx(1 + 0.7));
    CHECK(traced(device, tree, four, "wide8", "wide.leaf=2")->wideCost(device).value() == Approx(1 + 4 * 2.7 * 2 / 14));
    CHECK_FALSE(traced(device, tree, four)->wideCost(device));
  }
}

TEST_CASE("batches add up under their names") {
  const TestMesh mesh = walls(4);
  for (const Device& device : devices()) {
    const auto of = traced(device, medianTree(device, mesh, 1), mesh);
    const CountingRayTracer tracer(*of->stepTracer());
    const Buffer<Ray> rays(device, std::vector<Ray>{past, past, past});
    const Buffer<uint32_t> occluded(device, 3);
    const Buffer<Hit> hits(device, 3);
    tracer.closest(device, "primary", 2, rays.data(), hits.data());
    tracer.closest(device, "primary", 3, rays.data(), hits.data());
    tracer.any(device, "shadow", 3, rays.data(), occluded.data());
    checkSteps(tracer.steps("primary"), 5, 15, 20);
    checkSteps(tracer.steps("shadow"), 3, 9, 12);
    checkSteps(tracer.steps("bounce"), 0, 0, 0);
  }
}

TEST_CASE("counting changes no hit, and neither threads nor the device change a count") {
  const TestMesh mesh = makeInput("random", 4000);
  const std::vector<Ray> rays = raysAround(mesh, 9000, 5);
  const uint32_t count = static_cast<uint32_t>(rays.size());
  Parameters wide;
  wide.set("kmeans.arity=8");
  uint64_t nodesOfBinary = 0;
  for (const auto& [builder, format, parameters] :
       {std::tuple{"lbvh", "binary", Parameters{}}, std::tuple{"lbvh", "wide8", Parameters{}},
        std::tuple{"kmeans", "wide8", wide}}) {
    CAPTURE(builder, format);
    std::vector<TraversalSteps> closest, any;
    for (const Device& device : devices()) {
      const auto of = traced(device, treeOf(device, mesh, builder, parameters), mesh, format);
      const Buffer<Ray> there(device, rays);
      for (const int threads : {1, 2, 7}) {
        const Device some = withThreads(device, threads);
        const Buffer<Hit> counted(some, count), plain(some, count);
        const Buffer<uint32_t> stopped(some, count), plainStopped(some, count);
        const CountingRayTracer counting(*of->stepTracer());
        counting.closest(some, "closest", count, there.data(), counted.data());
        counting.any(some, "any", count, there.data(), stopped.data());
        of->closest(some, "closest", count, there.data(), plain.data());
        of->any(some, "any", count, there.data(), plainStopped.data());
        REQUIRE(std::memcmp(counted.toHost().data(), plain.toHost().data(), count * sizeof(Hit)) == 0);
        REQUIRE(stopped.toHost() == plainStopped.toHost());
        closest.push_back(counting.steps("closest"));
        any.push_back(counting.steps("any"));
      }
    }
    for (const auto* all : {&closest, &any})
      for (const TraversalSteps& steps : *all) checkSteps(steps, count, all->front().nodes, all->front().triangles);
    CHECK(any[0].nodes < closest[0].nodes);
    if (std::string(format) == "binary")
      nodesOfBinary = closest[0].nodes;
    else
      CHECK(2 * closest[0].nodes < nodesOfBinary);
  }
}

TEST_CASE("a ray that hits visits every node above the leaf, and none twice unless the tree is deep") {
  const Device device = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 600);
  const Bvh tree = medianTree(device, mesh, 1);
  const std::vector<BvhNode> nodes = tree.nodes.toHost();
  const std::vector<uint32_t> order = tree.order.toHost();
  std::vector<uint32_t> depthOf(mesh.count()), depth(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i)  // Children stand behind their parents.
    if (nodes[i].isLeaf())
      depthOf[order[nodes[i].first()]] = depth[i];
    else
      depth[nodes[i].left] = depth[nodes[i].right] = depth[i] + 1;
  const std::vector<Ray> rays = raysAround(mesh, 2000, 9);
  std::vector<Hit> found(rays.size());
  std::vector<RaySteps> visited(rays.size());
  traced(device, tree, mesh)
      ->stepTracer()
      ->closest(device, "rays", static_cast<uint32_t>(rays.size()), rays.data(), found.data(), visited.data());
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RaySteps& steps = visited[i];
    const Hit& hit = found[i];
    REQUIRE(steps.nodes <= mesh.count() - 1);
    REQUIRE(steps.triangles <= mesh.count());
    if (hit.triangle == Hit::none) continue;
    ++hits;
    REQUIRE(steps.nodes >= depthOf[hit.triangle]);
    REQUIRE(steps.triangles >= 1);
  }
  CHECK(hits > 1000);
}

TEST_CASE("steps of rays that outgrow the stack are counted too") {
  const TestMesh mesh = walls(200);
  const Ray back{vec3(201, 0.8f, 0.8f), 0, vec3(-1, 0, 0), FLT_MAX};  // Pushes a wall at each node.
  for (const Device& device : devices()) {
    const auto chain = traced(device, chainTree(device, mesh), mesh);
    const TraversalSteps steps = stepsOf<false>(device, *chain, {back});
    CHECK(steps.nodes >= 199);
    CHECK(steps.triangles >= 200);
    checkSteps(stepsOf<false>(device, *chain, {through}), 1, 1, 1);
  }
}
