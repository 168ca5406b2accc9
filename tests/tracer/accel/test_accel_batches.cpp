// tracer/accel: deep trees, batches of every size, persistent warps, limits of a ray.
#include <cmath>
#include <cstring>

#include "builder/build.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/persistent.h"
#include "tracer/accel/ray_tracer.h"
#include "tracer/accel/trace.h"
#include "tracer/accel/traverse.h"
#include "tracer/accel/traverse_wide.h"

using namespace copse;
using namespace copse::test;

namespace {

/// What both ways of tracing a batch leave in memory, with `untouched` where no ray was.
struct Answers {
  std::vector<Hit> hits;
  std::vector<uint32_t> occluded;
};

constexpr uint32_t untouched = 0x01010101u;

template <class Closest, class Any>
Answers answersOf(const Device& device, const std::vector<Ray>& rays, Closest closest, Any any) {
  const uint32_t n = uint32_t(rays.size());
  const Buffer<Ray> there(device, rays);
  Buffer<Hit> hits(device, n);
  Buffer<uint32_t> occluded(device, n);
  hits.fill(1);
  occluded.fill(1);
  closest(n, there.data(), hits.data());
  any(n, there.data(), occluded.data());
  return {hits.toHost(), occluded.toHost()};
}

Answers rayByRay(const TestMesh& mesh, const std::vector<Ray>& rays) {
  const Device cpu = openDevice("cpu");
  const TraversalBvh bvh = traversalBvh(cpu, medianTree(cpu, mesh, 3), mesh.hostView());
  Answers answers;
  for (const Ray& ray : rays) {
    answers.hits.push_back(closestHit(bvh.view(), ray));
    answers.occluded.push_back(anyHit(bvh.view(), ray));
  }
  return answers;
}

Answers byWarps(const PersistentTracer& tracer, const Device& device, const TraversalView& view,
                const std::vector<Ray>& rays, const uint32_t* count = nullptr) {
  return answersOf(
      device, rays, [&](uint32_t n, const Ray* r, Hit* h) { tracer.closest(device, "closest", view, n, count, r, h); },
      [&](uint32_t n, const Ray* r, uint32_t* o) { tracer.any(device, "any", view, n, count, r, o); });
}

Answers byWarps(const Device& device, const TraversalView& view, const std::vector<Ray>& rays,
                const uint32_t* count = nullptr) {
  return byWarps(PersistentTracer(device), device, view, rays, count);
}

bool same(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void requireSame(const Answers& a, const Answers& b, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    if (same(a.hits[i], b.hits[i]) && a.occluded[i] == b.occluded[i]) continue;
    FAIL("ray " << i << ": triangle " << a.hits[i].triangle << " at " << a.hits[i].t << ", occluded " << a.occluded[i]
                << ", and " << b.hits[i].triangle << " at " << b.hits[i].t << ", occluded " << b.occluded[i]);
  }
}

}  // namespace

TEST_CASE("Persistent warps find what the per-ray functions find, bit for bit, for any number of rays") {
  const TestMesh mesh = makeInput("random", 500);
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const TraversalBvh bvh = traversalBvh(device, medianTree(device, mesh, 3), there.view());
    for (uint32_t n : {0u, 1u, 31u, 32u, 33u, 1000u}) {
      INFO(n << " rays");
      std::vector<Ray> rays = raysAround(mesh, n, n + 1);
      for (uint32_t i = 3; i < n; i += 10) rays[i].tMax = 0;  // Lanes that are done at once.
      requireSame(byWarps(device, bvh.view(), rays), rayByRay(mesh, rays), n);
    }
  }
}

TEST_CASE("No hit depends on how warps share out their rays, in any batch of one tracer") {
  const TestMesh mesh = makeInput("random", 500);
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const TraversalBvh bvh = traversalBvh(device, medianTree(device, mesh, 3), there.view());
    for (const uint32_t leave : {0u, 1u, 8u, 31u})
      for (const uint32_t fetch : {1u, 26u, 32u}) {
        PersistentSettings settings;
        settings.leave = leave;
        settings.fetch = fetch;
        settings.blocks = leave % 2;
        const PersistentTracer tracer(device, settings);
        for (const uint32_t n : {40u, 0u, 1u, 300u, 33u}) {
          INFO("leave " << leave << ", fetch " << fetch << ", " << n << " rays");
          std::vector<Ray> rays = raysAround(mesh, n, n + 1);
          for (uint32_t i = 3; i < n; i += 10) rays[i].tMax = 0;
          requireSame(byWarps(tracer, device, bvh.view(), rays), rayByRay(mesh, rays), n);
        }
      }
  }
}

