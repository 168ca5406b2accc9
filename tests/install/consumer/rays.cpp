// Rays through an installed Copse's trees by its headers, compiled here with this project's flags, and by its library,
// compiled with others: both find what a loop over all triangles finds, bit for bit. Prints a hash of the hits, which
// does not depend on flags either.
#include <cstdio>
#include <cstring>

#include "builder/build.h"
#include "builder/math/random.h"
#include "tracer/accel/binary_steps.h"
#include "tracer/accel/tracers.h"
#include "tracer/accel/wide8_steps.h"

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

Hit amongAll(const Binary::View& view, uint32_t triangles, const Ray& ray) {
  Walk<NodeStep, false> walk;
  walk.start(view, ray);
  Hit best = walk.best;
  for (uint32_t i = 0; i < triangles; ++i) intersect(TriangleRay(ray), walk.boxes, walk.tMin, view.triangles[i], best);
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

/// Whether both queries, by the header's step, find the hit that is expected.
template <class Step>
bool byStep(const typename Step::Format::View& view, const Ray& ray, const Hit& expected) {
  return same(traverse<Step, false>(view, ray), expected) &&
         (traverse<Step, true>(view, ray).triangle != Hit::none) == (expected.triangle != Hit::none);
}

/// How many of the rays are answered in two ways; `builder` is printed with it.
uint32_t differences(const Device& device, const Mesh& mesh, const char* name, const char* parameter) {
  const Buffer<vec3> corners(device, mesh.corners);
  const Buffer<uvec3> triangles(device, mesh.triangles);
  const TrianglesView there{corners.data(), triangles.data(), static_cast<uint32_t>(mesh.triangles.size())};
  const BuilderEntry& builder = findBuilder(name);
  Parameters parameters;
  parameters.set(parameter);
  const Bvh tree = buildBvh(device, there, builder, withPreset(builder, parameters));
  const Binary::Tree binary = Binary::build(device, tree, there);
  const Wide8::Tree wide = Wide8::build(device, tree, there);

  const std::vector<Ray> rays = raysFromWithin(3000);
  const auto count = static_cast<uint32_t>(rays.size());
  uint32_t found = 0, byLibrary = 0, byHeader = 0, byCount = 0, inDouble = 0;
  std::vector<Hit> expected;
  for (const Ray& ray : rays) {
    const Hit hit = amongAll(binary.view(), there.count, ray);
    expected.push_back(hit);
    found += hit.triangle != Hit::none;
    byHeader += !byStep<NodeStep>(binary.view(), ray, hit) || !byStep<PairStep>(binary.view(), ray, hit) ||
                !byStep<SteadyPairStep>(binary.view(), ray, hit) || !byStep<WideStep>(wide.view(), ray, hit);
    const double distance = distanceInDouble(mesh, ray);
    inDouble += !(distance > 0.999 * hit.t && distance < 1.001 * hit.t);
  }
  for (const char* format : {"binary", "wide8"}) {
    const auto tracer = makeTracer(device, tree, there, format);
    std::vector<Hit> hits(count), counted(count);
    std::vector<uint32_t> occluded(count);
    std::vector<RaySteps> steps(count);
    tracer->closest(device, "closest", count, rays.data(), hits.data());
    tracer->any(device, "any", count, rays.data(), occluded.data());
    tracer->stepTracer()->closest(device, "count", count, rays.data(), counted.data(), steps.data());
    for (uint32_t i = 0; i < count; ++i) {
      byLibrary += !same(hits[i], expected[i]) || (occluded[i] != 0) != (expected[i].triangle != Hit::none);
      byCount += !same(counted[i], expected[i]);
    }
  }
  std::printf(
      "%s, %s: of %zu rays %u hit, %016llx, wrong by the library %u, by a header %u, counted %u, in double %u\n", name,
      parameter, rays.size(), found, static_cast<unsigned long long>(hashOf(expected)), byLibrary, byHeader, byCount,
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
