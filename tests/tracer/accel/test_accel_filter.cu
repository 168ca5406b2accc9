// The leaf filter: a ray goes on where it says so, in every format, by the triangle and the place on it.
#include <cfloat>

#include "builder/parallel/launch.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/in_turn.h"
#include "tracer/accel/wide8_steps.h"

using namespace copse;
using namespace copse::test;

namespace {

/// Lets rays through every triangle whose number is no multiple of 3, and through one corner of those that are left.
struct Sieve {
  HD bool operator()(uint32_t triangle, float u, float v) const { return triangle % 3 == 0 && u + v > 0.25f; }
};

template <class Step>
struct TraceFiltered {
  typename Step::Format::View view;
  const Ray* rays;
  Hit* hits;
  uint32_t* occluded;
  HD void operator()(uint32_t i) const {
    hits[i] = traverse<Step, false>(view, rays[i], Sieve{});
    occluded[i] = traverse<Step, true>(view, rays[i], Sieve{}).triangle != Hit::none;
  }
};

/// Tests every triangle; the nearest of those that the filter accepts.
std::vector<Hit> triangleByTriangle(const TestMesh& mesh, const std::vector<Ray>& rays) {
  const Device cpu = openDevice("cpu");
  std::vector<Hit> nearest;
  for (const Ray& ray : rays) nearest.push_back({ray.tMax, 0, 0, Hit::none});
  for (uint32_t t = 0; t < mesh.count(); ++t) {
    TestMesh one;
    for (int k = 0; k < 3; ++k) one.positions.push_back(mesh.positions[mesh.indices[t][k]]);
    one.indices = {{0, 1, 2}};
    const Binary::Tree tree = Binary::build(cpu, leafTree(cpu, one), one.hostView());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = traverse<NodeStep, false>(tree.view(), rays[i]);
      if (hit.triangle != Hit::none && hit.t < nearest[i].t && Sieve{}(t, hit.u, hit.v))
        nearest[i] = {hit.t, hit.u, hit.v, t};
    }
  }
  return nearest;
}

void requireSame(const std::vector<Hit>& hits, const std::vector<uint32_t>& occluded,
                 const std::vector<Hit>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO("ray " << i);
    REQUIRE(hits[i].triangle == expected[i].triangle);
    REQUIRE(occluded[i] == (expected[i].triangle != Hit::none));
    if (expected[i].triangle != Hit::none) REQUIRE(hits[i].t == Approx(expected[i].t));
  }
}

template <class Step>
void requireRayByRay(const Device& device, const Bvh& bvh, const TestMesh& mesh, const std::vector<Ray>& rays,
                     const std::vector<Hit>& expected) {
  const DeviceMesh there(device, mesh);
  const auto tree = Step::Format::build(device, bvh, there.view());
  const Buffer<Ray> raysThere(device, rays);
  Buffer<Hit> hits(device, rays.size());
  Buffer<uint32_t> occluded(device, rays.size());
  launch(device, "filtered", uint32_t(rays.size()),
         TraceFiltered<Step>{tree.view(), raysThere.data(), hits.data(), occluded.data()});
  requireSame(hits.toHost(), occluded.toHost(), expected);
}

template <class Step>
void requireInTurn(const Bvh& bvh, const TestMesh& mesh, const std::vector<Ray>& rays,
                   const std::vector<Hit>& expected) {
  const auto tree = Step::Format::build(openDevice("cpu"), bvh, mesh.hostView());
  std::vector<Hit> hits(rays.size());
  std::vector<uint32_t> occluded(rays.size());
  const uint32_t count = uint32_t(rays.size());
  traverseInTurn<Step, false>(
      tree.view(), rays.data(), 0, count, [&](uint32_t i, const Hit& hit) { hits[i] = hit; }, Sieve{});
  traverseInTurn<Step, true>(
      tree.view(), rays.data(), 0, count, [&](uint32_t i, const Hit& hit) { occluded[i] = hit.triangle != Hit::none; },
      Sieve{});
  requireSame(hits, occluded, expected);
}

}  // namespace

TEST_CASE("A ray goes on through what a leaf filter does not accept, in every format") {
  const TestMesh mesh = makeInput("random", 300);
  const std::vector<Ray> rays = raysAround(mesh, 1000, 21);
  const std::vector<Hit> expected = triangleByTriangle(mesh, rays);
  const auto hit =
      std::count_if(expected.begin(), expected.end(), [](const Hit& h) { return h.triangle != Hit::none; });
  REQUIRE(hit > 100);
  for (const Device& device : devices())
    // The chain is deeper than the stack, so that some of its rays go on without one.
    for (const Bvh& bvh : {medianTree(device, mesh, 3), chainTree(device, mesh)}) {
      requireRayByRay<NodeStep>(device, bvh, mesh, rays, expected);
      requireRayByRay<WideStep>(device, bvh, mesh, rays, expected);
      if (device.isCuda()) continue;
      requireInTurn<PairStep>(bvh, mesh, rays, expected);
      requireInTurn<WideStep>(bvh, mesh, rays, expected);
    }
}
