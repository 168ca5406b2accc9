// From eye, at, up and angle to the vectors of the image plane, in double precision.
#include "tracer/integrators/pinhole.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "builder/base/error.h"

namespace copse {

Pinhole makePinhole(const Camera& camera, int width, int height) {
  using dvec3 = glm::dvec3;
  const auto fail = [&](const char* what) {
    throw InputError(camera.name.empty() ? what : fmt::format("view '{}': {}", camera.name, what));
  };
  if (!(camera.vfov > 0 && camera.vfov < 180)) fail("expected vfov above 0 and below 180 degrees");
  if (!isFinite(camera.eye) || !isFinite(camera.at) || !isFinite(camera.up)) fail("eye, at and up must be finite");
  dvec3 forward = camera.exactAt() - camera.exactEye();
  if (!(glm::length(forward) > 0)) fail("eye and at are the same point");
  forward = glm::normalize(forward);
  dvec3 right = glm::cross(forward, dvec3(camera.up));
  if (!(glm::length(right) > 1e-6 * glm::length(dvec3(camera.up))))
    right = glm::cross(forward, std::abs(forward.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, -1));
  right = glm::normalize(right);
  const dvec3 down = -glm::cross(right, forward);

  const double halfHeight = std::tan(camera.vfov * std::numbers::pi / 360), halfWidth = halfHeight * width / height;
  Pinhole pinhole;
  pinhole.eye = camera.eye;
  pinhole.toCorner = vec3(forward - right * halfWidth - down * halfHeight);
  pinhole.right = vec3(right * (2 * halfWidth / width));
  pinhole.down = vec3(down * (2 * halfHeight / height));
  pinhole.startCorner = camera.eye;
  if (camera.start > 0) {
    pinhole.start = static_cast<float>(camera.start);
    pinhole.startCorner = vec3(camera.exactEye() + (forward - right * halfWidth - down * halfHeight) * camera.start);
    pinhole.startRight = vec3(right * (2 * halfWidth / width * camera.start));
    pinhole.startDown = vec3(down * (2 * halfHeight / height * camera.start));
  }
  return pinhole;
}

void checkSettings(const RenderSettings& settings) {
  const auto within = [](int value, int low, int high, const char* what) {
    if (value < low || value > high)
      throw InputError(fmt::format("{}: expected an integer from {} to {}, got {}", what, low, high, value));
  };
  within(settings.width, 1, 8192, "width");
  within(settings.height, 1, 8192, "height");
  within(settings.spp, 1, 1 << 30, "spp");
  within(settings.maxDepth, 0, 1 << 20, "maximum depth");
  within(settings.lightSamples, 1, 4096, "light samples");
}

}  // namespace copse
