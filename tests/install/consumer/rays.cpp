// Rays through an installed Copse's trees by its headers, compiled here with this project's flags, and by its library,
// compiled with others: both find what a loop over all triangles finds, bit for bit. Prints a hash of the hits, which
// does not depend on flags either.
#include <cstdio>
#include <cstring>

#include "builder/build.h"
#include "builder/math/random.h"
#include "tracer/accel/counting.h"
#include "tracer/accel/trace.h"

using namespace copse;

namespace {

/// Number `i` of a row that differs by `purpose`, of -1 … 1.
float number(uint32_t purpose, uint32_t i) {
  return 2 * unitFloat(highWord(randomBits(randomKey(purpose, i, 0), 0, 0))) - 1;
}
vec3 point(uint32_t purpose, uint32_t i) {
  return {number(purpose, i), number(purpose + 1, i), number(purpose + 2, i)};
}

struct Mesh {
  std::vector<vec3> corners;
  std::vector<uvec3> triangles;
};

Mesh smallTriangles(uint32_t count) {
  Mesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const vec3 centre = point(1, i);
    for (uint32_t c = 0; c < 3; ++c) mesh.corners.push_back(centre + 0.1f * point(10 + 3 * c, i));
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

/// Every third one along an axis, which is where a box test divides by 0.
std::vector<Ray> raysFromWithin(uint32_t count) {
  std::vector<Ray> rays(count);
  for (uint32_t i = 0; i < count; ++i) {
    vec3 direction = point(24, i);
    if (i % 3 == 0) direction[i % 2] = direction[2] = i % 2 ? 0.0f : -0.0f;
    rays[i] = {point(20, i), 0, direction, i % 5 == 0 ? 0.5f : 1e30f};
  }
  return rays;
}

Hit amongAll(const TraversalView& view, const Ray& ray) {
  Hit best{ray.tMax, 0, 0, Hit::none};
  const detail::RayInTree r(view, ray);
  for (uint32_t i = 0; i < view.triangleCount; ++i) intersect(r.triangles, r.boxes, r.tMin, view.triangles[i], best);
  return best;
}

/// How far it is to the nearest triangle by a few lines that are nobody else's.
double distanceInDouble(const Mesh& mesh, const Ray& ray) {
  double nearest = ray.tMax;
  const glm::dvec3 o(ray.origin), d(ray.direction);
  for (const uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.corners[t.x]), e = glm::dvec3(mesh.corners[t.y]) - a, f = glm::dvec3(mesh.corners[t.z]) - a;
    const glm::dvec3 p = glm::cross(d, f), q = glm::cross(o - a, e);
    const double det = glm::dot(e, p), u = glm::dot(o - a, p) / det, v = glm::dot(d, q) / det;
    const double distance = glm::dot(f, q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && distance < nearest) nearest = distance;
  }
  return nearest;
}

/// FNV-1a.
uint64_t hashOf(const std::vector<Hit>& hits) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const Hit& hit : hits) {
    unsigned char bytes[sizeof hit];
    std::memcpy(bytes, &hit, sizeof hit);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  }
  return hash;
}

bool same(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// How many of the rays are answered in two ways; `builder` is printed with it.
uint32_t differences(const Device& device, const Mesh& mesh, const char* name, const char* parameter) {
  const Buffer<vec3> corners(device, mesh.corners);
  const Buffer<uvec3> triangles(device, mesh.triangles);
  const TrianglesView there{corners.data(), triangles.data(), static_cast<uint32_t>(mesh.triangles.size())};
  const BuilderEntry& builder = findBuilder(name);
  Parameters parameters;
  parameters.set(parameter);
  const Bvh tree = buildBvh(device, there, builder, withPreset(builder, parameters));
  const TraversalBvh traversal = traversalBvh(device, tree, there);
  const TraversalView view = traversal.view();

  const std::vector<Ray> rays = raysFromWithin(3000);
  std::vector<Hit> hits(rays.size());
  std::vector<uint32_t> occluded(rays.size());
  traceClosest(device, "closest", view, static_cast<uint32_t>(rays.size()), rays.data(), hits.data());
  traceAny(device, "any", view, static_cast<uint32_t>(rays.size()), rays.data(), occluded.data());

  uint32_t found = 0, byLibrary = 0, byHeader = 0, byCount = 0, inDouble = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = amongAll(view, rays[i]);
    const bool hit = expected.triangle != Hit::none;
    TraversalSteps steps;
    found += hit;
    byLibrary += !same(hits[i], expected) || (occluded[i] != 0) != hit;
    byHeader += !same(closestHit(view, rays[i]), expected) || anyHit(view, rays[i]) != hit;
    byCount += !same(countedHit<false>(view, rays[i], steps), expected);
    const double distance = distanceInDouble(mesh, rays[i]);
    inDouble += !(distance > 0.999 * expected.t && distance < 1.001 * expected.t);
  }
  std::printf(
      "%s, %s: of %zu rays %u hit, %016llx, wrong by the library %u, by a header %u, counted %u, in double %u\n", name,
      parameter, rays.size(), found, static_cast<unsigned long long>(hashOf(hits)), byLibrary, byHeader, byCount,
      inDouble);
  return byLibrary + byHeader + byCount + (inDouble > rays.size() / 100) + (found < rays.size() / 4);
}

}  // namespace

int main() {
  const Device device = openDevice("cpu");
  const Mesh mesh = smallTriangles(3000);
  return differences(device, mesh, "lbvh", "leaf.max=4") + differences(device, mesh, "kmeans", "kmeans.arity=8") ? 1
                                                                                                                 : 0;
}
