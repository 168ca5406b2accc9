// The wavefront path tracer: generate, trace, shade, shadow, accumulate, over queues of fixed size.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "builder/bvh.h"
#include "builder/parallel/device.h"
#include "builder/parameters.h"
#include "tracer/accel/ray_tracer.h"
#include "tracer/integrators/path/scene_on_device.h"
#include "tracer/integrators/surfaces/surface_buffers.h"
#include "tracer/scene/scene.h"

namespace copse {

struct PathResult {
  Image image;
  RayCounts rays;
  double samplesDone = 0;                  ///< Samples a pixel in the image: less than asked for where it was stopped.
  std::optional<SurfaceBuffers> surfaces;  ///< Where PathOptions asked for them.
};

/// Uploads `scene`; its textures and sky must have been loaded. Positions and indices are uploaded as well, for
/// buildBvh. Throws InputError where an index points outside its array.
std::unique_ptr<SceneOnDevice> uploadScene(const Device& device, const Scene& scene);
TrianglesView trianglesOf(const SceneOnDevice& scene);

/// How the work is cut, and a technique left out. The image does not depend on `queue`.
struct PathOptions {
  uint32_t queue = 0;            ///< Paths in flight; 0 for the device's own.
  bool bounceFindsLight = true;  ///< false: light reaches surfaces by light samples alone, unweighed; for tests.
  bool surfaces = false;         ///< Normals, albedo and depth as well, from the same camera rays.
};

/// path.queue: PathOptions::queue by name.
std::vector<ParameterSpec> pathParameters();
uint32_t pathQueueOf(const Parameters& parameters);

/// Phases are those of tracer/integrators/phases.h, and `surfaces` where they are asked for. The image depends on the
/// scene, the view and the settings alone; with the CPU's float arithmetic bit for bit. The host waits for the device
/// once a bounce, to read two counters while the paths that go on are packed, and once at the end, for the image, which
/// is part of "accumulate". Throws InputError for settings or a view that nothing can be rendered with.
PathResult renderPath(const Device& device, const SceneOnDevice& scene, const RayTracer& tracer, const Camera& camera,
                      const RenderSettings& settings, const Watch& watch = {}, const PathOptions& options = {});

}  // namespace copse