TEST_CASE("A batch's size may stand in the device's memory, and no ray beyond it is touched") {
  const TestMesh mesh = makeInput("grid", 200);
  const std::vector<Ray> rays = raysAround(mesh, 300, 5);
  const Answers expected = rayByRay(mesh, rays);
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const TraversalBvh bvh = traversalBvh(device, medianTree(device, mesh, 3), there.view());
    const BvhRayTracer tracer(device, bvh.view());
    for (uint32_t n : {0u, 1u, 33u, 300u, 500u}) {
      const Buffer<uint32_t> count(device, std::vector<uint32_t>{n});
      const std::size_t traced = std::min<std::size_t>(n, rays.size());
      for (const Answers& answers :
           {byWarps(device, bvh.view(), rays, count.data()),
            answersOf(
                device, rays,
                [&](uint32_t m, const Ray*r, Hit*h) { tracer.closest(device, "closest", m, count.data(), r, h); },
                [&](uint32_t m, const Ray*r, uint32_t*o) { tracer.any(device, "any", m, count.data(), r, o); })}) {
        requireSame(answers, expected, traced);
        for (std::size_t i = traced; i < rays.size(); ++i) {
          REQUIRE(answers.hits[i].triangle == untouched);
          REQUIRE(answers.occluded[i] == untouched);
        }
      }
    }
  }
}

