// A pinhole: rays through points of the image plane.
#pragma once

#include "builder/math/vec.h"
#include "tracer/scene/scene.h"

namespace copse {

/// The direction through image point (x, y), in pixels from the top left corner, is toCorner + x right + y down,
/// not a unit vector.
struct Camera {
  vec3 eye, toCorner, right, down;

  HD vec3 direction(float x, float y) const { return glm::normalize(toCorner + right * x + down * y); }
};

/// Throws InputError for a view without a direction or an angle outside 0 … 180 degrees. An `up` along the view is
/// replaced by another axis.
Camera makeCamera(const View& view, int width, int height);

}  // namespace copse
