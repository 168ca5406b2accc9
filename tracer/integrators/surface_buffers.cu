// One call a pixel adds a batch's samples in their order, so neither threads nor the size of a batch show in the sums.
#include "tracer/integrators/surface_buffers.h"

#include <cmath>
#include <limits>

#include "builder/parallel/launch.h"
#include "tracer/integrators/path/surface.h"

namespace copse {

namespace {

struct AddSurfaces {
  SceneView scene;
  PrimaryBatch batch;
  vec3 forward;
  uint32_t pixels;
  SurfaceSums* sums;

  HD void operator()(uint32_t j) const {
    SurfaceSums& pixel = sums[(batch.first + j) % pixels];
    SurfaceSums sum = pixel;
    for (uint64_t i = j; i < batch.count; i += pixels) {
      const Hit hit = batch.hits[i];
      if (hit.triangle == Hit::none) continue;
      const vec3 direction = batch.rays[i].direction;
      const SurfaceTriangle triangle = scene.triangles[hit.triangle];
      vec3 normal = unitNormal(triangle.edge1, triangle.edge2);
      if (glm::dot(normal, direction) > 0) normal = -normal;
      const vec3 reflected = albedo(scene, scene.materials[triangle.material], hit);
      for (int c = 0; c < 3; ++c) {
        sum.normal[c] += normal[c];
        sum.albedo[c] += reflected[c];
      }
      sum.depth += hit.t * glm::dot(direction, forward);
      ++sum.hits;
    }
    pixel = sum;
  }
};

struct Means {
  const SurfaceSums* sums;
  uint64_t whole;  ///< Samples that every pixel has.
  uint32_t more;   ///< Pixels below it have one more.
  vec3 *normals, *albedo;
  float* depth;

  HD void operator()(uint32_t i) const {
    const SurfaceSums& sum = sums[i];
    const uint64_t samples = whole + (i < more ? 1 : 0);
    const double part = samples ? 1.0 / static_cast<double>(samples) : 0;
    for (int c = 0; c < 3; ++c) {
      normals[i][c] = static_cast<float>(sum.normal[c] * part);
      albedo[i][c] = static_cast<float>(sum.albedo[c] * part);
    }
    depth[i] = sum.hits ? static_cast<float>(sum.depth / static_cast<double>(sum.hits)) : INFINITY;
  }
};

Image toImage(const Buffer<vec3>& pixels, int width, int height) { return {width, height, pixels.toHost()}; }

}  // namespace

SurfaceFilm::SurfaceFilm(const Device& device, const SceneView& scene, const Camera& camera, uint32_t pixels)
    : scene_(scene), forward_(camera.forward()), pixels_(pixels), sums_(device, pixels) {
  sums_.fill(0);
}

void SurfaceFilm::add(const Device& device, const PrimaryBatch& batch) {
  launch(device, "surfaces", batch.count < pixels_ ? batch.count : pixels_,
         AddSurfaces{scene_, batch, forward_, pixels_, sums_.data()});
}

SurfaceBuffers SurfaceFilm::finish(const Device& device, uint64_t done, int width, int height) const {
  Buffer<vec3> normals(device, pixels_), albedo(device, pixels_);
  Buffer<float> depth(device, pixels_);
  launch(device, "surfaces", pixels_,
         Means{sums_.data(), done / pixels_, static_cast<uint32_t>(done % pixels_), normals.data(), albedo.data(),
               depth.data()});
  return {toImage(normals, width, height), toImage(albedo, width, height), depth.toHost()};
}

}  // namespace copse
