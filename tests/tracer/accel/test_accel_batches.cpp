// tracer/accel: deep trees, batches of every size, persistent warps, limits of a ray; in every format.
#include <cmath>
#include <cstring>

#include "builder/build.h"
#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/persistent.h"
#include "tracer/accel/tracers.h"
#include "tracer/accel/wide8_steps.h"
#include "tracer/integrators/parameters.h"

using namespace copse;
using namespace copse::test;

namespace {

const char* const formats[] = {"binary", "wide8"};

/// What tracing a batch of either query writes, with `untouched` where there was no ray.
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

/// Traces the first `count` rays as a renderer does.
Answers byTracer(const Device& device, const RayTracer& tracer, const std::vector<Ray>& rays, uint32_t count = ~0u) {
  const uint32_t traced = std::min(count, uint32_t(rays.size()));
  return answersOf(
      device, rays, [&](uint32_t, const Ray* r, Hit* h) { tracer.closest(device, "closest", traced, r, h); },
      [&](uint32_t, const Ray* r, uint32_t* o) { tracer.any(device, "any", traced, r, o); });
}

Answers rayByRay(const TestMesh& mesh, const std::vector<Ray>& rays) {
  const Device cpu = openDevice("cpu");
  const Binary::Tree tree = Binary::build(cpu, medianTree(cpu, mesh, 3), mesh.hostView());
  Answers answers;
  for (const Ray& ray : rays) {
    answers.hits.push_back(traverse<NodeStep, false>(tree.view(), ray));
    answers.occluded.push_back(traverse<NodeStep, true>(tree.view(), ray).triangle != Hit::none);
  }
  return answers;
}

template <class Format>
Answers byWarps(const PersistentTracer<Format>& tracer, const Device& device, const typename Format::View& view,
                const std::vector<Ray>& rays, uint32_t count = ~0u) {
  const uint32_t traced = std::min(count, uint32_t(rays.size()));
  return answersOf(
      device, rays, [&](uint32_t, const Ray* r, Hit* h) { tracer.closest(device, "closest", view, traced, r, h); },
      [&](uint32_t, const Ray* r, uint32_t* o) { tracer.any(device, "any", view, traced, r, o); });
}

template <class Format>
Answers builtByWarps(const Device& device, const Bvh& bvh, const TrianglesView& triangles, const std::vector<Ray>& rays,
                     uint32_t count) {
  return byWarps(PersistentTracer<Format>(device), device, Format::build(device, bvh, triangles).view(), rays, count);
}

const struct {
  const char* name;  ///< Its tracer's.
  decltype(&builtByWarps<Binary>) byWarps;
} formatRows[] = {{"binary", builtByWarps<Binary>}, {"wide8", builtByWarps<Wide8>}};

/// Traces through a tree in any format, by the name of its tracer.
Answers byWarps(const Device& device, const Bvh& bvh, const TrianglesView& triangles, const std::string& format,
                const std::vector<Ray>& rays, uint32_t count = ~0u) {
  for (const auto& row : formatRows)
    if (row.name == format) return row.byWarps(device, bvh, triangles, rays, count);
  throw std::logic_error("no format " + format);
}

bool same(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void requireSame(const Answers& a, const Answers& b, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    if (same(a.hits[i], b.hits[i]) && a.occluded[i] == b.occluded[i]) continue;
    FAIL("ray " << i << ": triangle " << a.hits[i].triangle << " at " << a.hits[i].t << ", occluded " << a.occluded[i]
                << ", and " << b.hits[i].triangle << " at " << b.hits[i].t << ", occluded " << b.occluded[i]);
  }
}

void requireUntouched(const Answers& answers, std::size_t from) {
  for (std::size_t i = from; i < answers.hits.size(); ++i) {
    REQUIRE(answers.hits[i].triangle == untouched);
    REQUIRE(answers.occluded[i] == untouched);
  }
}

/// Depth by the parents of the nodes alone.
template <class Format, bool any>
Hit withoutStack(const typename Format::View& view, const Ray& ray) {
  Walk<typename StepsOf<Format>::ByNodes, any> walk;
  if (!walk.start(view, ray)) return walk.best;
  return walkDeep<Format, any>(view, walk.boxes, TriangleRay(ray), walk.tMin, walk.best, AcceptAll{});
}

template <class Format>
void requireSameHoweverShared(const Device& device, const TestMesh& mesh, const typename Format::View& view) {
  for (const uint32_t leave : {0u, 1u, 8u, 31u})
    for (const uint32_t fetch : {1u, 26u, 32u}) {
      PersistentSettings settings;
      settings.leave = leave;
      settings.fetch = fetch;
      settings.blocks = leave % 2;
      const PersistentTracer<Format> tracer(device, settings);
      for (const uint32_t n : {40u, 0u, 1u, 300u, 33u}) {
        INFO("leave " << leave << ", fetch " << fetch << ", " << n << " rays, " << Format::width << " children");
        std::vector<Ray> rays = raysAround(mesh, n, n + 1);
        for (uint32_t i = 3; i < n; i += 10) rays[i].tMax = 0;
        requireSame(byWarps(tracer, device, view, rays), rayByRay(mesh, rays), n);
      }
    }
}

}  // namespace

