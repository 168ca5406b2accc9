// Ray sets as a path tracer would make them, from a fixed seed.
#include "tests/benchmarks/bench_ray_sets.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <random>

namespace copse::baselines {

namespace {

struct Surface {
  vec3 point, normal;  ///< The unit normal on the ray's side.
};

Surface surfaceAt(const Scene& scene, const Ray& ray, const Hit& hit) {
  const uvec3 t = scene.triangles[hit.triangle];
  const vec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
  vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  if (glm::dot(normal, ray.direction) > 0) normal = -normal;
  const vec3 point = (1 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
  const float size = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z), hit.t});
  return {point + normal * (size * 1e-5f), normal};
}

class Draws {
 public:
  explicit Draws(uint64_t seed) : random_(seed) {}
  float uniform() { return static_cast<float>(random_() >> 40) / (1 << 24); }

  vec3 cosineAround(const vec3& normal) {
    const float z = 1 - 2 * uniform(), phi = 2 * float(M_PI) * uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    const vec3 direction = normal + vec3(r * std::cos(phi), r * std::sin(phi), z);
    const float length = glm::length(direction);
    return length > 1e-4f ? direction / length : normal;
  }

  /// On a quad, an emitting triangle, or, where the sky is the only light, far up.
  vec3 onLight(const Scene& scene, const std::vector<uint32_t>& emitters, const Box& bounds) {
    float u = uniform(), v = uniform();
    if (!scene.quads.empty()) {
      const QuadLight& quad = scene.quads[random_() % scene.quads.size()];
      return quad.corner + u * quad.edgeU + v * quad.edgeV;
    }
    if (!emitters.empty()) {
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const uvec3 t = scene.triangles[emitters[random_() % emitters.size()]];
      return (1 - u - v) * scene.positions[t.x] + u * scene.positions[t.y] + v * scene.positions[t.z];
    }
    return (bounds.lo + bounds.hi) * 0.5f + cosineAround(vec3(0, 1, 0)) * (2 * glm::length(bounds.hi - bounds.lo));
  }

 private:
  std::mt19937_64 random_;
};

std::vector<Ray> primaryRays(const Camera& camera, int width, int height, Draws& draws) {
  const vec3 forward = glm::normalize(camera.at - camera.eye), right = glm::normalize(glm::cross(forward, camera.up)),
             up = glm::cross(right, forward);
  const float half = std::tan(camera.vfov * float(M_PI) / 360);
  std::vector<Ray> rays;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float px = (2 * (x + draws.uniform()) / width - 1) * half * width / height;
      const float py = (1 - 2 * (y + draws.uniform()) / height) * half;
      rays.push_back({camera.eye, 0, glm::normalize(forward + px * right + py * up), FLT_MAX});
    }
  return rays;
}

std::vector<Surface> hitSurfaces(const Device& cpu, const Scene& scene, const RayTracer& tracer,
                                 const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  tracer.closest(cpu, "ray sets", static_cast<uint32_t>(rays.size()), rays.data(), hits.data());
  std::vector<Surface> surfaces;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].triangle != Hit::none) surfaces.push_back(surfaceAt(scene, rays[i], hits[i]));
  return surfaces;
}

}  // namespace

std::vector<RaySet> raySets(const Device& cpu, const Scene& scene, const Camera& camera, int width, int height,
                            const RayTracer& tracer, uint64_t seed) {
  Draws draws(seed);
  const Box bounds = scene.bounds();
  std::vector<uint32_t> emitters;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i)
    if (scene.emits(i)) emitters.push_back(i);

  auto shadows = [&](const std::vector<Surface>& from) {
    std::vector<Ray> rays;
    for (const Surface& s : from)
      rays.push_back({s.point, 0, draws.onLight(scene, emitters, bounds) - s.point, 1 - 1e-4f});
    return rays;
  };
  const std::vector<Ray> primary = primaryRays(camera, width, height, draws);
  const std::vector<Surface> first = hitSurfaces(cpu, scene, tracer, primary);
  std::vector<Ray> bounce;
  for (const Surface& s : first) bounce.push_back({s.point, 0, draws.cosineAround(s.normal), FLT_MAX});
  const std::vector<Surface> second = hitSurfaces(cpu, scene, tracer, bounce);
  const std::vector<Ray> shadow0 = shadows(first), shadow1 = shadows(second);
  return {
      {"primary", false, primary}, {"bounce", false, bounce}, {"shadow0", true, shadow0}, {"shadow1", true, shadow1}};
}

}  // namespace copse::baselines