TEST_CASE("A tree deeper than the stack loses no hit") {
  // A pile of large triangles, seen from its far end: the way down puts one leaf aside for each of 5000 nodes.
  TestMesh pile;
  for (uint32_t i = 0; i < 5000; ++i) {
    const float z = float(i), hole = i % 7 == 0 ? 0.0f : 3.0f;
    pile.positions.insert(pile.positions.end(), {{-4 + hole, -4, z}, {8, -4, z}, {-4 + hole, 8, z}});
    pile.indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  std::vector<Ray> fromEnd;
  for (uint32_t i = 0; i < 64; ++i)  // The first of these pass through all of the pile.
    fromEnd.push_back({vec3(-4.5f + 0.1f * float(i), -3.9f, 6000), 0, vec3(0, 0, -1), i % 2 ? 9000.0f : 3000.0f});
  for (const TestMesh& mesh : {makeInput("random", 5000), pile}) {
    std::vector<Ray> rays = raysAround(mesh, 200, 11);
    rays.insert(rays.end(), fromEnd.begin(), fromEnd.end());
    const Answers expected = rayByRay(mesh, rays);
    for (const Device& device : devices()) {
      const DeviceMesh there(device, mesh);
      const TraversalBvh bvh = traversalBvh(device, chainTree(device, mesh), there.view());
      REQUIRE(bvh.nodeCount == 4999);
      requireSame(byWarps(device, bvh.view(), rays), expected, rays.size());
      requireSame(answersOf(
                      device, rays,
                      [&](uint32_t n, const Ray* r, Hit* h) { traceClosest(device, "closest", bvh.view(), n, r, h); },
                      [&](uint32_t n, const Ray* r, uint32_t* o) { traceAny(device, "any", bvh.view(), n, r, o); }),
                  expected, rays.size());
    }
  }
}

TEST_CASE("A batch finds what single rays find, whether its neighbours take the same way or not") {
  const Device cpu = openDevice("cpu");
  for (const char* name : {"random", "one-huge", "two-clusters", "identical"}) {
    const TestMesh mesh = makeInput(name, 2000);
    const TraversalBvh bvh = traversalBvh(cpu, medianTree(cpu, mesh, 3), mesh.hostView());
    for (uint32_t n : {1u, 3u, 4u, 9u, 255u, 257u, 2000u}) {
      INFO(name << ", " << n << " rays");
      std::vector<Ray> apart = raysAround(mesh, n, n);
      std::vector<Ray> alike = apart;
      for (Ray& ray : alike) ray.direction = glm::abs(ray.direction);
      for (uint32_t i = 5; i < n; i += 7) apart[i].tMax = alike[i].tMax = 0;
      for (uint32_t i = 6; i < n; i += 70) apart[i].direction = vec3(0);
      for (const std::vector<Ray>& rays : {apart, alike})
        requireSame(
            answersOf(
                cpu, rays, [&](uint32_t m, const Ray* r, Hit* h) { traceClosest(cpu, "closest", bvh.view(), m, r, h); },
                [&](uint32_t m, const Ray* r, uint32_t* o) { traceAny(cpu, "any", bvh.view(), m, r, o); }),
            rayByRay(mesh, rays), n);
    }
  }
}

TEST_CASE("All ways through a tree lead to the same hit") {
  const Device cpu = openDevice("cpu");
  for (const std::string& name : inputNames()) {
    const TestMesh mesh = makeInput(name, 400);
    const std::vector<Ray> rays = raysAround(mesh, 500, 2);
    const TraversalBvh bvh = traversalBvh(cpu, medianTree(cpu, mesh, 2), mesh.hostView());
    for (const Ray& ray : rays) {
      const Hit pairs = detail::closestHitByPairs(bvh.view(), ray);
      const Hit nodes = detail::traverseNodes<false>(bvh.view(), ray);
      REQUIRE(same(pairs, nodes));
      const detail::RayInTree r(bvh.view(), ray);
      const Hit start{ray.tMax, 0, 0, Hit::none};
      REQUIRE(same(pairs, r.valid ? detail::traverseDeep<false>(bvh.view(), r, start) : start));
      const bool any = pairs.triangle != Hit::none;
      REQUIRE(any == detail::anyHitByPairs(bvh.view(), ray));
      REQUIRE(any == (detail::traverseNodes<true>(bvh.view(), ray).triangle != Hit::none));
      if (r.valid) REQUIRE(any == (detail::traverseDeep<true>(bvh.view(), r, start).triangle != Hit::none));
    }
  }
}

TEST_CASE("Wide nodes give the hits of a binary tree, and no ray beyond the batch is touched") {
  for (const Device& device : devices())
    for (const std::string& name : inputNames())
      for (uint32_t n : {0u, 1u, 2u, 9u, 33u, 1500u})
        for (int64_t arity : {4, 8}) {
          INFO(name << ", " << n << " triangles, arity " << arity);
          const TestMesh mesh = makeInput(name, n);
          std::vector<Ray> rays = raysAround(mesh, 300, 17);
          for (uint32_t i = 5; i < 300; i += 17) rays[i].tMax = 0;
          rays[6].direction = vec3(0);
          const Answers expected = rayByRay(mesh, rays);
          const DeviceMesh there(device, mesh);
          Parameters parameters;
          parameters.set("kmeans.arity", arity);
          parameters.set("kmeans.m=1");
          const Bvh tree = buildBvh(device, there.view(), findBuilder("kmeans"), parameters);
          const TraversalBvh bvh = traversalBvh(device, tree, there.view());
          REQUIRE((bvh.view().wideNodes != nullptr) == (tree.nodeCount > 1 && !device.isCuda()));
          const BvhRayTracer tracer(device, bvh.view());
          for (uint32_t traced : {300u, 33u}) {
            const Buffer<uint32_t> count(device, std::vector<uint32_t>{traced});
            const Answers answers = answersOf(
                device, rays,
                [&](uint32_t m, const Ray* r, Hit* h) { tracer.closest(device, "closest", m, count.data(), r, h); },
                [&](uint32_t m, const Ray* r, uint32_t* o) { tracer.any(device, "any", m, count.data(), r, o); });
            requireSame(answers, expected, traced);
            for (std::size_t i = traced; i < rays.size(); ++i) {
              REQUIRE(answers.hits[i].triangle == untouched);
              REQUIRE(answers.occluded[i] == untouched);
            }
          }
          requireSame(byWarps(device, bvh.view(), rays), expected, rays.size());
          for (std::size_t i = 0; i < rays.size() && !device.isCuda() && bvh.wideNodes.size() > 0; ++i) {
            REQUIRE(same(detail::traverseWide<false>(bvh.view(), rays[i]), expected.hits[i]));
            REQUIRE((detail::traverseWide<true>(bvh.view(), rays[i]).triangle != Hit::none) == expected.occluded[i]);
          }
        }
}

TEST_CASE("A wide tree deeper than the stack loses no hit") {
  TestMesh pile;
  for (uint32_t i = 0; i < 3000; ++i) {
    const float z = float(i);
    pile.positions.insert(pile.positions.end(), {{i % 7 ? -1.0f : -4.0f, -4, z}, {8, -4, z}, {-4, 8, z}});
    pile.indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  std::vector<Ray> rays = raysAround(pile, 200, 3);
  for (uint32_t i = 0; i < 64; ++i)
    rays.push_back({vec3(-4.5f + 0.1f * float(i), -3.9f, 6000), 0, vec3(0, 0, -1), i % 2 ? 9000.0f : 3000.0f});
  const Answers expected = rayByRay(pile, rays);
  for (const Device& device : devices()) {
    const DeviceMesh there(device, pile);
    Bvh chain = chainTree(device, pile);
    std::vector<uint8_t> joints(chain.nodeCount);
    for (uint32_t i = 0; 2 * i + 2 < chain.nodeCount; ++i) joints[2 * i] = i % 7 != 0;  // Seven leaves and the rest.
    chain.joints = Buffer<uint8_t>(device, joints);
    chain.arity = 8;
    const TraversalBvh bvh = traversalBvh(device, chain, there.view());
    REQUIRE(bvh.wideNodes.size() == (device.isCuda() ? 0 : 429));
    requireSame(answersOf(
                    device, rays,
                    [&](uint32_t n, const Ray* r, Hit* h) { traceClosest(device, "closest", bvh.view(), n, r, h); },
                    [&](uint32_t n, const Ray* r, uint32_t* o) { traceAny(device, "any", bvh.view(), n, r, o); }),
                expected, rays.size());
  }
}

namespace {

void requireSameHits(const std::string& name) {
  const BuilderEntry& builder = findBuilder(name);
  for (const Device& device : devices())
    for (const std::string& input : inputNames())
      for (const uint32_t n : inputSizes()) {
        if (n > 2000) continue;  // Larger trees are validated, in test_builder.
        INFO(name << " on " << input << ", " << n << " triangles");
        const TestMesh mesh = makeInput(input, n);
        const std::vector<Ray> rays = raysAround(mesh, 200, 13);
        const DeviceMesh there(device, mesh);
        const Bvh tree = buildBvh(device, there.view(), builder, withPreset(builder, {}));
        const TraversalBvh bvh = traversalBvh(device, tree, there.view());
        const BvhRayTracer tracer(device, bvh.view());
        requireSame(answersOf(
                        device, rays,
                        [&](uint32_t m, const Ray* r, Hit* h) { tracer.closest(device, "closest", m, nullptr, r, h); },
                        [&](uint32_t m, const Ray* r, uint32_t* o) { tracer.any(device, "any", m, nullptr, r, o); }),
                    rayByRay(mesh, rays), rays.size());
      }
}
const Cases sameHits("The tree of a builder gives the hits of single rays", "", builderNames(), requireSameHits);

}  // namespace

TEST_CASE("Hits lie strictly between tMin and tMax, and the lowest of equal ones is taken") {
  // Triangles at z = 1, 2, 3, the second of which is there three times.
  TestMesh mesh;
  for (float z : {1.0f, 2.0f, 2.0f, 2.0f, 3.0f}) {
    const uint32_t first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{-4, -4, z}, {8, -4, z}, {-4, 8, z}});
    mesh.indices.push_back({first, first + 1, first + 2});
  }
  auto between = [&](float tMin, float tMax) { return Ray{vec3(0), tMin, vec3(0, 0, 1), tMax}; };
  const std::vector<Ray> rays{between(0, INFINITY), between(1, INFINITY), between(1.5f, 2), between(1.5f, 2.5f),
                              between(2, 3),        between(2, 3.5f),     between(-5, 10),  between(4, INFINITY),
                              between(2, 1),        between(NAN, NAN),    between(0, -1)};
  const uint32_t expected[] = {0, 1, Hit::none, 1, Hit::none, 4, 0, Hit::none, Hit::none, Hit::none, Hit::none};
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    for (const Bvh& tree : {medianTree(device, mesh, 1), chainTree(device, mesh), leafTree(device, mesh)}) {
      const TraversalBvh bvh = traversalBvh(device, tree, there.view());
      const Answers answers = byWarps(device, bvh.view(), rays);
      const std::vector<Hit> perRay =
          answersOf(
              device, rays,
              [&](uint32_t n, const Ray* r, Hit* h) { traceClosest(device, "closest", bvh.view(), n, r, h); },
              [](uint32_t, const Ray*, uint32_t*) {})
              .hits;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        INFO("ray " << i);
        CHECK(answers.hits[i].triangle == expected[i]);
        CHECK(perRay[i].triangle == expected[i]);
        CHECK(answers.occluded[i] == (expected[i] != Hit::none));
        if (expected[i] == Hit::none && rays[i].tMax == rays[i].tMax) CHECK(perRay[i].t == rays[i].tMax);
      }
    }
  }
}

TEST_CASE("A ray that is not finite or goes nowhere hits nothing and ends") {
  const TestMesh mesh = makeInput("random", 1000);
  const float inf = INFINITY, nan = NAN;
  std::vector<Ray> rays;
  for (float bad : {inf, -inf, nan})
    for (int axis = 0; axis < 3; ++axis) {
      Ray ray{vec3(0.5f), 0, vec3(0.3f, 0.2f, 1), inf};
      ray.origin[axis] = bad;
      rays.push_back(ray);
      ray.origin = vec3(0.5f);
      ray.direction[axis] = bad;
      rays.push_back(ray);
    }
  rays.push_back({vec3(0.5f), 0, vec3(0), inf});
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const TraversalBvh bvh = traversalBvh(device, medianTree(device, mesh, 4), there.view());
    const Answers answers = byWarps(device, bvh.view(), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      INFO("ray " << i);
      REQUIRE(answers.hits[i].triangle == Hit::none);
      REQUIRE(answers.occluded[i] == 0);
      REQUIRE(
          closestHit(traversalBvh(openDevice("cpu"), medianTree(openDevice("cpu"), mesh, 4), mesh.hostView()).view(),
                     rays[i])
              .triangle == Hit::none);
    }
  }
}
