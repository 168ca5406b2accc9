// The sums of normals, albedo and depth, and their means.
#include "tracer/integrators/surfaces/surface_buffers.h"

#include <cmath>

#include "tracer/integrators/film.h"
#include "tracer/materials/surface.h"

namespace copse {

namespace {

/// The film's sum: one sample, or all samples of a pixel; exact enough for a million.
struct alignas(16) SurfaceSums {
  double normal[3], albedo[3], depth;
  uint64_t hits;

  HD SurfaceSums& operator+=(const SurfaceSums& other) {
    for (int c = 0; c < 3; ++c) {
      normal[c] += other.normal[c];
      albedo[c] += other.albedo[c];
    }
    depth += other.depth;
    hits += other.hits;
    return *this;
  }
};

struct AddSurfaces {
  SceneView scene;
  const Ray* rays;
  const Hit* hits;
  vec3 forward;
  float start;  ///< As Pinhole's.

  HD SurfaceSums operator()(const FilmSample& sample) const {
    const Hit hit = hits[sample.place];
    if (hit.triangle == Hit::none) return {};
    const vec3 direction = rays[sample.place].direction;
    const SurfaceTriangle triangle = scene.triangles[hit.triangle];
    vec3 normal = unitNormal(triangle.edge1, triangle.edge2);
    if (glm::dot(normal, direction) > 0) normal = -normal;
    const vec3 reflected = albedo(scene, scene.materials[triangle.material], hit);
    return {{normal.x, normal.y, normal.z},
            {reflected.x, reflected.y, reflected.z},
            start + hit.t * glm::dot(direction, forward),
            1};
  }
};

struct MeanSurfaces {
  vec3 *normals, *albedo;
  float* depth;

  HD void operator()(uint32_t pixel, const SurfaceSums& sum, uint64_t samples) const {
    const double part = samples ? 1.0 / static_cast<double>(samples) : 0;
    for (int c = 0; c < 3; ++c) {
      normals[pixel][c] = static_cast<float>(sum.normal[c] * part);
      albedo[pixel][c] = static_cast<float>(sum.albedo[c] * part);
    }
    depth[pixel] = sum.hits ? static_cast<float>(sum.depth / static_cast<double>(sum.hits)) : INFINITY;
  }
};

Image toImage(const Buffer<vec3>& pixels, int width, int height) { return {width, height, pixels.toHost()}; }

}  // namespace

struct SurfaceFilm::Sums {
  Film<SurfaceSums> film;
};

SurfaceFilm::SurfaceFilm(const Device& device, const SceneView& scene, const Pinhole& pinhole, const PixelOrder& order)
    : scene_(scene),
      forward_(pinhole.forward()),
      start_(pinhole.start),
      sums_(new Sums{Film<SurfaceSums>(device, order)}) {}
SurfaceFilm::~SurfaceFilm() = default;

void SurfaceFilm::add(const Device& device, const PrimaryBatch& batch) {
  sums_->film.add(device, phases::surfaces, batch.first, batch.count,
                  AddSurfaces{scene_, batch.rays, batch.hits, forward_, start_});
}

SurfaceBuffers SurfaceFilm::finish(const Device& device, uint64_t done, int width, int height) {
  const uint32_t pixels = sums_->film.pixels();
  Buffer<vec3> normals(device, pixels), albedo(device, pixels);
  Buffer<float> depth(device, pixels);
  sums_->film.finish(device, phases::surfaces, done, MeanSurfaces{normals.data(), albedo.data(), depth.data()});
  return {toImage(normals, width, height), toImage(albedo, width, height), depth.toHost()};
}

namespace {

class Surfaces final : public PrimaryFilm {
 public:
  Surfaces(const Device& device, const SceneView& scene, const Pinhole& pinhole, const PixelOrder& order)
      : film(device, scene, pinhole, order) {}
  void add(const Device& device, const PrimaryBatch& batch) override { film.add(device, batch); }

  SurfaceFilm film;
};

}  // namespace

SurfaceResult renderSurfaces(const Device& device, const SceneView& scene, const RayTracer& tracer,
                             const Camera& camera, const RenderSettings& settings, const Watch& watch, uint32_t queue) {
  checkSettings(settings);
  const Pinhole pinhole = makePinhole(camera, settings.width, settings.height);
  const PixelOrder order(device, settings.width, settings.height);
  Surfaces surfaces(device, scene, pinhole, order);
  SurfaceResult result;
  result.samples = tracePrimary(device, tracer, pinhole, settings, order, surfaces, watch, queue);
  result.buffers = surfaces.film.finish(device, result.samples, settings.width, settings.height);
  return result;
}

}  // namespace copse
