// The wavefront path tracer: generate, trace, shade, shadow, accumulate, over queues of fixed size.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "builder/bvh.h"
#include "builder/parallel/device.h"
#include "builder/parameters.h"
#include "tracer/accel/ray_tracer.h"
#include "tracer/integrators/film_state.h"
#include "tracer/integrators/path/scene_on_device.h"
#include "tracer/integrators/surfaces/surface_buffers.h"
#include "tracer/scene/scene.h"

namespace copse {

struct PathResult {
  Image image;
  RayCounts rays;
  double samplesDone = 0;  ///< Samples per pixel in the image: fewer than requested where it was stopped.
  std::optional<SurfaceBuffers> surfaces;  ///< If PathOptions::surfaces is set.
  /// To go on from, where the render was stopped and where it went on from another.
  std::optional<FilmState> film;
};

/// Uploads `scene`; its textures and sky must have been loaded. Positions and indices are uploaded as well, for
/// buildBvh. Throws InputError where an index points outside its array.
std::unique_ptr<SceneOnDevice> uploadScene(const Device& device, const Scene& scene);
TrianglesView trianglesOf(const SceneOnDevice& scene);

/// The size of the queue, and a technique to leave out. The image does not depend on `queue`.
struct PathOptions {
  uint32_t queue = 0;            ///< Paths in flight; 0 for the device's default.
  bool bounceFindsLight = true;  ///< false: no MIS, light samples alone; for tests.
  bool surfaces = false;         ///< Normals, albedo and depth as well, from the same camera rays.
  /// Goes on from the samples in it, of the same scene, view and settings but spp: the image is then that of one
  /// render. With `surfaces` the camera rays of those samples are traced once more.
  const FilmState* from = nullptr;
};

/// path.queue: PathOptions::queue by name.
std::vector<ParameterSpec> pathParameters();
uint32_t pathQueueOf(const Parameters& parameters);

/// Phases are those of tracer/integrators/phases.h, and `surfaces` if requested. The image depends on the scene, the
/// view and the settings alone; on the CPU bit for bit. The host waits for the device once per bounce, to read two
/// counters while the paths that go on are packed, and once at the end, for the image, which is part of "accumulate".
/// Throws InputError for invalid settings or an invalid view.
PathResult renderPath(const Device& device, const SceneOnDevice& scene, const RayTracer& tracer, const Camera& camera,
                      const RenderSettings& settings, const Watch& watch = {}, const PathOptions& options = {});

}  // namespace copse