TEST_CASE("Persistent warps find what single rays find, bit for bit, for any number of rays") {
  const TestMesh mesh = makeInput("random", 500);
  for (const Device& device : devices())
    for (const char* format : formats) {
      const DeviceMesh there(device, mesh);
      const Bvh bvh = medianTree(device, mesh, 3);
      for (uint32_t n : {0u, 1u, 31u, 32u, 33u, 1000u}) {
        INFO(n << " rays, " << format);
        std::vector<Ray> rays = raysAround(mesh, n, n + 1);
        for (uint32_t i = 3; i < n; i += 10) rays[i].tMax = 0;  // Lanes that are done at once.
        requireSame(byWarps(device, bvh, there.view(), format, rays), rayByRay(mesh, rays), n);
      }
    }
}

TEST_CASE("No hit depends on how warps share rays, in any batch of one tracer") {
  const TestMesh mesh = makeInput("random", 500);
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const Bvh bvh = medianTree(device, mesh, 3);
    requireSameHoweverShared<Binary>(device, mesh, Binary::build(device, bvh, there.view()).view());
    requireSameHoweverShared<Wide8>(device, mesh, Wide8::build(device, bvh, there.view()).view());
  }
}

TEST_CASE("No ray beyond a batch is touched") {
  const TestMesh mesh = makeInput("grid", 200);
  const std::vector<Ray> rays = raysAround(mesh, 300, 5);
  const Answers expected = rayByRay(mesh, rays);
  for (const Device& device : devices())
    for (const char* format : formats) {
      const DeviceMesh there(device, mesh);
      const Bvh bvh = medianTree(device, mesh, 3);
      const auto tracer = makeTracer(device, bvh, there.view(), format);
      for (uint32_t n : {0u, 1u, 33u, 300u})
        for (const Answers& answers :
             {byWarps(device, bvh, there.view(), format, rays, n), byTracer(device, *tracer, rays, n)}) {
          requireSame(answers, expected, n);
          requireUntouched(answers, n);
        }
    }
}

TEST_CASE("A tree deeper than the stack loses no hit in any format") {
  // A pile of large triangles, seen from its far end: the way down pushes leaves at each of thousands of nodes.
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
      const Bvh chain = chainTree(device, mesh);
      REQUIRE(Binary::build(device, chain, there.view()).nodes.size() == 4999);
      REQUIRE(Wide8::build(device, chain, there.view()).nodes.size() == 714);  // Seven leaves and the rest.
      for (const char* format : formats) {
        INFO(format);
        requireSame(byWarps(device, chain, there.view(), format, rays), expected, rays.size());
        requireSame(byTracer(device, *makeTracer(device, chain, there.view(), format), rays), expected, rays.size());
      }
    }
  }
}

TEST_CASE("A batch finds what single rays find, whether its rays are coherent or not") {
  const Device cpu = openDevice("cpu");
  for (const char* name : {"random", "one-huge", "two-clusters", "identical"}) {
    const TestMesh mesh = makeInput(name, 2000);
    const Bvh bvh = medianTree(cpu, mesh, 3);
    for (uint32_t n : {1u, 3u, 4u, 9u, 255u, 257u, 2000u}) {
      INFO(name << ", " << n << " rays");
      std::vector<Ray> apart = raysAround(mesh, n, n);
      std::vector<Ray> alike = apart;
      for (Ray& ray : alike) ray.direction = glm::abs(ray.direction);
      for (uint32_t i = 5; i < n; i += 7) apart[i].tMax = alike[i].tMax = 0;
      for (uint32_t i = 6; i < n; i += 70) apart[i].direction = vec3(0);
      for (const std::vector<Ray>& rays : {apart, alike}) {
        const Answers expected = rayByRay(mesh, rays);
        for (const char* format : formats)
          requireSame(byTracer(cpu, *makeTracer(cpu, bvh, mesh.hostView(), format), rays), expected, n);
      }
    }
  }
}

TEST_CASE("All traversals of a tree give the same hit") {
  const Device cpu = openDevice("cpu");
  for (const std::string& name : inputNames()) {
    const TestMesh mesh = makeInput(name, 400);
    const Bvh bvh = medianTree(cpu, mesh, 2);
    const Binary::Tree binaryTree = Binary::build(cpu, bvh, mesh.hostView());
    const Wide8::Tree wideTree = Wide8::build(cpu, bvh, mesh.hostView());
    const Binary::View binary = binaryTree.view();
    const Wide8::View wide = wideTree.view();
    for (const Ray& ray : raysAround(mesh, 500, 2)) {
      const Hit hit = traverse<NodeStep, false>(binary, ray);
      REQUIRE(same(hit, traverse<PairStep, false>(binary, ray)));
      REQUIRE(same(hit, traverse<SteadyPairStep, false>(binary, ray)));
      REQUIRE(same(hit, traverse<WideStep, false>(wide, ray)));
      REQUIRE(same(hit, withoutStack<Binary, false>(binary, ray)));
      REQUIRE(same(hit, withoutStack<Wide8, false>(wide, ray)));
      const bool any = hit.triangle != Hit::none;
      REQUIRE(any == (traverse<NodeStep, true>(binary, ray).triangle != Hit::none));
      REQUIRE(any == (traverse<PairStep, true>(binary, ray).triangle != Hit::none));
      REQUIRE(any == (traverse<SteadyPairStep, true>(binary, ray).triangle != Hit::none));
      REQUIRE(any == (traverse<WideStep, true>(wide, ray).triangle != Hit::none));
      REQUIRE(any == (withoutStack<Binary, true>(binary, ray).triangle != Hit::none));
      REQUIRE(any == (withoutStack<Wide8, true>(wide, ray).triangle != Hit::none));
    }
  }
}

