// Camera rays alone: what every picture that is no light transport is made of. The rays are the path tracer's own,
// sample for sample.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/accel/ray_tracer.h"
#include "tracer/integrators/settings.h"
#include "tracer/integrators/surface_buffers.h"

namespace copse {

/// Takes batch after batch of rays with their hits.
class PrimaryFilm {
 public:
  virtual ~PrimaryFilm() = default;
  virtual void add(const Device& device, const PrimaryBatch& batch) = 0;
};

/// Traces spp camera rays a pixel and hands them to `film`. Phases "generate" and `name`, and the film's own. `queue`
/// rays at a time, 0 for as many as suit the device. Returns the samples traced: less than asked for, by any part of
/// an image, where it was stopped. Throws InputError for settings that nothing can be rendered with.
uint64_t tracePrimary(const Device& device, const RayTracer& tracer, const Camera& camera,
                      const RenderSettings& settings, PrimaryFilm& film, const Watch& watch = {}, uint32_t queue = 0,
                      const char* name = "trace primary");

struct SurfaceResult {
  SurfaceBuffers buffers;
  uint64_t samples = 0;  ///< Over all pixels; each was one ray.
};

/// Normals, albedo and depth without any light. Phase "surfaces" beside those of tracePrimary.
SurfaceResult renderSurfaces(const Device& device, const SceneView& scene, const RayTracer& tracer, const View& view,
                             const RenderSettings& settings, const Watch& watch = {}, uint32_t queue = 0);

}  // namespace copse
