// What the camera sees of surfaces: their normals, albedo and depth. From the first hits of camera rays, so that a path
// render gives them for the price of one kernel a batch. 64 bytes a pixel while it is made.
#pragma once

#include <vector>

#include "builder/parallel/buffer.h"
#include "tracer/integrators/camera.h"
#include "tracer/integrators/path/scene_view.h"
#include "tracer/scene/image.h"

namespace copse {

/// Row by row as an Image is. Means over a pixel's samples.
struct SurfaceBuffers {
  Image normals;             ///< Unit vectors in the scene's space that face the eye; a sample without a hit adds 0.
  Image albedo;              ///< Kd, or its texture; a sample without a hit adds 0.
  std::vector<float> depth;  ///< Along the view, from the eye; over samples with a hit alone, +infinity without any.
};

/// Camera rays and what they hit, in the device's memory: sample number `first` + i is that of rays[i], and the numbers
/// go through all pixels of one sample before the next begins.
struct PrimaryBatch {
  uint64_t first;
  uint32_t count;
  const Ray* rays;
  const Hit* hits;
};

/// One pixel's sums, exact enough for a million samples.
struct alignas(16) SurfaceSums {
  double normal[3], albedo[3], depth;
  uint64_t hits;
};

class SurfaceFilm {
 public:
  SurfaceFilm(const Device& device, const SceneView& scene, const Camera& camera, uint32_t pixels);

  /// Launch "surfaces".
  void add(const Device& device, const PrimaryBatch& batch);
  /// Divides by the samples that each pixel has once `done` of them are in it. Waits for the device.
  SurfaceBuffers finish(const Device& device, uint64_t done, int width, int height) const;

 private:
  SceneView scene_;
  vec3 forward_;
  uint32_t pixels_;
  Buffer<SurfaceSums> sums_;
};

}  // namespace copse
