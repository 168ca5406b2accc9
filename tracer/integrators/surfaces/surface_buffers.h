// The normals, albedo and depth of the surfaces that the camera sees. They come from the first hits of camera rays, so
// a path render gives them for one more kernel per batch. 64 bytes per pixel while rendering.
#pragma once

#include <memory>
#include <vector>

#include "tracer/integrators/primary_rays.h"
#include "tracer/materials/scene_view.h"
#include "tracer/scene/image.h"

namespace copse {

namespace phases {
inline constexpr PhaseName surfaces{"surfaces", &groups::pictures};
}

/// Row by row as an Image is. Means over a pixel's samples.
struct SurfaceBuffers {
  Image normals;             ///< Unit vectors in the scene's space that face the eye; a sample without a hit adds 0.
  Image albedo;              ///< Kd, or its texture; a sample without a hit adds 0.
  std::vector<float> depth;  ///< Along the view, from the eye; over samples with a hit alone, +infinity without any.
};

/// Accumulates the surfaces that samples see. Phase `surfaces`. The order of the pixels has to outlive it.
class SurfaceFilm {
 public:
  SurfaceFilm(const Device& device, const SceneView& scene, const Pinhole& pinhole, const PixelOrder& order);
  ~SurfaceFilm();

  void add(const Device& device, const PrimaryBatch& batch);
  /// Divides by the samples that each pixel has once `done` of them are in it. Waits for the device.
  SurfaceBuffers finish(const Device& device, uint64_t done, int width, int height);

 private:
  struct Sums;
  SceneView scene_;
  vec3 forward_;
  float start_;  ///< As Pinhole's.
  std::unique_ptr<Sums> sums_;
};

struct SurfaceResult {
  SurfaceBuffers buffers;
  uint64_t samples = 0;  ///< Over all pixels; each was one ray.
};

/// Normals, albedo and depth without any light. Phase `surfaces` beside those of tracePrimary.
SurfaceResult renderSurfaces(const Device& device, const SceneView& scene, const RayTracer& tracer,
                             const Camera& camera, const RenderSettings& settings, const Watch& watch = {},
                             uint32_t queue = 0);

}  // namespace copse