TEST_CASE("Trees of many children per node give the hits of a binary tree in both formats") {
  for (const Device& device : devices())
    for (const std::string& name : inputNames())
      for (uint32_t n : {0u, 1u, 2u, 9u, 33u, 1500u})
        for (int64_t arity : {4, 8}) {
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
          for (const char* format : formats) {
            INFO(name << ", " << n << " triangles, arity " << arity << ", " << format);
            const auto tracer = makeTracer(device, tree, there.view(), format);
            for (uint32_t traced : {300u, 33u}) {
              const Answers answers = byTracer(device, *tracer, rays, traced);
              requireSame(answers, expected, traced);
              requireUntouched(answers, traced);
            }
            requireSame(byWarps(device, tree, there.view(), format, rays), expected, rays.size());
          }
        }
}

TEST_CASE("Wide nodes are filled, or have the children that joints give them") {
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
    Parameters own(tracerParameters());
    own.set("wide.children=own");
    REQUIRE(Wide8::build(device, chain, there.view(), WideRule(own)).nodes.size() == 429);
    for (const Parameters& parameters : {Parameters(tracerParameters()), own})
      requireSame(byTracer(device, *makeTracer(device, chain, there.view(), "wide8", parameters), rays), expected,
                  rays.size());
    // A tree without joints is filled as well: were each node full there would be 73.
    const TestMesh grid = makeInput("random", 512);
    const DeviceMesh gridThere(device, grid);
    WideRule single;
    single.leafMax = 1;
    const Wide8::Tree full = Wide8::build(device, medianTree(device, grid, 1), gridThere.view(), single);
    uint32_t children = 0;
    for (const Wide8Node& node : full.nodes.toHost())
      for (uint32_t k = 0; k < Wide8::width; ++k) children += node.isThere(k);
    CHECK(children == 512 + full.nodes.size() - 1);
    CHECK(full.nodes.size() < 110);
    chain.arity = 9;
    CHECK_THROWS_WITH(Wide8::build(device, chain, there.view()), Contains("more than eight children"));
  }
}

namespace {

void requireSameHits(const std::string& name) {
  const BuilderEntry& builder = findBuilder(name);
  for (const Device& device : devices())
    for (const std::string& input : inputNames())
      for (const uint32_t n : inputSizes()) {
        if (n > 2000) continue;  // Larger trees are validated, in test_builder.
        const TestMesh mesh = makeInput(input, n);
        const std::vector<Ray> rays = raysAround(mesh, 200, 13);
        const Answers expected = rayByRay(mesh, rays);
        const DeviceMesh there(device, mesh);
        const Bvh tree = buildBvh(device, there.view(), builder, withPreset(builder, {}));
        for (const char* format : formats) {
          INFO(name << " on " << input << ", " << n << " triangles, " << format);
          requireSame(byTracer(device, *makeTracer(device, tree, there.view(), format), rays), expected, rays.size());
        }
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
    for (const Bvh& tree : {medianTree(device, mesh, 1), chainTree(device, mesh), leafTree(device, mesh)})
      for (const char* format : formats)
        for (const Answers& answers : {byWarps(device, tree, there.view(), format, rays),
                                       byTracer(device, *makeTracer(device, tree, there.view(), format), rays)})
          for (std::size_t i = 0; i < rays.size(); ++i) {
            INFO("ray " << i << ", " << format);
            CHECK(answers.hits[i].triangle == expected[i]);
            CHECK(answers.occluded[i] == (expected[i] != Hit::none));
            if (expected[i] == Hit::none && rays[i].tMax == rays[i].tMax) CHECK(answers.hits[i].t == rays[i].tMax);
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
    const Bvh tree = medianTree(device, mesh, 4);
    for (const char* format : formats)
      for (const Answers& answers : {byWarps(device, tree, there.view(), format, rays),
                                     byTracer(device, *makeTracer(device, tree, there.view(), format), rays)})
        for (std::size_t i = 0; i < rays.size(); ++i) {
          INFO("ray " << i << ", " << format);
          REQUIRE(answers.hits[i].triangle == Hit::none);
          REQUIRE(answers.occluded[i] == 0);
        }
  }
}
