// The wavefront path tracer: generate, trace, shade, shadow, accumulate, over queues of fixed size.
#pragma once

#include <memory>

#include "builder/parallel/device.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/settings.h"
#include "tracer/traversal/traversal_bvh.h"

namespace copse {

struct RayCounts {
  uint64_t primary = 0, bounce = 0, shadow = 0;
};

struct PathResult {
  Image image;
  RayCounts rays;
  double samplesDone = 0;  ///< Samples a pixel in the image: less than asked for where it was stopped.
};

/// What kernels read of a scene, in device memory: attributes of triangles, materials, texels, lights.
class SceneOnDevice;

/// Uploads `scene`; its textures and sky must have been loaded. Positions and indices are uploaded as well, for buildBvh.
std::unique_ptr<SceneOnDevice> uploadScene(const Device& device, const Scene& scene);
TrianglesView trianglesOf(const SceneOnDevice& scene);

/// Phases: "generate", "trace primary", "trace bounce", "shade", "trace shadow", "accumulate".
/// The image depends on the scene, the view and the settings alone; with the CPU's float arithmetic bit for bit.
PathResult renderPath(const Device& device, const SceneOnDevice& scene, const TraversalBvh& bvh, const View& view,
                      const RenderSettings& settings, const Watch& watch = {});

}  // namespace copse
