// The tracer that validates images: plain, recursive, double precision, with its own intersection, its own simple tree
// and another random generator. It shares the Scene and nothing else with tracer/integrators/path and tracer/accel.
#pragma once

#include "tracer/integrators/settings.h"
#include "tracer/scene/scene.h"

namespace copse {

struct ReferenceResult {
  Image image;
  uint64_t rays[3] = {0, 0, 0};  ///< Primary, bounce, shadow.
  double buildMs = 0, renderMs = 0;
  double samplesDone = 0;
};

ReferenceResult renderReference(const Scene& scene, const Camera& camera, const RenderSettings& settings, int threads,
                                const Watch& watch = {});

}  // namespace copse
