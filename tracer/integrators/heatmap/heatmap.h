// What each camera ray cost: the nodes that it visited and the triangles that it was tested against, counted by the
// per-ray traversal of tracer/accel/counting.h. 16 bytes per pixel and 8 per ray in flight.
#pragma once

#include <vector>

#include "tracer/integrators/primary_rays.h"

namespace copse {

namespace phases {
inline constexpr PhaseName countSteps{"count steps", &groups::pictures};
inline constexpr PhaseName addSteps{"add steps", &groups::pictures};
}  // namespace phases

/// Row by row as an Image is: means over a pixel's samples, 0 where it has none.
struct StepBuffers {
  std::vector<float> nodes, triangles;
  double meanNodes = 0, meanTriangles = 0;  ///< Over all rays.
  uint64_t samples = 0;                     ///< Over all pixels; each was one ray.
};

/// Phases `generate`, `countSteps` and `addSteps`. Slower than a render's own camera rays, which are not counted.
StepBuffers countSteps(const Device& device, const StepTracer& tracer, const Camera& camera,
                       const RenderSettings& settings, const Watch& watch = {}, uint32_t queue = 0);

}  // namespace copse
