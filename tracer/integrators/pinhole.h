// A pinhole: rays through points of the image plane, and where points of the scene lie on it.
#pragma once

#include <cfloat>

#include "builder/math/random.h"
#include "builder/math/vec.h"
#include "tracer/accel/ray.h"
#include "tracer/integrators/settings.h"
#include "tracer/scene/scene.h"

namespace copse {

/// The direction through image point (x, y), in pixels from the top left corner, is toCorner + x right + y down,
/// not a unit vector. In a view from far away floats would neither tell the rays' directions apart nor say where they
/// meet the scene: there they start from the plane at depth `start`, at startCorner + x startRight + y startDown. In
/// all other views that is the eye.
struct Pinhole {
  vec3 eye, toCorner, right, down;
  vec3 startCorner, startRight{0}, startDown{0};
  float start = 0;

  HD vec3 origin(float x, float y) const { return startCorner + startRight * x + startDown * y; }
  HD vec3 direction(float x, float y) const { return glm::normalize(toCorner + right * x + down * y); }
  /// The unit vector along the view.
  HD vec3 forward() const { return glm::normalize(glm::cross(right, down)); }
};

/// Where a sample of a pixel is on the image, in pixels; its key determines where in the pixel. Pixels are numbered row
/// by row.
HD inline vec2 samplePoint(uint32_t width, uint32_t pixel, uint64_t key) {
  const uint64_t jitter = randomBits(key, 0, 0);
  return {static_cast<float>(pixel % width) + unitFloat(highWord(jitter)),
          static_cast<float>(pixel / width) + unitFloat(lowWord(jitter))};
}

/// The ray through that point.
HD inline Ray cameraRay(const Pinhole& pinhole, uint32_t width, uint32_t pixel, uint64_t key) {
  const vec2 point = samplePoint(width, pixel, key);
  return {pinhole.origin(point.x, point.y), 0, pinhole.direction(point.x, point.y), FLT_MAX};
}

/// Throws InputError for a view without a direction or an angle outside 0 … 180 degrees. An `up` along the view is
/// replaced by another axis.
Pinhole makePinhole(const Camera& camera, int width, int height);

/// Throws InputError for invalid settings.
void checkSettings(const RenderSettings& settings);

}  // namespace copse
