// No ray slips through a closed mesh: millions of rays from inside, aimed at shared edges and vertices.
#include <cmath>
#include <map>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/tracers.h"

using namespace copse;
using namespace copse::test;

namespace {

/// Closed, around the origin; triangles share their vertices.
TestMesh subdividedCube(uint32_t steps, float size) {
  TestMesh mesh;
  std::map<std::tuple<int, int, int>, uint32_t> vertices;
  auto vertex = [&](const glm::ivec3& p) {
    const auto [at, added] = vertices.try_emplace({p.x, p.y, p.z}, uint32_t(mesh.positions.size()));
    if (added) mesh.positions.push_back((vec3(p) / float(steps) * 2.0f - 1.0f) * size);
    return at->second;
  };
  const int n = int(steps);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          auto corner = [&](int di, int dj) {
            glm::ivec3 p;
            p[axis] = side * n;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = j + dj;
            return vertex(p);
          };
          const uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          mesh.indices.push_back({a, b, c});
          mesh.indices.push_back({a, c, d});
        }
  return mesh;
}

TestMesh sphere(uint32_t steps, float radius) {
  TestMesh mesh = subdividedCube(steps, 1);
  for (vec3& p : mesh.positions) p = radius * glm::normalize(p);
  return mesh;
}

/// A sphere with its vertices pushed in and out: edges at every angle, slivers among them.
TestMesh rock(uint32_t steps, uint32_t seed) {
  TestMesh mesh = sphere(steps, 1);
  std::mt19937 random(seed);
  for (vec3& p : mesh.positions) p *= 0.6f + 0.4f * float(random() % 1000) / 1000;
  return mesh;
}

/// Rays from `origin` at every vertex and at points along every edge.
std::vector<Ray> raysAtEdges(const TestMesh& mesh, const vec3& origin, int perEdge) {
  std::vector<Ray> rays;
  for (const uvec3& t : mesh.indices)
    for (int k = 0; k < 3; ++k) {
      const vec3 a = mesh.positions[t[k]], b = mesh.positions[t[(k + 1) % 3]];
      for (int i = 0; i < perEdge; ++i) {
        const float s = float(i) / float(perEdge);
        rays.push_back({origin, 0, a + s * (b - a) - origin, INFINITY});
      }
    }
  return rays;
}

std::size_t misses(const Device& device, const TestMesh& mesh, const RayTracer& tracer, const vec3& origin,
                   int perEdge) {
  const std::vector<Ray> rays = raysAtEdges(mesh, origin, perEdge);
  const uint32_t n = uint32_t(rays.size());
  const Buffer<Ray> there(device, rays);
  Buffer<Hit> hits(device, n);
  Buffer<uint32_t> any(device, n);
  tracer.closest(device, "closest", n, there.data(), hits.data());
  tracer.any(device, "any", n, there.data(), any.data());
  const std::vector<Hit> found = hits.toHost();
  const std::vector<uint32_t> occluded = any.toHost();
  std::size_t missed = 0;
  for (uint32_t i = 0; i < n; ++i) missed += found[i].triangle == Hit::none || !occluded[i];
  return missed;
}

}  // namespace

TEST_CASE("No ray from inside a closed mesh gets out at an edge or a vertex", "[medium]") {
  for (const Device& device : devices()) {
    const TestMesh meshes[] = {subdividedCube(1, 1),
                               subdividedCube(16, 1),
                               subdividedCube(3, 1e6f),
                               sphere(24, 1),
                               sphere(16, 1e-6f),
                               rock(20, 1),
                               rock(7, 2)};
    for (const TestMesh& mesh : meshes)
      for (uint32_t leaf : {1u, 4u}) {
        const DeviceMesh there(device, mesh);
        const auto tracer = makeTracer(device, medianTree(device, mesh, leaf), there.view());
        const float size = std::abs(mesh.positions[0].x);
        for (const vec3& origin : {vec3(0), vec3(0.1f, 0.02f, -0.13f), vec3(0.25f, 0, 0)}) {
          INFO(mesh.count() << " triangles of size " << size << ", " << leaf << " per leaf, from " << origin.x);
          CHECK(misses(device, mesh, *tracer, size * origin, 9) == 0);
        }
      }
  }
}

