// tracer/accel: hits against brute force, on every kind of tree and triangle, with ordinary and awkward rays.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/tracers.h"

using namespace copse;
using namespace copse::test;

namespace {

std::vector<Hit> closestOf(const Device& device, const RayTracer& tracer, const std::vector<Ray>& rays) {
  const Buffer<Ray> there(device, rays);
  Buffer<Hit> hits(device, rays.size());
  tracer.closest(device, "closest", uint32_t(rays.size()), there.data(), hits.data());
  return hits.toHost();
}

std::vector<uint32_t> anyOf(const Device& device, const RayTracer& tracer, const std::vector<Ray>& rays) {
  const Buffer<Ray> there(device, rays);
  Buffer<uint32_t> occluded(device, rays.size());
  tracer.any(device, "any", uint32_t(rays.size()), there.data(), occluded.data());
  return occluded.toHost();
}

bool same(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Tests every triangle by the same ray-triangle test, without a tree.
std::vector<Hit> everyTriangle(const TestMesh& mesh, const std::vector<Ray>& rays) {
  const Device cpu = openDevice("cpu");
  return closestOf(cpu, *makeTracer(cpu, leafTree(cpu, mesh), mesh.hostView()), rays);
}

/// Distance of the nearest hit in double precision (Moeller and Trumbore's equations); infinite for none. `margin`
/// is 0 where a triangle is hit at an edge or grazed, and otherwise how close the hits are to the limits.
double distanceInDouble(const TestMesh& mesh, const Ray& ray, double& margin) {
  double nearest = std::numeric_limits<double>::infinity();
  margin = 1;
  const glm::dvec3 o = ray.origin, d = ray.direction;
  for (const uvec3& t : mesh.indices) {
    const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(d, e2);
    const double det = glm::dot(e1, p);
    if (det == 0) continue;
    const glm::dvec3 s = o - a, q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det, distance = glm::dot(e2, q) / det;
    const double inside = std::min({u, v, 1 - u - v});
    const double area = glm::length(glm::cross(e1, e2)),
                 longest = std::max({glm::length(e1), glm::length(e2), glm::length(c - b)});
    const double height = area / longest / std::max({glm::length(s), glm::length(o - b), glm::length(o - c)});
    const double grazing = std::abs(det) / (area * glm::length(d));
    if (std::abs(inside) * height > 1e-5 && grazing > 1e-3) {
      if (inside < 0) continue;
    } else if (inside > -0.1) {
      margin = 0;
    }
    margin = std::min({margin, std::abs(distance - ray.tMin), std::abs(distance - ray.tMax)});
    if (!(distance > ray.tMin && distance < ray.tMax)) continue;
    if (inside >= 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

}  // namespace

TEST_CASE("Hits depend on the triangles and not on the tree, for every kind of triangles") {
  for (const Device& device : devices())
    for (const std::string& name : inputNames())
      for (uint32_t n : {0u, 1u, 2u, 3u, 8u, 33u, 700u}) {
        const TestMesh mesh = makeInput(name, n);
        const DeviceMesh there(device, mesh);
        const std::vector<Ray> rays = raysAround(mesh, 500, n);
        const std::vector<Hit> expected = everyTriangle(mesh, rays);
        for (const auto& [leaf, format] : {std::pair{1u, "binary"},
                                           {4u, "binary"},
                                           {1000u, "binary"},
                                           {1u, "wide8"},
                                           {4u, "wide8"},
                                           {1000u, "wide8"}}) {
          INFO(name << ", " << n << " triangles, " << leaf << " per leaf, " << format);
          const auto tracer = makeTracer(device, medianTree(device, mesh, leaf), there.view(), format);
          const std::vector<Hit> hits = closestOf(device, *tracer, rays);
          const std::vector<uint32_t> any = anyOf(device, *tracer, rays);
          for (std::size_t i = 0; i < rays.size(); ++i) {
            if (same(hits[i], expected[i]) && any[i] == (expected[i].triangle != Hit::none)) continue;
            FAIL("ray " << i << ": triangle " << hits[i].triangle << " at " << hits[i].t << ", occluded " << any[i]
                        << ", expected " << expected[i].triangle << " at " << expected[i].t);
          }
        }
      }
}

TEST_CASE("Two nodes are a pair only where both are inner nodes, also at the end of a tree in depth-first order") {
  for (const Device& device : devices()) {
    const TestMesh mesh = makeInput("random", 4);
    // The last node is a leaf, and its sibling the last inner node.
    const Box box;
    Bvh tree;
    tree.nodes = Buffer<BvhNode>(
        device, std::vector<BvhNode>{BvhNode::inner(box, 1, 2), BvhNode::leaf(box, 0, 1), BvhNode::inner(box, 3, 6),
                                     BvhNode::inner(box, 4, 5), BvhNode::leaf(box, 1, 1), BvhNode::leaf(box, 2, 1),
                                     BvhNode::leaf(box, 3, 1)});
    tree.order = Buffer<uint32_t>(device, std::vector<uint32_t>{0, 1, 2, 3});
    tree.nodeCount = 7;
    tree.referenceCount = tree.triangleCount = 4;
    const DeviceMesh there(device, mesh);
    for (const BinaryNode& node : Binary::build(device, tree, there.view()).nodes.toHost())
      for (int c : {0, 1}) REQUIRE(node.below[c] == node.child[c]);
  }
}

TEST_CASE("Hits agree with brute force in double precision") {
  const Device device = chosenDevice();
  for (const char* name : {"random", "coplanar", "grid", "one-huge", "negative", "large", "tiny"}) {
    const TestMesh mesh = makeInput(name, 300);
    const DeviceMesh onDevice(device, mesh);
    const std::vector<Ray> rays = raysAround(mesh, 3000, 7);
    const std::vector<Hit> hits =
        closestOf(device, *makeTracer(device, medianTree(device, mesh, 4), onDevice.view()), rays);
    int compared = 0, hit = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      double margin;
      const double expected = distanceInDouble(mesh, rays[i], margin);
      if (margin < 1e-4) continue;  // At an edge: either answer is right.
      INFO(name << ", ray " << i);
      ++compared;
      REQUIRE((hits[i].triangle != Hit::none) == std::isfinite(expected));
      if (!std::isfinite(expected)) continue;
      ++hit;
      REQUIRE(hits[i].t == Approx(expected).epsilon(1e-4));
    }
    CHECK(compared > 400);
    CHECK(hit > 100);
  }
}
