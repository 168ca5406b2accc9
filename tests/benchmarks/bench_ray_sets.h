// The ray sets on which traversal is timed.
#pragma once

#include <string>
#include <vector>

#include "tracer/accel/ray_tracer.h"
#include "tracer/scene/scene.h"

namespace copse::baselines {

struct RaySet {
  std::string name;
  bool anyHit;
  std::vector<Ray> rays;
};

/// "primary": one ray per pixel, row by row. "bounce": one cosine-distributed ray from each primary hit. "shadow0" and
/// "shadow1": any hit, from each primary and each bounce hit towards a point on a light. The same for the same seed.
std::vector<RaySet> raySets(const Device& cpu, const Scene& scene, const Camera& camera, int width, int height,
                            const RayTracer& tracer, uint64_t seed);

}  // namespace copse::baselines
