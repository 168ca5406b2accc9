// The reference tracer's intersection against algebra, and its tree against trying every triangle.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/small_scenes.h"
#include "tracer/integrators/reference/tree.h"

using namespace copse;
using namespace copse::test;
using glm::dvec3;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

dvec3 randomPoint(std::mt19937& random, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

/// Triangles of all sizes in a cube.
Scene crowd(int count, unsigned seed) {
  std::mt19937 random(seed);
  Scene scene;
  scene.materials.push_back({});
  for (int i = 0; i < count; ++i) {
    const dvec3 a = randomPoint(random, 1);
    const double size = std::exp2(-double(i % 8));
    addTriangle(scene, a, a + randomPoint(random, size), a + randomPoint(random, size), 0);
  }
  return scene;
}

/// Solves a + b1 (b-a) + b2 (c-a) = o + t d.
dvec3 solve(const Scene& scene, uint32_t triangle, dvec3 o, dvec3 d) {
  const uvec3 t = scene.triangles[triangle];
  const dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
  return glm::inverse(glm::dmat3(-d, b - a, c - a)) * (o - a);  // t, b1, b2.
}

}  // namespace

TEST_CASE("The nearest hit is the one that linear algebra finds among all triangles") {
  const Scene scene = crowd(600, 1);
  const ReferenceTree tree(scene);
  std::mt19937 random(2);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 o = randomPoint(random, 2), d = randomPoint(random, 1);  // Not of length 1.
    double best = infinity;
    uint32_t which = 0;
    for (uint32_t k = 0; k < scene.triangles.size(); ++k) {
      const dvec3 x = solve(scene, k, o, d);
      if (x[0] > 0 && x[0] < best && x[1] >= 0 && x[2] >= 0 && x[1] + x[2] <= 1) best = x[0], which = k;
    }
    ReferenceHit hit;
    const bool found = tree.closest(o, d, 0, infinity, hit);
    REQUIRE(found == (best < infinity));
    REQUIRE(tree.occluded(o, d, 0, infinity) == found);
    if (!found) continue;
    ++hits;
    const dvec3 x = solve(scene, which, o, d);
    CHECK(hit.triangle == which);
    CHECK(hit.t == Approx(best).epsilon(1e-9));
    CHECK(hit.b[1] == Approx(x[1]).margin(1e-7));
    CHECK(hit.b[2] == Approx(x[2]).margin(1e-7));
    CHECK(hit.b[0] + hit.b[1] + hit.b[2] == Approx(1));
    // Either end of the ray's interval leaves the hit out.
    CHECK(!tree.occluded(o, d, 0, best * (1 - 1e-9)));
    ReferenceHit next;
    if (tree.closest(o, d, best * (1 + 1e-9), infinity, next)) CHECK(next.triangle != which);
  }
  CHECK(hits > 500);
}

TEST_CASE("No ray from inside a closed mesh gets out, aimed at its edges or along its axes", "[medium]") {
  const Scene scene = sphereScene(1, vec3(0), 3);
  const ReferenceTree tree(scene);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  int missed = 0, rays = 0;
  const auto shoot = [&](dvec3 from, dvec3 to) {
    missed += !tree.occluded(from, to - from, 0, infinity);
    ++rays;
  };
  for (const dvec3 from : {dvec3(0), dvec3(0.3, -0.2, 0.1), dvec3(0, 0.5, 0)})
    for (const uvec3& t : scene.triangles)
      for (int k = 0; k < 3; ++k) {
        const dvec3 a = scene.positions[t[k]], b = scene.positions[t[(k + 1) % 3]];
        shoot(from, (a + b) / 2.0);
        for (int i = 0; i < 4; ++i) shoot(from, glm::mix(a, b, uniform(random)));
      }
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      dvec3 d(0);
      d[axis] = sign;
      shoot(dvec3(0), d);
      shoot(dvec3(0, 0, -0.0), d);
    }
  CHECK(rays > 10000);
  CHECK(missed == 0);
}

TEST_CASE("Triangles without area, with NaN and far too large ones are left out, equal ones are no trouble") {
  Scene scene;
  scene.materials.push_back({});
  const float nan = std::nanf("");
  addTriangle(scene, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, 0);
  addTriangle(scene, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0);
  addTriangle(scene, {nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  addTriangle(scene, {0, 0, 1}, {std::numeric_limits<float>::infinity(), 0, 1}, {0, 1, 1}, 0);
  CHECK(!ReferenceTree(scene).occluded({0.1, 0.1, -5}, {0, 0, 1}, 0, infinity));
  for (int i = 0; i < 100; ++i) addTriangle(scene, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}, 0);
  ReferenceHit hit;
  REQUIRE(ReferenceTree(scene).closest({0.1, 0.1, -5}, {0, 0, 1}, 0, infinity, hit));
  CHECK(hit.t == 7);
  CHECK(hit.triangle >= 4);
}

TEST_CASE("A tree of nothing is hit by nothing") {
  const Scene scene;
  CHECK(!ReferenceTree(scene).occluded({0, 0, 0}, {0, 0, 1}, 0, infinity));
}