TEST_CASE("No ray gets through the seams of a large floor near its origin") {
  // Two by one tiles of millions: boxes without thickness that touch along x = 0, an edge whose ends are so far away
  // that the triangle test, in single precision, sees it where the ray passes some tenths off.
  TestMesh mesh;
  for (float x : {-3e6f, 0.0f, 4e6f})
    for (float z : {-3e6f, 4e6f}) mesh.positions.push_back({x, 0, z});
  mesh.indices = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}};
  std::mt19937 random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < 300000; ++i) {
    auto uniform = [&] { return float(random() >> 8) / (1 << 24); };
    const vec3 origin(uniform() * 2 - 1, uniform() * 0.2f + 0.01f, uniform() * 2 - 1);
    const vec3 target((uniform() - 0.5f) * 0.2f, 0, 50 * uniform() - 25);
    rays.push_back({origin, 0, target - origin, INFINITY});
  }
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const auto tracer = makeTracer(device, medianTree(device, mesh, 1), there.view());
    const Buffer<Ray> raysThere(device, rays);
    Buffer<Hit> hits(device, rays.size());
    tracer->closest(device, "closest", uint32_t(rays.size()), raysThere.data(), hits.data());
    std::size_t missed = 0;
    float worst = 0;
    for (const Hit& hit : hits.toHost()) {
      missed += hit.triangle == Hit::none;
      worst = std::max(worst, std::abs(hit.t - 1));
    }
    CHECK(missed == 0);
    CHECK(worst < 1e-4f);  // Every target is at distance 1.
  }
}

TEST_CASE("Rays along the planes of a grid hit what they touch") {
  // From inside a cube of unit squares, exactly at the squares' corners; those of the outermost run in a face's plane.
  for (const Device& device : devices()) {
    const TestMesh cube = subdividedCube(8, 4);
    const DeviceMesh there(device, cube);
    const auto tracer = makeTracer(device, medianTree(device, cube, 2), there.view());
    std::vector<Ray> rays;
    for (int axis = 0; axis < 3; ++axis)
      for (float sign : {-1.0f, 1.0f})
        for (float zero : {0.0f, -0.0f, 1e-40f, -1e-45f, 1e-30f})
          for (int i = -4; i <= 4; ++i)
            for (int j = -4; j <= 4; ++j) {
              if (zero != 0 && (std::abs(i) == 4 || std::abs(j) == 4)) continue;  // These may leave the cube.
              vec3 origin, direction(zero);
              origin[axis] = 0;
              origin[(axis + 1) % 3] = float(i);
              origin[(axis + 2) % 3] = float(j);
              direction[axis] = sign;
              rays.push_back({origin, 0, direction, INFINITY});
            }
    const Buffer<Ray> raysThere(device, rays);
    Buffer<Hit> hits(device, rays.size());
    tracer->closest(device, "closest", uint32_t(rays.size()), raysThere.data(), hits.data());
    for (const Hit& hit : hits.toHost()) {
      REQUIRE(hit.triangle != Hit::none);
      REQUIRE(hit.t == Approx(4));
    }
  }
}

TEST_CASE("A ray that passes an edge nearer than single precision can tell hits the triangle on its own side alone") {
  // With e = 2^-23 the edge from B to C passes the z axis at a distance of about e²/2.
  const float e = 1.0f / (1 << 23);
  const vec3 b(1 + e, 1, 1), c(-1, -(1 - e), 1);
  TestMesh mesh;
  mesh.positions = {vec3(-1, 1, 1), b, c, vec3(1, -1, 1)};
  mesh.indices = {{0, 1, 2}, {3, 2, 1}};
  const std::vector<Ray> rays{{vec3(0), 0, vec3(0, 0, 1), INFINITY}};
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    const auto tracer = makeTracer(device, medianTree(device, mesh, 2), there.view());
    const Buffer<Ray> raysThere(device, rays);
    Buffer<Hit> hit(device, 1);
    tracer->closest(device, "closest", 1, raysThere.data(), hit.data());
    CHECK(hit.read(0).triangle == 1);  // Were both hit, it would be the lower one.
  }
}
